// SPDX-License-Identifier: MIT
// A kernel of the interpreter, as the core calls it.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/model_facts.hpp"
#include "myriad/python/kernel_interface.hpp"

namespace myriad::python {

/// The interpreter for one method and one kind of models.
struct tape_kernel {
    detail::call_facts call;
    bool solves_linear_systems;
    void (*run)(const void* arguments, const detail::run_options* options, int most_threads, team_starter start,
                detail::run_statistics* result);
    std::int32_t instruction_set;
};

}  // namespace myriad::python
