// SPDX-License-Identifier: MIT
// Results of studies as values of Python.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "myriad/study/plan/layout.hpp"
#include "myriad/study/study.hpp"

namespace myriad::python {

namespace nb = nanobind;

/// Memory as a NumPy array that owns it.
template <class T>
nb::object array_of(std::vector<T> values, std::vector<std::size_t> shape) {
    auto* const kept = new std::vector<T>(std::move(values));
    const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T>(kept->data(), shape.size(), shape.data(), owner),
                    nb::rv_policy::reference);
}
inline std::vector<std::size_t> shape_of(const studies::variable& v, std::size_t items) {
    std::vector<std::size_t> shape{items};
    for (const studies::dimension& d : v.inner) shape.push_back(static_cast<std::size_t>(d.length));
    return shape;
}
inline nb::dict attributes_of(const std::vector<studies::attribute>& all) {
    nb::dict made;
    for (const studies::attribute& a : all)
        made[a.name.c_str()] = std::visit([](const auto& value) { return nb::cast(value); }, a.value);
    return made;
}
inline nb::list dimensions_of(const std::vector<studies::dimension>& all) {
    nb::list made;
    for (const studies::dimension& d : all) made.append(nb::make_tuple(d.name, d.length));
    return made;
}

/// What a run left, or a store that was opened for reading.
struct opened_results {
    std::shared_ptr<const studies::results> all;

    const studies::layout& content() const { return all->content(); }
    nb::object read(const std::string& name, std::int64_t first, std::int64_t count) const {
        const studies::variable& v = content().variables[content().find(name)];
        return studies::with_type(v.type, [&]<class T>(T) {
            std::vector<T> values;
            {
                const nb::gil_scoped_release unlocked;
                values = study_result(all).values_of<T>(name, first, count);
            }
            return array_of(std::move(values), shape_of(v, static_cast<std::size_t>(count)));
        });
    }
    nb::object coordinate(const std::string& name, std::int64_t length) const {
        for (const studies::coordinate& c : content().coordinates) {
            if (c.name != name) continue;
            std::vector<double> values(static_cast<std::size_t>(length));
            c.values(0, values);
            return array_of(std::move(values), {static_cast<std::size_t>(length)});
        }
        throw error(message("there is no coordinate ", name));
    }
    nb::list variables() const {
        nb::list made;
        for (const studies::variable& v : content().variables) {
            if (v.extent == studies::along::chunks) continue;
            made.append(nb::make_tuple(v.name, std::string(studies::name_of(v.type)), dimensions_of(v.inner),
                                       attributes_of(v.attributes), v.extent == studies::along::instances,
                                       v.role == studies::role::coordinate));
        }
        return made;
    }
    nb::list coordinates() const {
        nb::list made;
        for (const studies::coordinate& c : content().coordinates)
            made.append(nb::make_tuple(c.name, c.dimension, attributes_of(c.attributes)));
        return made;
    }
    std::int64_t instances_done() const {
        std::int64_t done = 0;
        for (std::int64_t c = 0; c < content().chunks(); ++c)
            if (all->done(c)) done += studies::range_of(content(), c).count;
        return done;
    }
};

}  // namespace myriad::python
