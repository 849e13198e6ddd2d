// SPDX-License-Identifier: MIT
// Where a step keeps what is too large for a thread's registers: with the thread's own variables, or in the shared
// memory of its block. Of explicit methods that is the trial step, of Rosenbrock methods, whose stages are a loop then,
// the stages and the factors.
#pragma once

#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/stepper/rosenbrock.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Bytes of the registers that a GPU's thread can have.
inline constexpr int register_bytes = 255 * 4;

template <class Method, class Model, class S>
constexpr bool loops_over_stages_of() {
    if constexpr (factorises_sparsely<Model> && lanes_of<S> == 1) {
        return static_cast<int>(sizeof(S)) * Method::stages * n_state<Model> > register_bytes;
    } else {
        return false;
    }
}
/// Whether the stages are a loop: if they alone are more than registers hold. They lie in memory either way then, and a
/// loop has less code and spills less. NVIDIA H200, rodas_5p, ms for written-out stages and for a loop, in an earlier
/// form: 8 states 4.3 and 14.5 (512 bytes), pollution with 20 states in single precision 0.35 and 0.97 (640), in double
/// precision 4.0 and 3.3 (1280), ring of 32 states 80 and 77 (2048), of 64 states 654 and 250 (4096). At 34fad3e, ring
/// of 32 states in single precision (1024): 4.8 and 3.4, and of 32 768 instances 17.2 and 8.6.
template <class Method, class Model, class S>
inline constexpr bool loops_over_stages = loops_over_stages_of<Method, Model, S>();

/// Whether stages and factors take more than half of the registers. Then fewer threads with all of them are faster,
/// else more threads, of which one works while another waits.
template <class Method, class Model, class R>
constexpr bool fills_registers() {
    if constexpr (rosenbrock_method<Method>) {  // else the factors of large models need not be counted
        if constexpr (factorises_sparsely<Model>) {
            constexpr int numbers = Method::stages * n_state<Model> + n_factor_entry<Model>;
            return 2 * numbers * static_cast<int>(sizeof(R)) > register_bytes;
        }
    }
    return false;
}

/// Bytes that a GPU's thread loads from its block's shared memory at a time, if they lie side by side.
inline constexpr int bytes_loaded_at_once = 16;

/// What a thread has in the shared memory of its block: the stages, and with them the factors if there is room.
template <class Method, class Model, class R>
struct stage_memory {
    vec<vec<R, n_state<Model>>, Method::stages> u;
    vec<R, n_state<Model>> y;  // the argument of a stage, and the new state
};
template <class Method, class Model, class R>
struct step_memory : stage_memory<Method, Model, R> {
    alignas(bytes_loaded_at_once) R factor[n_factor_entry<Model>];
};
/// Bytes from one thread's to the next one's: an odd number of loads, so that no two of the threads whose loads are
/// served together meet in a bank.
template <class Memory>
inline constexpr int step_memory_stride =
    static_cast<int>(((sizeof(Memory) + bytes_loaded_at_once - 1) / bytes_loaded_at_once | 1) * bytes_loaded_at_once);
/// Largest such stride with which a warp's 32 threads fit the 227 kB of a multiprocessor. NVIDIA H100: 10 000 instances
/// of EARM, 77 states, 524 ms without, 424 with the stages, 5.5 kB; 65 536 of Lorenz 96 with 80 and 96 states by
/// dormand_prince_5 47 and 54 ms without, 19 and 32 with 5.2 and 6.2 kB.
inline constexpr int largest_step_memory_stride = 7200;
/// The same for stages and factors together: more of them leave too little cache for the rest. NVIDIA H100: 1000 rings
/// of 64 states 40 ms with all 7.1 kB of a thread there, 34 with the stages alone, 4.6 kB, and 55 without.
inline constexpr int largest_stride_with_factors = 4800;

/// Largest trial step of an explicit method that is left to registers, and what of it they do not hold to local memory.
/// Lorenz 96, dormand_prince_5 at 1e-6, 131 072 instances, NVIDIA H100, ms in registers and in shared memory, for 16
/// states (1024 bytes) 0.68 and 1.6, 20 (1280) 0.87 and 1.9, 24 (1536) 2.1 and 2.5, 32 (2048) 17 and 4.6.
inline constexpr int largest_trial_in_registers = 1600;
/// Where a heavy right-hand side is called, all are: more threads can run then. 32 of Kuramoto's oscillators 4.25 ms,
/// and 7.2 with shared memory.
template <class Model, class R>
inline constexpr bool leaves_trial_to_registers = calls_rhs<Model, R>;

template <class Method, class Model, class R>
constexpr int shared_step_bytes_of() {
#if MYRIAD_FOR_GPU
    if constexpr (rosenbrock_method<Method>) {
        if constexpr (loops_over_stages<Method, Model, R>) {
            constexpr int in_registers = static_cast<int>(sizeof(R)) * (n_factor_entry<Model> + 3 * n_state<Model>);
            constexpr int all = step_memory_stride<step_memory<Method, Model, R>>;
            constexpr int stages = step_memory_stride<stage_memory<Method, Model, R>>;
            if (in_registers <= register_bytes) return 0;
            if (all <= largest_stride_with_factors) return all;
            if (stages <= largest_step_memory_stride) return stages;
        }
    } else if constexpr (Method::embedded_order > 0 && team_size<Model> == 1) {
        constexpr int trial = step_memory_stride<trial_step<Method, R, n_state<Model>>>;
        if (!leaves_trial_to_registers<Model, R> && trial > largest_trial_in_registers &&
            trial <= largest_step_memory_stride)
            return trial;
    }
#endif
    return 0;
}
/// Bytes of shared memory that a thread's steps take; zero if they take none: on CPUs, in teams, whose threads share
/// the state out, with fixed steps of explicit methods, if registers hold the trial step, or the factors beside the
/// vectors of a solve, and beyond the largest stride. Local memory has room for 32 threads a warp, however many run,
/// and it is the cache's choice what stays; shared memory has room for those that run, and no more threads run at a
/// time than it has room for. docs/numerics/stiff_methods.md has what that gains.
template <class Method, class Model, class R>
inline constexpr int shared_step_bytes = shared_step_bytes_of<Method, Model, R>();

/// Whether a Rosenbrock method's stages lie there.
template <class Method, class Model, class R>
inline constexpr bool shares_stages = rosenbrock_method<Method> && (shared_step_bytes<Method, Model, R> > 0);
/// Whether the factors lie there, too.
template <class Method, class Model, class R>
inline constexpr bool shares_factors =
    shared_step_bytes<Method, Model, R> == step_memory_stride<step_memory<Method, Model, R>>;

/// This thread's, the first in the block's shared memory.
template <class Memory, int bytes_of_thread>
MYRIAD_FUNCTION Memory& step_memory_of_thread() {
#if MYRIAD_ON_GPU
    return *reinterpret_cast<Memory*>(static_cast<char*>(memory_of_block()) + threadIdx.x * bytes_of_thread);
#else
    return *static_cast<Memory*>(nullptr);  // never called
#endif
}
template <class Method, class Model, class R>
using memory_of_rosenbrock_step =
    std::conditional_t<shares_factors<Method, Model, R>, step_memory<Method, Model, R>, stage_memory<Method, Model, R>>;
/// The stages and the new state of the step that this thread has taken last, if they lie there.
template <class Method, class Model, class R>
MYRIAD_FUNCTION const stage_memory<Method, Model, R>& stages_of_thread() {
    return step_memory_of_thread<memory_of_rosenbrock_step<Method, Model, R>, shared_step_bytes<Method, Model, R>>();
}

/// Where the loop's trial step is.
template <class Method, class Model, class S>
struct trial_storage {
    trial_step<Method, S, n_state<Model>> own;
    MYRIAD_FUNCTION trial_step<Method, S, n_state<Model>>& trial() { return own; }
};
#if MYRIAD_FOR_GPU
template <class Method, class Model, class S>
requires(!rosenbrock_method<Method> && shared_step_bytes<Method, Model, S> > 0) struct trial_storage<Method, Model, S> {
    MYRIAD_FUNCTION trial_step<Method, S, n_state<Model>>& trial() {
        return step_memory_of_thread<trial_step<Method, S, n_state<Model>>, shared_step_bytes<Method, Model, S>>();
    }
};
#endif

/// Stages in the trial step, factors in variables.
template <class Method, class Model, class R>
class own_step {
public:
    static constexpr auto n = n_state<Model>;
    MYRIAD_FUNCTION explicit own_step(trial_step<Method, R, n>& trial) : trial_(trial) {}

    MYRIAD_FUNCTION vec<vec<R, n>, Method::stages>& u() { return trial_.u; }
    MYRIAD_FUNCTION vec<R, n>& argument() { return trial_.y; }
    /// Stage i, just solved for, which `x` is.
    MYRIAD_FUNCTION const vec<R, n>& solved(int, const vec<R, n>& x) { return x; }
    template <class I>
    MYRIAD_FUNCTION void keep(I, const R&) {}
    MYRIAD_FUNCTION const R* factors(const sparse_lu_factors<Model, R>& lu) { return lu.a; }
    MYRIAD_FUNCTION void read_again() {}
    MYRIAD_FUNCTION void finish() {}

private:
    trial_step<Method, R, n>& trial_;
};

#if MYRIAD_FOR_GPU
/// Stages in the shared memory of the block, and factors there or in variables.
template <class Method, class Model, class R>
class shared_step {
public:
    static constexpr auto n = n_state<Model>;
    MYRIAD_FUNCTION explicit shared_step(trial_step<Method, R, n>& trial)
        : trial_(trial), memory_(step_memory_of_thread<memory, shared_step_bytes<Method, Model, R>>()) {}

    MYRIAD_FUNCTION vec<vec<R, n>, Method::stages>& u() { return memory_.u; }
    MYRIAD_FUNCTION vec<R, n>& argument() { return memory_.y; }
    MYRIAD_FUNCTION const vec<R, n>& solved(int i, const vec<R, n>&) { return memory_.u[i]; }
    template <class I>
    MYRIAD_FUNCTION void keep(I entry, const R& value) {
        if constexpr (shares_factors<Method, Model, R>) memory_.factor[entry] = value;
    }
    MYRIAD_FUNCTION const R* factors(const sparse_lu_factors<Model, R>& lu) {
        if constexpr (shares_factors<Method, Model, R>) {
            return memory_.factor;
        } else {
            return lu.a;
        }
    }
    /// From here on nothing that was written there is known from registers, which nvcc would fill with it, and spill.
    MYRIAD_FUNCTION void read_again() { MYRIAD_MEMORY_BARRIER; }
    /// The stages are the trial step's, of which only what is used later is copied.
    MYRIAD_FUNCTION void finish() {
        unrolled_loop<n>::all([&](auto c) MYRIAD_LAMBDA {
            static_for<0, Method::stages>([&](auto i) MYRIAD_LAMBDA { trial_.u[i][c] = memory_.u[i][c]; });
            trial_.y[c] = memory_.y[c];
        });
    }

private:
    using memory = memory_of_rosenbrock_step<Method, Model, R>;
    trial_step<Method, R, n>& trial_;
    memory& memory_;
};
template <class Method, class Model, class R>
using step_storage =
    std::conditional_t<shares_stages<Method, Model, R>, shared_step<Method, Model, R>, own_step<Method, Model, R>>;
#else
template <class Method, class Model, class R>
using step_storage = own_step<Method, Model, R>;
#endif

}  // namespace myriad::detail::inline MYRIAD_TARGET
