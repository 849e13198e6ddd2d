// SPDX-License-Identifier: MIT
// The table of options as text, and that it has every one.
#include "myriad/host/options/option_table.hpp"

#include <cmath>

#include "myriad/host/core/error.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

/// The number of members of an aggregate: of how many values one can be made.
struct anything {
    template <class T>
    operator T() const;
};
template <class Group, class... Values>
constexpr std::size_t member_count() {
    if constexpr (requires { Group{Values{}..., anything{}}; }) {
        return member_count<Group, Values..., anything>();
    } else {
        return sizeof...(Values);
    }
}
template <class Group>
constexpr bool has_each_member_once() {
    bool once = true;
    for_each_option<Group>([&](const auto& entry) {
        int found = 0;
        for_each_option<Group>([&](const auto& other) {
            found += std::string_view(entry.name) == other.name ? 1 : 0;
            if constexpr (std::is_same_v<decltype(entry), decltype(other)>) found += entry.member == other.member;
        });
        once = once && found == 2;
    });
    return once && std::tuple_size_v<decltype(option_table<Group>::all)> == member_count<Group>();
}
static_assert(has_each_member_once<options>(), "an option is not in the table, or twice");
static_assert(has_each_member_once<event_options>(), "an option of events is not in the table, or twice");
static_assert(has_each_member_once<record_options>(), "an option of records is not in the table, or twice");
static_assert(has_each_member_once<sample_options>(), "an option of samples is not in the table, or twice");

std::string type_of(const double&) { return "number"; }
std::string type_of(const std::int64_t&) { return "whole number"; }
std::string type_of(const bool&) { return "truth"; }
std::string type_of(const per_component&) { return "tolerances"; }
std::string type_of(const component_list&) { return "components"; }
std::string type_of(const std::vector<double>&) { return "numbers"; }
std::string type_of(const std::function<void(std::int64_t, std::int64_t)>&) { return "function"; }
template <class E>
requires std::is_enum_v<E> std::string type_of(const E&) { return "choice"; }
template <class Group>
requires requires { option_table<Group>::path; }
std::string type_of(const Group&) { return option_table<Group>::path; }
std::string type_of(const std::vector<event_options>&) { return option_table<event_options>::path; }

/// A default as text.
std::string initial_of(double value) { return std::isnan(value) ? "" : text_of(value); }
std::string initial_of(std::int64_t value) { return message(value); }
std::string initial_of(bool value) { return value ? "true" : "false"; }
std::string initial_of(const per_component& value) { return message(value[0]); }
template <class T>
std::string initial_of(const T& value) {
    if constexpr (std::is_enum_v<T>) {
        return name_of_choice(value);
    } else {
        return "";
    }
}

template <class T>
std::string interval(const number_range& r) {
    if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::int64_t> || std::is_same_v<T, per_component>) {
        const bool closed = !r.without_most && !(std::is_same_v<T, std::int64_t> && std::isinf(r.most));
        return message(r.or_zero ? "0 or " : "", r.without_least ? '(' : '[', text_of(r.least), ", ", text_of(r.most),
                       closed ? ']' : ')');
    } else {
        return "";
    }
}

template <class Group>
void add_rows(std::vector<option_row>& rows, const Group& initial) {
    const std::string path = option_table<Group>::path;
    for_each_option<Group>([&](const auto& e) {
        using T = typename std::decay_t<decltype(e)>::value_type;
        const T& value = initial.*e.member;
        option_row row{.name = path.empty() ? e.name : path + '.' + e.name,
                       .type = type_of(value),
                       .choices = {},
                       .initial = initial_of(value),
                       .range = interval<T>(e.range),
                       .unit = std::is_same_v<T, component_list> ? "" : e.unit,
                       .effect = e.effect,
                       .meaning = e.meaning};
        if constexpr (std::is_enum_v<T>)
            for (const auto& c : choices(T{})) row.choices.emplace_back(c.name);
        rows.push_back(std::move(row));
        if constexpr (std::is_same_v<T, std::vector<event_options>>) {
            add_rows(rows, event_options{});
        } else if constexpr (requires { option_table<T>::all; }) {
            add_rows(rows, value);
        }
    });
}

}  // namespace

std::string text_of(double number) {
    const bool whole = std::fabs(number) < 1e15 && number == std::floor(number);
    return whole ? message(static_cast<std::int64_t>(number)) : message(number);
}

std::vector<option_row> option_rows() {
    std::vector<option_row> rows;
    add_rows(rows, options{});
    return rows;
}

}  // namespace myriad::host::inline MYRIAD_ABI
