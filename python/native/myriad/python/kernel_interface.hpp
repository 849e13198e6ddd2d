// SPDX-License-Identifier: MIT
// The interface between the Python package's core and the kernels that it compiles at run time: plain data and function
// pointers, without the model's type. Both sides include this header, and a library of another version is refused.
#pragma once

#include <cstdint>

#include "myriad/host/backend/cpu_backend.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/python/any_arguments.hpp"

namespace myriad::python {

/// Sets the threads of the core to work: `openmp::in_parts`.
using team_starter = void (*)(openmp::team*);

/// What a compiled model tells of itself, and its kernel.
struct kernel_library {
    model_facts model;
    std::int32_t instruction_set;  ///< as in openmp::instruction_set
    /// Integrates; `arguments` are `any_arguments` of the real type. At most `most_threads` threads.
    void (*run)(const void* arguments, const detail::run_options* options, int most_threads, team_starter start,
                detail::run_statistics* result);
    /// Calls the model's `generate` for instances [begin, end) of a study; null for a model that has none. Of the
    /// `any_arguments` it takes the range, the arrays and the shared parameters.
    void (*generate)(const void* arguments, std::uint64_t seed, std::int64_t begin, std::int64_t end);
    /// The right-hand side of instance i at time t in state y, and the longest stable step for y' = -y, for a note
    /// about stiffness; both null where no stiff method can be advised. `t`, `y` and `slopes` are of the real type.
    void (*rhs)(const void* arguments, std::int64_t i, const void* t, const void* y, void* slopes);
    double (*stability_limit)();
    /// What rounding leaves of the event functions of instance i; null where that is not known.
    void (*event_resolution)(const void* arguments, std::int64_t i, void* finest);
    const char* compiler = __VERSION__;  ///< of the file that makes this
};

/// The one function that a library exports, under this name.
using kernel_library_function = const kernel_library* (*)();
inline constexpr const char* kernel_library_symbol = "myriad_kernel_library";

}  // namespace myriad::python
