// SPDX-License-Identifier: MIT
// Tables of components in a study's file, and the axes in them. Host code only.
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "myriad/study/plan/axes.hpp"
#include "myriad/study/plan/kinds.hpp"
#include "program/section.hpp"
#include "program/toml_value.hpp"

namespace myriad::programs {

using studies::component;
using studies::component_kind;
using studies::component_names;
using studies::recorded_kinds;

/// The arguments of one of the functions that make axes.
std::vector<double> arguments_in(const toml_value& v, const std::string& key, std::size_t count, const char* form);
/// Values along an axis.
axis_values axis_in(const toml_value& v, const std::string& key);
/// Whether `{name = ...}` are the components of a kind, and not the values of a component of that name.
bool is_kind(const toml_value::entry& e);

/// Calls a function for every component in a table, with its name and its key in messages. Components may be in tables
/// of their kind: `parameter.k` is a key of a table in TOML.
template <class Function>
void for_each_component(const toml_value& table, const std::string& path, Function&& function) {
    const section checked(table, path);  // that it is a table
    for (const toml_value::entry& e : *table.as<toml_value::table>()) {
        const std::string key = checked.full(e.key);
        if (!is_kind(e)) {
            function(e.key, e.value, key);
            continue;
        }
        for (const toml_value::entry& inner : *e.value.as<toml_value::table>())
            function(message(e.key, '.', inner.key), inner.value, message(key, '.', inner.key));
    }
}

/// Calls a function that looks for a component, and says which one may have been meant.
void with_component(const component_names& all, const std::string& name, const toml_value& v, const std::string& key,
                    std::initializer_list<component_kind> kinds, const std::function<void()>& function);
/// The numbers of components of one kind.
component_list components_in(const toml_value& v, const std::string& key, const component_names& all,
                             component_kind kind);

}  // namespace myriad::programs
