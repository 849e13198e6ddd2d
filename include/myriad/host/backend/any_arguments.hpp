// SPDX-License-Identifier: MIT
// The arguments of any model's kernel, as host and backends exchange them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "myriad/kernel/model/model_facts.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail {

/// The head of a kernel's arguments, and where the arrays are that follow it, `argument_arrays` of the model: a backend
/// puts both next to each other for its kernel.
template <class R>
struct any_arguments : argument_head<R> {
    const model_numbers* model;
    const std::byte* arrays;
    std::int32_t record_columns, integer_record_columns, sample_columns;  // as many as there are of each type

    argument_offsets<R> offsets() const { return argument_offsets<R>(*model); }
};

}  // namespace myriad::detail
