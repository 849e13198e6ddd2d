// SPDX-License-Identifier: MIT
// What is known of a model and a method without their types: plain data, the same for kernels of CPUs and GPUs, whether
// the model is known when a program is compiled or only when it runs.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/past_layout.hpp"

namespace myriad::detail {

/// How many components of each kind a model has, and what its hooks write.
struct model_numbers {
#define MYRIAD_DECLARE_NUMBER(kind, ...) std::int32_t n_##kind;
    MYRIAD_COMPONENT_KINDS(MYRIAD_DECLARE_NUMBER)
#undef MYRIAD_DECLARE_NUMBER
    bool writes_parameters, writes_time_domain, has_diffusion;
    std::int32_t n_kept;        ///< states whose past is kept, in models with delays
    std::int32_t jump_numbers;  ///< numbers kept of each jump of the past

    constexpr bool operator==(const model_numbers&) const = default;
};

/// Where a model `with_tangents` has what notes about its exponents read; zeros for other models.
struct tangent_places {
    std::int32_t n_original;        ///< states of the model without tangents, which are the first
    std::int32_t n_vectors;         ///< tangent vectors
    std::int32_t first_growth;      ///< the accessory with the growth of the first; the others follow
    std::int32_t transient_phases;  ///< the shared integer with the number of phases that do not count
};

/// The properties of a model and a method that checks and notes of a call depend on.
struct call_facts {
    std::int32_t embedded_order;  ///< of the method, 0 for fixed steps
    bool scales_tolerances;       ///< in each instance
    bool samples_trajectory;
    bool hooks_may_stop;  ///< they can end a phase before t_end
    std::int32_t history_terms;
    tangent_places tangents;

    constexpr bool adaptive() const { return embedded_order > 0; }
};

template <class Model>
inline constexpr model_numbers numbers_of{
#define MYRIAD_NUMBER_OF(kind, ...) .n_##kind = n_##kind<Model>,
    MYRIAD_COMPONENT_KINDS(MYRIAD_NUMBER_OF)
#undef MYRIAD_NUMBER_OF
        .writes_parameters = writes_parameters<Model>,
    .writes_time_domain = writes_time_domain<Model>,
    .has_diffusion = has_diffusion<Model>,
    .n_kept = n_kept<Model>,
    .jump_numbers = jump_numbers<Model>,
};

}  // namespace myriad::detail
