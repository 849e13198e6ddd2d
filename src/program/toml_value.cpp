// SPDX-License-Identifier: MIT
// TOML, by toml++.
#include "program/toml_value.hpp"

#include <algorithm>

// Values within each other, each of which has at most the tables of a key with `most_parts` parts: together less than
// the stack of a thread holds.
#define TOML_MAX_NESTED_VALUES 32
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

constexpr int most_parts = 64;

int line_of(std::string_view text, std::size_t at) {
    return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/// Refuses keys of so many parts, a.b.c ..., that tables within tables would not fit on the stack. Of the text it reads
/// strings and comments alone, as what is wrong otherwise is found later.
void check_keys(std::string_view text, std::string_view file) {
    int parts = 1;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '"' || c == '\'') {
            const bool is_long = text.substr(at, 3) == std::string(3, c);
            for (at += is_long ? 3 : 1; at < text.size(); ++at) {
                if (text[at] == '\\' && c == '"')
                    ++at;
                else if (is_long ? text.substr(at, 3) == std::string(3, c) : text[at] == c)
                    break;
                else if (!is_long && text[at] == '\n')
                    break;
            }
            if (is_long) at += 2;
        } else if (c == '#') {
            at = std::min(text.find('\n', at), text.size()) - 1;
        } else if (c == '.') {
            if (++parts > most_parts)
                throw input_error(message(position({file, line_of(text, at), 1}), "a key has more than ", most_parts,
                                          " parts with dots between them"));
        } else if (c == '=' || c == ',' || c == '[' || c == '{' || c == '\n') {
            parts = 1;
        }
    }
}

}  // namespace

toml_value parse_toml(std::string_view text, std::string_view file) {
    check_keys(text, file);
    const toml::parse_result parsed = toml::parse(text);
    if (!parsed) {
        const toml::parse_error& e = parsed.error();
        throw input_error(position(place_of(e.source(), file)) + std::string(e.description()));
    }
    return convert(parsed.table(), {file, 1, 1}, file);
}

}  // namespace myriad::programs
