// SPDX-License-Identifier: MIT
// The arguments of a kernel, and what a compiled model tells of itself, without the model's type: plain data, the same
// for kernels of CPUs and GPUs.
#pragma once

#include <cstdint>

#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::python {

/// Changes with anything in this header and in those that include it.
inline constexpr std::uint32_t interface_version = 7;

/// `record_arguments` with pointers to as many columns as the model has components.
template <class R>
struct any_record {
    R* values;
    std::int32_t* integers;
    std::int32_t from_phase, phases;
    std::int16_t time_column;
    const std::int16_t *state_column, *accessory_column, *integer_accessory_column;
};

/// `sample_arguments` in the same way.
template <class R>
struct any_sample {
    R* time;
    R* values;
    std::int32_t* stored;
    const R* times;
    R* own_times;
    std::int32_t count, every, capacity, from_phase;
    R minimum_spacing;
    const std::int16_t* column;
};

/// `kernel_arguments` of any model. Tolerances and events point to as many as the model has states and events.
template <class R>
struct any_arguments : detail::instance_range, detail::instance_arrays<detail::array_pointer, R> {
    detail::shared_parameters<R> shared;
    std::uint32_t* cost;
    const std::uint32_t* order;
    std::int32_t phases, first_phase;
    R common_t_begin, common_t_end;
    R phase_length, phases_per_time;
    bool carry_time, carry_step;
    std::int32_t max_steps;
    R step, first_change, minimum_step, maximum_step;
    float growth_limit, shrink_limit;
    R *relative_tolerance, *absolute_tolerance;
    detail::event_arguments<R>* event;
    std::uint32_t *rising, *falling;
    std::int32_t sub_samples, accumulation_limit;
    any_record<R> record;
    any_sample<R> sample;
};

/// What a compiled model tells of itself.
struct model_facts {
    std::uint32_t interface_version;
    std::int32_t real_bytes;  ///< of its real type: 8 or 4
    std::int32_t n_state, n_parameter, n_shared, n_shared_integer, n_accessory, n_integer_accessory, n_event;
    std::int32_t embedded_order;  ///< of the method, 0 for fixed steps
    bool writes_parameters, writes_time_domain, hooks_may_stop;
    bool scales_tolerances, samples_trajectory;
    std::int32_t n_original, n_vectors;           ///< of a model with tangents; otherwise 0
    std::int32_t first_growth, transient_phases;  ///< the places of its accessory and its shared integer
};

}  // namespace myriad::python
