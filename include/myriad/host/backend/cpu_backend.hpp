// SPDX-License-Identifier: MIT
// The interface between host code and the CPU's kernels, by itself: all that a model file needs of the host side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "myriad/host/backend/any_arguments.hpp"
#include "myriad/host/core/instruction_set.hpp"
#include "myriad/host/options/schedule.hpp"
#include "myriad/kernel/core/stop_request.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::detail {

/// What a backend needs besides the kernel's arguments.
struct run_options {
    int threads = 0;  ///< at most; 0: OMP_NUM_THREADS, or all cores
    /// Called in the calling thread with the number of instances done, the last time with all of them; may be null.
    bool (*progress)(void* context, std::int64_t done) = nullptr;  ///< returns whether to continue
    /// Asked in the calling thread many times a second, also while an instance takes long; may be null.
    stop_request (*stop)(void* context) = nullptr;
    void* context = nullptr;
    std::int64_t count = 0;  ///< instances to integrate, the first ones; 0: all
    myriad::schedule schedule = myriad::schedule::automatic;
    /// Called in the handler of an exception thrown by a function of the model, at most once; may be null.
    void (*caught)(void* failure) = nullptr;
    void* failure = nullptr;
};

/// How a run used its lanes.
struct run_statistics {
    std::int64_t lane_turns = 0;       ///< trial steps times lanes, idle lanes included; 0: not counted
    int lanes = 1;                     ///< instances side by side in one pack, or CUDA threads in a block
    int threads = 1;                   ///< that did some work
    const char* instruction_set = "";  ///< of the CPU's kernel
    bool computed_as_written = true;   ///< otherwise nothing was integrated, because of compiler flags: ieee.hpp
    bool failed = false;               ///< because a function of the model has thrown
    std::size_t stack = 0;             ///< bytes of stack that the kernel needs per thread,
    std::size_t least_stack = 0;       ///< and the fewest that a thread has; if too few, nothing was integrated
};

/// How many components of each kind a model has. Part of the names of its kernels, so that host code compiled with a
/// different model of the same name does not link to them.
template <class Model>
using component_counts = std::integer_sequence<int
#define MYRIAD_COUNT(kind, ...) , n_##kind<Model>
                                                   MYRIAD_COMPONENT_KINDS(MYRIAD_COUNT)
#undef MYRIAD_COUNT
                                               >;

/// Defined by MYRIAD_INSTANTIATE along with the kernels. It is not weak, so that linkers refuse a program with two
/// models of one name: the kernels of one would run for both.
template <class Backend, class Model, class Method, class R>
void instantiated_in_one_file_alone();

}  // namespace myriad::detail

namespace myriad {

// Everything below is weak, so that a program that uses a method not instantiated, or a backend it was built without,
// gets a readable error instead of a linker error.
namespace openmp {

/// The kernel for one instruction set. A program may contain several (MYRIAD_ARCH as a list), from which host code
/// chooses one for the CPU it runs on: cpu_kernel.hpp.
#define MYRIAD_DECLARE_KERNEL(set)                                                                      \
    template <class Model, class Method, class R, class Counts = component_counts<Model>>               \
    __attribute__((weak)) run_statistics run_on(for_set<instruction_set::set>, const any_arguments<R>&, \
                                                const run_options&);
MYRIAD_DECLARE_KERNEL(avx512)
MYRIAD_DECLARE_KERNEL(avx2)
MYRIAD_DECLARE_KERNEL(sse2)
MYRIAD_DECLARE_KERNEL(generic)
#undef MYRIAD_DECLARE_KERNEL

}  // namespace openmp

}  // namespace myriad
