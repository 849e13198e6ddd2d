// SPDX-License-Identifier: MIT
// Writes descriptions of studies.
#include "description.hpp"

#include <cmath>
#include <cstring>
#include <map>
#include <vector>

#include <nlohmann/json.hpp>

#include "myriad/host/core/error.hpp"
#include "myriad/host/options/option_table.hpp"
#include "myriad/study/plan/kinds.hpp"
#include "myriad/version.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

using json = nlohmann::ordered_json;

/// JSON has no NaN, which stands for a default, and no infinity.
json number_or_word(double value) {
    if (std::isnan(value)) return "default";
    if (std::isinf(value)) return value > 0 ? "infinity" : "-infinity";
    return value;
}
json numbers(const std::vector<double>& all) {
    constexpr std::size_t most = 1000;
    json list = json::array();
    if (all.size() <= most) {
        for (const double value : all) list.push_back(number_or_word(value));
        return list;
    }
    std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a of their bytes
    for (const double value : all) {
        unsigned char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
    }
    return message(all.size(), " values from ", all.front(), " to ", all.back(), ", hash ", hash);
}
json numbers(const per_component& all) {
    std::vector<double> list;
    for (std::size_t i = 0; i < all.size(); ++i) list.push_back(all[i]);
    return numbers(list);
}

json as_json(const axis_values& v) {
    if (v.which() == axis_values::kind::list) return numbers(v.listed());
    constexpr const char* names[] = {"linspace", "geomspace", "values", "uniform", "normal"};
    std::string text = names[static_cast<int>(v.which())];
    text += '(' + exact_text(v.first()) + ", " + exact_text(v.last());
    if (!v.random()) text += ", " + std::to_string(v.size());
    return text + ')';
}

json as_json(const axes& all) {
    json made{{"dimensions", json::array()}, {"values", json::object()}, {"random", json::object()}};
    for (std::size_t d = 0; d < all.dimensions().size(); ++d) {
        json along{{"name", all.dimensions()[d].name}, {"length", all.dimensions()[d].length}};
        for (const axes::entry& e : all.entries())
            if (e.dimension == static_cast<int>(d)) along["components"][e.what.full_name()] = as_json(e.values);
        made["dimensions"].push_back(along);
    }
    for (const axes::entry& e : all.entries()) {
        if (e.dimension) continue;
        if (e.values.random()) {
            made["random"][e.what.full_name()] = as_json(e.values);
        } else {
            made["values"][e.what.full_name()] = number_or_word(e.values[0]);
        }
    }
    if (!made["random"].empty()) made["seed"] = all.seed();
    return made;
}

template <class Group>
json options_as_json(const Group& o, const component_names& names);

/// The value of an option.
json value_of(std::int64_t value, const component_names&) { return value; }
json value_of(bool value, const component_names&) { return value; }
json value_of(double value, const component_names&) { return number_or_word(value); }
json value_of(direction value, const component_names&) { return static_cast<int>(value); }
json value_of(const std::vector<event_options>& all, const component_names& names) {
    json made = json::array();
    for (const event_options& e : all) made.push_back(options_as_json(e, names));
    return made;
}
template <class T>
json value_of(const T& value, const component_names& names) {
    if constexpr (std::is_enum_v<T>) {
        return host::name_of_choice(value);
    } else if constexpr (std::is_same_v<T, std::vector<double>> || std::is_same_v<T, per_component>) {
        return numbers(value);
    } else if constexpr (requires { value.empty(); }) {
        return value.empty() ? json() : options_as_json(value, names);  // records and samples that nobody asked for
    } else {
        return json();
    }
}
json names_of(const component_names& names, const char* kind, const component_list& list) {
    json made = json::array();
    for (const int c : list) made.push_back(names.find(message(kind, '.', c), recorded_kinds).full_name());
    return made;
}

/// Those that have an effect on results.
template <class Group>
json options_as_json(const Group& o, const component_names& names) {
    json made = json::object();
    host::for_each_option<Group>([&](const auto& e) {
        if (e.effect != host::option_effect::results) return;
        json value;
        if constexpr (std::is_same_v<typename std::decay_t<decltype(e)>::value_type, component_list>) {
            value = names_of(names, e.unit, o.*e.member);
        } else {
            value = value_of(o.*e.member, names);
        }
        if (!value.is_null()) made[e.name] = std::move(value);
    });
    return made;
}

}  // namespace

std::string description_of(const study_plan& plan) {
    using enum component_kind;
    const study_request& asked = plan.asked;
    const component_names& names = asked.axes.names();
    std::map<std::string, int> components;
    for (const component& c : names.all())
        if (c.kind != t_begin && c.kind != t_end) ++components[name_of(c.kind)];
    json kept = json::array(), reductions = json::object();
    for (const quantity& q : plan.quantities)
        if (q.stored) kept.push_back(q.as.name);
    for (const ensemble_reduction& r : asked.reductions)
        reductions[r.definition().name] = {{"of", r.definition().inputs}, {"what", r.definition().description}};
    json made{{"model", names.model()},
              {"components", components},
              {"method", asked.method},
              {"real", name_of(asked.real)},
              {"version", MYRIAD_VERSION},
              {"axes", as_json(asked.axes)},
              {"options", options_as_json(asked.options, names)},
              {"kept", kept}};
    if (!asked.title.empty()) made["title"] = asked.title;
    if (!reductions.empty()) made["reductions"] = reductions;
    if (!asked.generator.empty()) made["generator"] = asked.generator;
    if (asked.generates_itself) made["axes"]["seed"] = asked.axes.seed();
    if (!asked.notes.empty()) made["notes"] = asked.notes;
    if (!asked.units.empty()) made["units"] = asked.units;
    return made.dump(2);
}

bool is_json_object(std::string_view text) { return json::parse(text, nullptr, false).is_object(); }

bool is_utf8(const std::string& text) {
    try {
        static_cast<void>(json(text).dump());
        return true;
    } catch (const json::exception&) {
        return false;
    }
}

}  // namespace myriad::studies::inline MYRIAD_ABI
