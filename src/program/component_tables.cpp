// SPDX-License-Identifier: MIT
// Reads axes, and finds components.
#include "program/component_tables.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace myriad::programs {

using studies::model_kinds;

std::vector<double> arguments_in(const toml_value& v, const std::string& key, std::size_t count, const char* form) {
    const auto* const array = v.as<toml_value::array>();
    if (array == nullptr || array->size() != count) throw wrong(v, key, message("must be ", form));
    return numbers_in(v, key);
}
namespace {

constexpr std::string_view axis_choices =
    "must be an array of values, or one of {linspace = [first, last, number]}, {geomspace = [first, last, number]}, "
    "{values = [...]}, {uniform = [from, to]} and {normal = [mean, deviation]}";

axis_values spaced(const toml_value& v, const std::string& key,
                   axis_values (*make)(double first, double last, std::int64_t size)) {
    const std::vector<double> given = arguments_in(v, key, 3, "[first, last, number of values]");
    return make(given[0], given[1], integer_in((*v.as<toml_value::array>())[2], key));
}
axis_values drawn(const toml_value& v, const std::string& key, const char* form, axis_values (*make)(double, double)) {
    const std::vector<double> given = arguments_in(v, key, 2, form);
    return make(given[0], given[1]);
}

using axis_maker = axis_values (*)(const toml_value&, const std::string&);
constexpr std::pair<std::string_view, axis_maker> axis_makers[] = {
    {"linspace", [](const toml_value& v, const std::string& key) { return spaced(v, key, &linspace); }},
    {"geomspace", [](const toml_value& v, const std::string& key) { return spaced(v, key, &geomspace); }},
    {"values", [](const toml_value& v, const std::string& key) { return values(numbers_in(v, key)); }},
    {"uniform", [](const toml_value& v, const std::string& key) { return drawn(v, key, "[from, to]", &uniform); }},
    {"normal", [](const toml_value& v, const std::string& key) { return drawn(v, key, "[mean, deviation]", &normal); }},
};
const axis_maker* maker_of(std::string_view name) {
    for (const auto& [known, maker] : axis_makers)
        if (known == name) return &maker;
    return nullptr;
}

std::vector<std::string> names_of(const component_names& all, std::initializer_list<component_kind> kinds) {
    std::vector<std::string> names;
    for (const component& c : all.all())
        if (!c.name.empty() && studies::among(kinds, c.kind)) names.push_back(c.name);
    return names;
}

}  // namespace

axis_values axis_in(const toml_value& v, const std::string& key) {
    const auto* const table = v.as<toml_value::table>();
    std::vector<axis_values> made;
    if (v.as<toml_value::array>() != nullptr) {
        placed(v, key, [&] { made.push_back(values(numbers_in(v, key))); });
    } else if (table != nullptr && table->size() == 1) {
        const toml_value::entry& e = table->front();
        const axis_maker* const make = maker_of(e.key);
        if (make == nullptr) {
            std::vector<std::string> names;
            for (const auto& [known, maker] : axis_makers) names.emplace_back(known);
            for (const auto& [old, name] :
                 {std::pair("logspace", "geomspace"), {"random_uniform", "uniform"}, {"random_normal", "normal"}})
                if (e.key == old) throw wrong(e.value, message(key, '.', e.key), message("is named ", name));
            throw wrong(e.value, message(key, '.', e.key), "no axis is made in this way" + suggestion(e.key, names));
        }
        placed(e.value, key, [&] { made.push_back((*make)(e.value, key)); });
    } else {
        throw wrong(v, key, axis_choices);
    }
    return made.front();
}

bool is_kind(const toml_value::entry& e) {
    const auto* const table = e.value.as<toml_value::table>();
    if (table == nullptr ||
        std::any_of(table->begin(), table->end(), [](const auto& inner) { return maker_of(inner.key) != nullptr; }))
        return false;
    return std::any_of(model_kinds.begin(), model_kinds.end(), [&](component_kind k) { return name_of(k) == e.key; });
}

void with_component(const component_names& all, const std::string& name, const toml_value& v, const std::string& key,
                    std::initializer_list<component_kind> kinds, const std::function<void()>& function) {
    placed(v, key, [&] {
        try {
            function();
        } catch (const studies::unknown_component& e) {
            throw error(statement_of(e.said(), nearest_of(name, names_of(all, kinds))));
        }
    });
}

component_list components_in(const toml_value& v, const std::string& key, const component_names& all,
                             component_kind kind) {
    component_list list;
    for (const toml_value* const item : items_in(v)) {
        const std::string& name = text_in(*item, key);
        with_component(all, name, *item, key, {kind}, [&] { list.push_back(all.find(name, {kind}).number); });
    }
    return list;
}

}  // namespace myriad::programs
