// SPDX-License-Identifier: MIT
// The values of ensembles and reports as arrays of Python, on the host or on a GPU, and what sets them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include "myriad/host/threads/parallel.hpp"
#include "resident.hpp"
#include "run.hpp"

namespace myriad::python {

namespace nb = nanobind;

/// A NumPy array of `count` values, which keeps its owner alive.
template <class T>
nb::object view(T* values, std::int64_t count, nb::handle owner) {
    return nb::cast(nb::ndarray<nb::numpy, std::remove_const_t<T>, nb::ndim<1>>(
                        const_cast<std::remove_const_t<T>*>(values), {static_cast<std::size_t>(count)}, owner),
                    nb::rv_policy::reference);
}
/// One of `rows` times `columns` values, of which column after column is in memory.
template <class T>
nb::object table(const T* values, std::int64_t rows, std::int64_t columns, nb::handle owner) {
    return nb::cast(nb::ndarray<nb::numpy, T, nb::ndim<2>>(
                        const_cast<T*>(values), {static_cast<std::size_t>(rows), static_cast<std::size_t>(columns)},
                        owner, {1, rows}),
                    nb::rv_policy::reference);
}

template <class T>
T& checked(T& array, int component) {
    require(component >= 0 && component < array.components(), "there is no component ", component);
    return array;
}

/// Calls `use(first value)` for one component of one kind of an ensemble's data.
template <class R, class Use>
auto with_component(ensemble<R>& e, const std::string& kind, int c, Use&& use) {
    auto& d = e.data;
    const auto of = [&](auto& array) { return use(checked(array, c).component(c)); };
    const auto counter = [&](auto which) { return use(const_cast<std::int64_t*>(d.counter(which).data())); };
    using arrays = typename host::ensemble_data<R>::arrays;
#define MYRIAD_OF_KIND(name, ...) \
    if (kind == #name) return of(d.name);
    MYRIAD_INSTANCE_KINDS(MYRIAD_OF_KIND)
#undef MYRIAD_OF_KIND
    if (kind == "t_begin") return of(d.own_domains().t_begin);
    if (kind == "t_end") return of(d.own_domains().t_end);
    if (kind == "tolerance_scale") return of(d.tolerance_scales());
    if (kind == "t") return of(d.t);
    if (kind == "phases_done") return of(d.phase);
    if (kind == "status") return use(reinterpret_cast<std::uint8_t*>(d.status.data()));
#define MYRIAD_OF_COUNTER(name, array, words) \
    if (kind == #name) return counter(&arrays::array);
    MYRIAD_COUNTERS(MYRIAD_OF_COUNTER)
#undef MYRIAD_OF_COUNTER
    throw error(message("there is no array ", kind));
}

/// One component of one kind of an ensemble's data as an array on the host.
template <class R>
nb::object component(nb::handle self, const std::string& kind, int c) {
    auto& e = nb::cast<ensemble<R>&>(self);
#define MYRIAD_OF_KIND(name, ...) \
    if (kind == #name) return view(e.data.name.data(), e.shape->n_##name, self);
    MYRIAD_SHARED_KINDS(MYRIAD_OF_KIND)
#undef MYRIAD_OF_KIND
    return with_component(e, kind, c, [&](auto* values) {
        const std::int64_t n = e.data.size;
        if (e.gpu) e.gpu->bring(values, static_cast<std::size_t>(n) * sizeof *values);
        return view(values, n, self);
    });
}

/// An array on a GPU, column after column in memory, which keeps its owner alive; None where it is not there.
template <class R, class T>
nb::object device_table(resident<R>* gpu, const T* values, std::int64_t rows, std::int64_t columns, nb::handle owner) {
    void* const there = gpu != nullptr ? gpu->on_device(values) : nullptr;
    if (there == nullptr) return nb::none();
    const auto n = static_cast<std::size_t>(rows);
    if (columns < 0)
        return nb::cast(nb::ndarray<T, nb::ndim<1>, nb::device::cuda>(there, {n}, owner, {1}, nb::dtype<T>(),
                                                                      nb::device::cuda::value, gpu->number()),
                        nb::rv_policy::reference);
    return nb::cast(
        nb::ndarray<T, nb::ndim<2>, nb::device::cuda>(there, {n, static_cast<std::size_t>(columns)}, owner, {1, rows},
                                                      nb::dtype<T>(), nb::device::cuda::value, gpu->number()),
        nb::rv_policy::reference);
}

/// The same for one component, where a GPU has it.
template <class R>
nb::object device_component(nb::handle self, const std::string& kind, int c) {
    auto& e = nb::cast<ensemble<R>&>(self);
    return with_component(e, kind, c,
                          [&](auto* values) { return device_table(e.gpu.get(), values, e.data.size, -1, self); });
}

template <class R>
R* settable(ensemble<R>& e, const std::string& kind, int c) {
    require(kind == "state" || kind == "parameter", "only states and parameters are set in this way");
    return kind == "state" ? checked(e.data.state, c).component(c) : checked(e.data.parameter, c).component(c);
}
/// Sets instance i of a state or parameter to `values[i / repeat % values.size()]`.
template <class R>
void spread(ensemble<R>& e, const std::string& kind, int c,
            const nb::ndarray<const R, nb::ndim<1>, nb::c_contig, nb::device::cpu>& values, std::int64_t repeat) {
    const auto n = static_cast<std::int64_t>(values.size());
    require(n > 0 && repeat > 0, "there are no values");
    if (n == 1) repeat = e.data.size;
    R* const to = settable(e, kind, c);
    const R* const from = values.data();
    host::in_parallel(e.data.size, 32'768, [=](std::int64_t first, std::int64_t last) {
        for (std::int64_t i = first; i < last;) {
            const std::int64_t k = i / repeat % n;
            if (repeat > 1) {
                const std::int64_t end = std::min(last, (i / repeat + 1) * repeat);
                std::fill(to + i, to + end, from[k]);
                i = end;
            } else {
                const std::int64_t count = std::min(last - i, n - k);
                std::copy_n(from + k, count, to + i);
                i += count;
            }
        }
    });
}
/// Has the call take a state or parameter from a GPU's memory.
template <class R>
void set_on_device(ensemble<R>& e, const std::string& kind, int c, std::uintptr_t values) {
    R* const here = settable(e, kind, c);
    (kind == "state" ? e.data.state : e.data.parameter).fill_component(c, 0);  // so that it passes the checks
    e.on_device.push_back({here, reinterpret_cast<const R*>(values)});
}

/// The same of an array of `device_table`: (address, shape, name of its type, device, distances of values).
inline nb::tuple facts_of_own_array(const nb::ndarray<nb::ro>& array) {
    nb::list shape, strides;
    for (std::size_t d = 0; d < array.ndim(); ++d) {
        shape.append(array.shape(d));
        strides.append(array.stride(d));
    }
    const auto type = array.dtype();
    const char* const kind = type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Float) ? "float"
                             : type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Int) ? "int"
                                                                                                   : "uint";
    return nb::make_tuple(reinterpret_cast<std::uintptr_t>(array.data()), nb::tuple(shape),
                          message(kind, int{type.bits}), array.device_id(), nb::tuple(strides));
}

/// Where an array is that another library has on a GPU, as (address, length, bytes between values, kind and bits of
/// its type, device).
inline nb::tuple facts_of_device_array(const nb::ndarray<nb::ro>& array) {
    require(array.device_type() == nb::device::cuda::value, "the array is not on an NVIDIA GPU");
    require(array.ndim() == 1, "the array has ", array.ndim(), " dimensions");
    const auto type = array.dtype();
    return nb::make_tuple(reinterpret_cast<std::uintptr_t>(array.data()), array.shape(0),
                          array.stride(0) * type.bits / 8,
                          type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Float) ? 'f' : '?',
                          int{type.bits}, array.device_id());
}

/// The samples of a state, or their times for -1, or those on the GPU.
template <class R>
nb::object sampled(nb::handle self, int state, bool on_device) {
    auto& e = nb::cast<ensemble<R>&>(self);
    auto& s = e.samples;
    const R* const values = state < 0 ? s.time.data() : s.component(state);
    if (on_device) return device_table(e.gpu.get(), values, s.size, s.capacity, self);
    if (e.gpu) e.gpu->bring(values, static_cast<std::size_t>(s.size * s.capacity) * sizeof(R));
    return table(values, s.size, s.capacity, self);
}

template <class R>
nb::object recorded(nb::handle self, const std::string& kind, int c, bool on_device) {
    auto& all = nb::cast<report<R>&>(self);
    auto& r = all.records;
    const auto of = [&](const auto& array, const std::vector<std::int16_t>& columns) {
        const auto* const values = array.component(r.find(columns, c, kind.c_str()));
        if (on_device) return device_table(all.gpu.get(), values, r.size, r.phases, self);
        if (all.gpu) all.gpu->bring(values, static_cast<std::size_t>(r.size * r.phases) * sizeof *values);
        return table(values, r.size, r.phases, self);
    };
#define MYRIAD_OF_KIND(name, plural, words, type) \
    if (kind == #name) return of(r.template of_type<type>(), r.name);
    MYRIAD_RECORDED_KINDS(MYRIAD_OF_KIND)
#undef MYRIAD_OF_KIND
    if (kind == "time") return of(r.values, {r.time});
    throw error(message("there are no records of ", kind));
}

}  // namespace myriad::python
