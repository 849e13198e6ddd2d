// SPDX-License-Identifier: MIT
// The interface between the Python package's core and the kernels that it compiles at run time: plain data and function
// pointers, without the model's type. Both sides include this header, and a library of another version is refused.
#pragma once

#include <cstdint>

#include "myriad/host/backend/cpu_backend.hpp"
#include "myriad/host/checks/instance_functions.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/python/compiled_facts.hpp"

namespace myriad::python {

/// Sets the threads of the core to work: `openmp::in_parts`.
using team_starter = void (*)(openmp::team*);

/// What a compiled model tells of itself, and its kernel.
struct kernel_library {
    compiled_facts facts;
    std::int32_t instruction_set;  ///< as in openmp::instruction_set
    /// Integrates; `arguments` are `any_arguments` of the real type. At most `most_threads` threads.
    void (*run)(const void* arguments, const detail::run_options* options, int most_threads, team_starter start,
                detail::run_statistics* result);
    const void* functions;               ///< `instance_functions` of the real type
    const void* behaviour;               ///< `behaviour_function` of the real type
    const char* compiler = __VERSION__;  ///< of the file that makes this
};

/// The one function that a library exports, under this name.
using kernel_library_function = const kernel_library* (*)();
inline constexpr const char* kernel_library_symbol = "myriad_kernel_library";

}  // namespace myriad::python
