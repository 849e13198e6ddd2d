// SPDX-License-Identifier: MIT
// What a model that was compiled for GPUs tells of itself, and of where its kernel expects the arguments.
#pragma once

#include <cstdint>

#include "myriad/python/any_arguments.hpp"

namespace myriad::python {

/// Offsets in bytes of those launch parameters whose place depends on the model. Heads are what is as in
/// `any_arguments` and its parts, up to the sizes here.
struct argument_layout {
    std::uint32_t head, record_head, sample_head;
    std::uint32_t relative_tolerance, absolute_tolerance, event, rising, falling, sub_samples, accumulation_limit;
    std::uint32_t record, record_columns[3];  ///< of states, accessories and integer accessories
    std::uint32_t sample, sample_columns;
    std::uint32_t queue, stop, shared, shared_integer;  ///< the last two of a kernel that has them in the constant bank
    std::uint32_t size;
};

/// What a compiled program tells of itself, by its kernel `myriad_tell_facts`.
struct device_facts {
    model_facts model;
    argument_layout layout;
    myriad::shared_placement shared_placement;
    std::int32_t shared_bytes, max_block_size;
    bool costs_differ;
};

}  // namespace myriad::python
