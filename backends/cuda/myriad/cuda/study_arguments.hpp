// SPDX-License-Identifier: MIT
// The arguments of the kernels of studies, for these and for host code that launches them.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/study/axis_rule.hpp"
#include "myriad/kernel/study/reduced_values.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A component of all instances of a chunk, on the device.
struct filled_component {
    axis_rule rule;
    void* to;
    value_type type;  // f64, f32 or i32
    bool must_be_finite, must_not_be_nan;
};
/// The components that one launch sets.
struct fill_arguments {
    static constexpr int most = 32;
    filled_component components[most];
    int count;
    std::uint64_t seed;
    std::int64_t first, size;  // the number of the first instance in the study, instances
    std::uint8_t* ended;       // of those that are marked; null: none is
    status* how;
};

/// A reduction, and where its result goes: integers that are zero before.
struct reduce_arguments {
    value_array all;
    const status* how;  // of each instance
    reduction_kind kind;
    const double* edges;
    std::int64_t bins;
    bool in_shared_memory;  // the counts of one histogram
    unsigned long long* to;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::cuda {

/// The kernels of cuda/study_kernels.cuh; `generate_instances` is null for a model that sets none.
struct study_kernels {
    const void *fill_components, *gather_values, *reduce_values, *generate_instances;
};

}  // namespace myriad::cuda
