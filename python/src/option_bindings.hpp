// SPDX-License-Identifier: MIT
// The options as classes of Python, by the table of options.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "myriad/host/options/option_table.hpp"

namespace myriad::python {

namespace nb = nanobind;

/// The options of a struct, by their names: choices as text, tolerances and numbers of components as lists.
template <class Group>
void bind_options_of(nb::module_& m, const char* name) {
    nb::class_<Group> bound(m, name);
    bound.def(nb::init<>());
    host::for_each_option<Group>([&](const auto& e) {
        using T = typename std::decay_t<decltype(e)>::value_type;
        const auto member = e.member;
        if constexpr (std::is_enum_v<T>) {
            bound.def_prop_rw(
                e.name, [member](const Group& o) { return host::name_of_choice(o.*member); },
                [member](Group& o, const std::string& wanted) {
                    for (const auto& c : host::choices(T{}))
                        if (wanted == c.name) o.*member = c.value;
                });
        } else if constexpr (std::is_same_v<T, per_component>) {
            bound.def_prop_rw(
                e.name,
                [member](const Group& o) {
                    std::vector<double> all;
                    for (std::size_t i = 0; i < (o.*member).size(); ++i) all.push_back((o.*member)[i]);
                    return all;
                },
                [member](Group& o, std::vector<double> all) { o.*member = per_component(std::move(all)); });
        } else if constexpr (std::is_same_v<T, component_list>) {
            bound.def_prop_rw(
                e.name, [member](const Group& o) { return std::vector<int>((o.*member).begin(), (o.*member).end()); },
                [member](Group& o, const std::vector<int>& all) { o.*member = all; });
        } else if constexpr (!std::is_same_v<T, decltype(options::progress)>) {  // which is given to `solve`
            bound.def_rw(e.name, member);
        }
    });
}

inline void bind_options(nb::module_& m) {
    bind_options_of<event_options>(m, "EventOptions");
    bind_options_of<record_options>(m, "RecordOptions");
    bind_options_of<sample_options>(m, "SampleOptions");
    bind_options_of<options>(m, "Options");
    m.def(
        "option_rows",
        [] {
            nb::list rows;
            for (const host::option_row& r : host::option_rows()) {
                nb::dict row;
                row["name"] = r.name;
                row["type"] = r.type;
                row["choices"] = r.choices;
                row["initial"] = r.initial;
                row["range"] = r.range;
                row["unit"] = r.unit;
                row["of_call_alone"] = r.effect == host::option_effect::call;
                row["meaning"] = r.meaning;
                rows.append(row);
            }
            return rows;
        },
        nb::sig("def option_rows() -> list[dict[str, typing.Any]]"));
}

}  // namespace myriad::python
