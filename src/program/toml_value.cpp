// SPDX-License-Identifier: MIT
// TOML, by toml++.
#include "program/toml_value.hpp"

#include <algorithm>

#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
// Its assertions end a program that was built with them on files that are merely wrong, as "[#set]", which it reports
// as errors where they are off.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>

namespace myriad::programs {

std::string_view toml_value::kind() const {
    constexpr std::string_view names[] = {"a table", "an array", "a string", "an integer", "a number", "a boolean"};
    if (const other* const o = as<other>()) return o->kind;
    return names[value.index()];
}

std::string position(const text_place& place) {
    if (place.file.empty()) return "";
    if (place.line == 0) return message(place.file, ": ");
    return message(place.file, ':', place.line, ':', place.column, ": ");
}

namespace {

text_place place_of(const toml::source_region& region, std::string_view file) {
    return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

toml_value convert(const toml::node& node, const text_place& place, std::string_view file) {
    toml_value made{.value = toml_value::other{"a value of an unknown kind"}, .place = place};
    if (const toml::table* const table = node.as_table()) {
        toml_value::table entries;
        for (const auto& [key, value] : *table)
            entries.push_back({std::string(key.str()), convert(value, place_of(key.source(), file), file)});
        std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
            const text_place &first = a.value.place, &second = b.value.place;
            return std::pair(first.line, first.column) < std::pair(second.line, second.column);
        });
        made.value = std::move(entries);
    } else if (const toml::array* const array = node.as_array()) {
        toml_value::array items;
        for (const toml::node& item : *array) items.push_back(convert(item, place_of(item.source(), file), file));
        made.value = std::move(items);
    } else if (const auto* const text = node.as_string()) {
        made.value = text->get();
    } else if (const auto* const integer = node.as_integer()) {
        made.value = integer->get();
    } else if (const auto* const number = node.as_floating_point()) {
        made.value = number->get();
    } else if (const auto* const truth = node.as_boolean()) {
        made.value = truth->get();
    } else if (node.is_date() || node.is_date_time()) {
        made.value = toml_value::other{"a date"};
    } else if (node.is_time()) {
        made.value = toml_value::other{"a time of day"};
    }
    return made;
}

}  // namespace

toml_value parse_toml(std::string_view text, std::string_view file) {
    const toml::parse_result parsed = toml::parse(text);
    if (!parsed) {
        const toml::parse_error& e = parsed.error();
        throw input_error(position(place_of(e.source(), file)) + std::string(e.description()));
    }
    return convert(parsed.table(), {file, 1, 1}, file);
}

}  // namespace myriad::programs
