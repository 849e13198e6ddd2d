// SPDX-License-Identifier: MIT
// What a file that the Python package compiles includes after its model: MYRIAD_KERNEL_LIBRARY, which makes the shared
// object's one exported function.
#pragma once

#include <algorithm>

#include "myriad/python/kernel_interface.hpp"
// after the interface, which needs no packs
#include "myriad/host/checks/event_resolution.hpp"
#include "myriad/host/report/stability.hpp"
#include "myriad/kernel/stepper/method_check.hpp"
#include "myriad/kernel/study/generator.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"
#include "myriad/openmp/packs.hpp"
#include "myriad/python/facts_of.hpp"
#include "myriad/random.hpp"
#include "myriad/tangent.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The arguments in the form that the model's kernel takes.
template <class Model, class R>
kernel_arguments<Model, R> arguments_of(const python::any_arguments<R>& from) {
    kernel_arguments<Model, R> a{};
    static_cast<instance_range&>(a) = from;
    static_cast<instance_arrays<array_pointer, R>&>(a) = from;
    a.shared = from.shared;
    a.cost = from.cost, a.order = from.order;
    a.phases = from.phases, a.first_phase = from.first_phase;
    a.common_t_begin = from.common_t_begin, a.common_t_end = from.common_t_end;
    a.phase_length = from.phase_length, a.phases_per_time = from.phases_per_time;
    a.carry_time = from.carry_time, a.carry_step = from.carry_step;
    a.max_steps = from.max_steps;
    a.step = from.step, a.first_change = from.first_change, a.minimum_step = from.minimum_step,
    a.maximum_step = from.maximum_step;
    a.growth_limit = from.growth_limit, a.shrink_limit = from.shrink_limit;
    std::copy_n(from.relative_tolerance, n_state<Model>, a.relative_tolerance);
    std::copy_n(from.absolute_tolerance, n_state<Model>, a.absolute_tolerance);
    std::copy_n(from.event, n_event<Model>, a.event);
    std::copy_n(from.rising, n_event<Model> / 32 + 1, a.rising);
    std::copy_n(from.falling, n_event<Model> / 32 + 1, a.falling);
    a.sub_samples = from.sub_samples, a.accumulation_limit = from.accumulation_limit;
    const auto& r = from.record;
    a.record.values = r.values, a.record.integers = r.integers;
    a.record.from_phase = r.from_phase, a.record.phases = r.phases, a.record.time_column = r.time_column;
    std::copy_n(r.state_column, n_state<Model>, a.record.state_column);
    std::copy_n(r.accessory_column, n_accessory<Model>, a.record.accessory_column);
    std::copy_n(r.integer_accessory_column, n_integer_accessory<Model>, a.record.integer_accessory_column);
    const auto& s = from.sample;
    a.sample.time = s.time, a.sample.values = s.values, a.sample.stored = s.stored;
    a.sample.times = s.times, a.sample.own_times = s.own_times;
    a.sample.count = s.count, a.sample.every = s.every, a.sample.capacity = s.capacity;
    a.sample.from_phase = s.from_phase, a.sample.minimum_spacing = s.minimum_spacing;
    std::copy_n(s.column, n_state<Model>, a.sample.column);
    return a;
}

template <class Model, class Method, class R>
void run_library(const void* arguments, const run_options* options, int most_threads, python::team_starter start,
                 run_statistics* result) {
    if (!computes_as_written()) {
        *result = {.computed_as_written = false};
        return;
    }
    const auto a = detail::arguments_of<Model, R>(*static_cast<const python::any_arguments<R>*>(arguments));
    *result = detail::run_packs<Model, Method, R, default_batches<Model, Method>()>(
        a, *options, most_threads, [start](openmp::team& all) { start(&all); });
}

template <class Model, class R>
void generate_in_library(const void* arguments, std::uint64_t seed, std::int64_t begin, std::int64_t end) {
    const auto& a = *static_cast<const python::any_arguments<R>*>(arguments);
    for (std::int64_t i = begin; i < end; ++i) detail::generate_instance<Model, R>(a, a, a.shared, seed, i);
}
/// Null for a model without `generate`.
template <class Model, class R>
constexpr auto generator_in_library() {
    if constexpr (generates<Model, R>) {
        return &generate_in_library<Model, R>;
    } else {
        return nullptr;
    }
}

/// The argument p of instance i.
template <class Model, class R>
inputs<Model, R> inputs_of(const python::any_arguments<R>& a, std::int64_t i) {
    inputs<Model, R> p;
    for (int c = 0; c < n_parameter<Model>; ++c) p.parameter[c] = a.parameter[c * a.size + i];
    if constexpr (!accessories_are_outputs<Model>) {
        for (int c = 0; c < n_accessory<Model>; ++c) p.accessory[c] = a.accessory[c * a.size + i];
        for (int c = 0; c < n_integer_accessory<Model>; ++c)
            p.integer_accessory[c] = a.integer_accessory[c * a.size + i];
    }
    p.shared.values = a.shared.real;
    p.shared_integer.values = a.shared.integer;
    return p;
}

template <class Model, class R>
void rhs_in_library(const void* arguments, std::int64_t i, const void* t, const void* y, void* slopes) {
    const auto& a = *static_cast<const python::any_arguments<R>*>(arguments);
    vec<R, n_state<Model>> state;
    std::copy_n(static_cast<const R*>(y), n_state<Model>, &state[0]);
    const auto f = detail::evaluate_rhs<Model>(*static_cast<const R*>(t), state, detail::inputs_of<Model>(a, i));
    std::copy_n(&f[0], n_state<Model>, static_cast<R*>(slopes));
}
template <class Model, class R>
void event_resolution_in_library(const void* arguments, std::int64_t i, void* finest) {
    const auto& a = *static_cast<const python::any_arguments<R>*>(arguments);
    vec<R, n_state<Model>> start;
    for (int c = 0; c < n_state<Model>; ++c) start[c] = a.state[c * a.size + i];
    const R t = a.t_begin != nullptr ? a.t_begin[i] : a.common_t_begin;
    host::event_resolution<Model, R>(t, start, detail::inputs_of<Model>(a, i)).write(static_cast<R*>(finest));
}

/// What a library tells for notes and checks, as far as there is something to tell.
template <class Model, class Method, class R>
constexpr python::kernel_library with_checks(python::kernel_library made) {
    if constexpr (host::may_advise_stiff_methods<Model, Method>) {
        made.rhs = &rhs_in_library<Model, R>;
        made.stability_limit = &host::real_stability_limit<Method>;
    }
    if constexpr (host::event_resolution<Model, R>::is_known)
        made.event_resolution = &event_resolution_in_library<Model, R>;
    return made;
}

template <class Model, class Method, class R>
inline constexpr python::kernel_library library_of = with_checks<Model, Method, R>({
    .model = facts_of<Model, Method, R>,
    .instruction_set = static_cast<std::int32_t>(openmp::instruction_set::MYRIAD_INSTRUCTION_SET),
    .run = &run_library<Model, Method, R>,
    .generate = generator_in_library<Model, R>(),
});

}  // namespace myriad::detail::inline MYRIAD_TARGET

/// Makes the kernel of a model, a method and a real type the shared object's. The arguments may not contain commas.
#define MYRIAD_KERNEL_LIBRARY(Model, Method, R)                                                                       \
    static_assert(myriad::detail::check_linkage<Model, Method>());                                                    \
    static_assert(myriad::detail::check_method<Method>());                                                            \
    extern "C" __attribute__((visibility("default"))) const myriad::python::kernel_library* myriad_kernel_library() { \
        return &myriad::detail::library_of<Model, Method, R>;                                                         \
    }
