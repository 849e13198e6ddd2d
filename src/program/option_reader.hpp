// SPDX-License-Identifier: MIT
// The options of a study's file. Host code only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "myriad/host/options/option_table.hpp"
#include "myriad/program.hpp"
#include "program/component_tables.hpp"

namespace myriad::programs {

/// Reads them by the table of options.
class option_reader {
public:
    explicit option_reader(const program_model& model) : model_(model) {}

    /// A table with the options of a struct.
    template <class Group>
    void read(const toml_value& table, const std::string& path, Group& to) const {
        section from(table, path);
        host::for_each_option<Group>([&](const auto& e) {
            using T = typename std::decay_t<decltype(e)>::value_type;
            T& value = to.*e.member;
            if constexpr (std::is_enum_v<T>) {
                from.read(e.name, value, host::choices(T{}));
            } else if constexpr (std::is_same_v<T, component_list>) {
                from.with(e.name, [&](const toml_value& v, const std::string& key) {
                    value = components_in(v, key, model_.names, kind_of(e.unit));
                });
            } else if constexpr (requires { from.read(e.name, value); }) {
                from.read(e.name, value);
            } else if constexpr (requires(const toml_value& v) { set(v, std::string(), value); }) {
                from.with(e.name, [&](const toml_value& v, const std::string& key) { set(v, key, value); });
            }  // else a function, which no file has
        });
        from.finish();
    }

private:
    static component_kind kind_of(std::string_view name) {
        return *std::find_if(recorded_kinds.begin(), recorded_kinds.end(),
                             [&](component_kind kind) { return name_of(kind) == name; });
    }

    void set(const toml_value& v, const std::string& key, std::vector<double>& to) const { to = numbers_in(v, key); }
    /// A number for all states, an array with one for each, or a table of states, where the others keep the default.
    void set(const toml_value& v, const std::string& path, per_component& to) const {
        if (v.as<toml_value::array>() != nullptr) {
            to = per_component(numbers_in(v, path));
            return;
        }
        const auto* const table = v.as<toml_value::table>();
        if (table == nullptr) {
            to = number_in(v, path);
            return;
        }
        std::vector<double> each;
        for (const component& c : model_.names.all())
            if (c.kind == component_kind::state) each.push_back(to[0]);
        for (const toml_value::entry& e : *table) {
            const std::string name = message(path, '.', e.key);
            with_component(model_.names, e.key, e.value, name, {component_kind::state}, [&] {
                each[static_cast<std::size_t>(model_.names.find(e.key, {component_kind::state}).number)] =
                    number_in(e.value, name);
            });
        }
        to = per_component(std::move(each));
    }
    /// A table for each event, in an array or under its name.
    void set(const toml_value& v, const std::string& path, std::vector<event_options>& to) const {
        const std::vector<std::string>& events = model_.events;
        to.assign(events.size(), event_options{});
        if (const auto* const array = v.as<toml_value::array>()) {
            if (array->size() != events.size())
                throw wrong(v, path,
                            message("has ", array->size(), " events, and the model has ", events.size(),
                                    ": give one table for each, or tables with their names"));
            for (std::size_t e = 0; e < array->size(); ++e) read((*array)[e], path, to[e]);
            return;
        }
        const section checked(v, path);
        for (const toml_value::entry& e : *v.as<toml_value::table>()) {
            const std::string key = checked.full(e.key);
            const auto found = std::find(events.begin(), events.end(), e.key);
            if (found == events.end())
                throw wrong(e.value, key, message("the model has no event \"", e.key, '"', suggestion(e.key, events)));
            read(e.value, key, to[static_cast<std::size_t>(found - events.begin())]);
        }
    }
    void set(const toml_value& v, const std::string& key, record_options& to) const { read(v, key, to); }
    void set(const toml_value& v, const std::string& key, sample_options& to) const {
        read(v, key, to);
        if (to.states.empty()) throw wrong(v, key, "names no states: write states = [...] with those that are sampled");
    }

    const program_model& model_;
};

}  // namespace myriad::programs
