// SPDX-License-Identifier: MIT
// Teams: threads of a warp, or of several warps, that integrate one instance together, each a part of its state. What
// they do together is here; in kernels of one thread per instance all of it is nothing.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"

#if defined(MYRIAD_SIMULATED_TEAM) && !MYRIAD_FOR_GPU
// Tests run the threads of a block, or of a single team, one after the other on a CPU, each up to where it waits for
// the others.
namespace myriad::simulated_team {
/// The number of the running thread within the block.
int number_of_thread();
/// Waits for all threads of the team, `threads` in number.
void synchronise(int threads);
/// The value that thread `from` of the block, one of the same team, has given in the same call.
std::uint64_t exchange(std::uint64_t value, int from, int threads);
/// The memory that the threads share.
void* memory();
}  // namespace myriad::simulated_team
#endif

namespace myriad::detail::inline MYRIAD_TARGET {

/// The part of a model of coupled units that each of so many threads integrates: model/part_of_units.hpp.
template <class Whole, int threads>
struct part_of_units;

/// The number of threads that integrate an instance, and the model whose states they share out.
template <class Model>
struct team_of_model {
    static constexpr int threads = 1;
    using whole = Model;
};
template <class Whole, int n>
struct team_of_model<part_of_units<Whole, n>> {
    static constexpr int threads = n;
    using whole = Whole;
};
template <class Model>
inline constexpr int team_size = team_of_model<Model>::threads;
template <class Model>
using whole_of = typename team_of_model<Model>::whole;

/// Where the shared memory of this thread's block begins. Not constexpr, which has no such variables.
#if MYRIAD_FOR_GPU
__host__ __device__ __forceinline__ void* memory_of_block() {
#if MYRIAD_ON_GPU
    extern __shared__ __align__(16) double shared_by_block[];  // so that a thread may load 16 bytes at a time
    return shared_by_block;
#else
    return nullptr;  // never called
#endif
}
#elif defined(MYRIAD_SIMULATED_TEAM)
inline void* memory_of_block() { return simulated_team::memory(); }
#else
inline void* memory_of_block() { return nullptr; }
#endif

/// Most threads of a team: with 255 registers each, they fill a multiprocessor.
inline constexpr int most_threads_of_team = 256;
constexpr bool is_size_of_team(int threads) {
    return threads > 0 && threads <= most_threads_of_team && (threads & (threads - 1)) == 0;
}

/// What `threads` threads do together. Each function is called by all of them, and returns the same in all. Up to
/// a warp's number they are threads of one warp; more are all threads of a block.
template <int threads>
struct thread_team {
    static_assert(is_size_of_team(threads), "the threads of a team are a power of two, at most 256");
    /// Whether the team is a block.
    static constexpr bool is_block = threads > gpu::warp_size;
    /// Bytes at the beginning of a block's shared memory through which such a team exchanges numbers, one for each
    /// warp.
    static constexpr int exchange_bytes =
        is_block ? threads / gpu::warp_size * static_cast<int>(sizeof(std::uint64_t)) : 0;

    /// The number of this thread within its team.
    static MYRIAD_FUNCTION int number_of_thread() {
        if constexpr (threads == 1) return 0;
#if MYRIAD_ON_GPU
        return static_cast<int>(threadIdx.x) % threads;
#elif defined(MYRIAD_SIMULATED_TEAM) && !MYRIAD_FOR_GPU
        return simulated_team::number_of_thread() % threads;
#else
        return 0;
#endif
    }
    /// The number of the team within its block.
    static MYRIAD_FUNCTION int number_of_team() {
#if MYRIAD_ON_GPU
        return static_cast<int>(threadIdx.x) / threads;
#elif defined(MYRIAD_SIMULATED_TEAM) && !MYRIAD_FOR_GPU
        return simulated_team::number_of_thread() / threads;
#else
        return 0;
#endif
    }
    /// Whether this is the thread that writes what belongs to the whole instance.
    static MYRIAD_FUNCTION bool leads() { return number_of_thread() == 0; }

    /// Waits for all threads, which then see what the others have written.
    static MYRIAD_FUNCTION void synchronise() {
        if constexpr (threads > 1) {
#if MYRIAD_ON_GPU
            if constexpr (is_block) {
                __syncthreads();
            } else {
                gpu::synchronise_warp(mask());
            }
#elif defined(MYRIAD_SIMULATED_TEAM) && !MYRIAD_FOR_GPU
            simulated_team::synchronise(threads);
#endif
        }
    }

    /// Whether it holds in all threads; in packs, lane by lane.
    template <class M>
    static MYRIAD_FUNCTION M all(const M& holds) {
        if constexpr (threads == 1) {
            return holds;
        } else {
#if MYRIAD_ON_GPU
            if constexpr (is_block) {
                return __syncthreads_and(holds) != 0;
            } else {
                return gpu::all(mask(), holds);
            }
#else
            return largest_of(std::uint64_t{!holds}) == 0;
#endif
        }
    }

    /// Whether it holds in one of them.
    template <class M>
    static MYRIAD_FUNCTION M any(const M& holds) {
        if constexpr (threads == 1) {
            return holds;
        } else {
            return !all(!holds);
        }
    }

    /// The largest of the threads' non-negative numbers; NaN if one is. Their bits as integers have the same order,
    /// with NaN above infinity, so that it does not depend on the order of the threads.
    template <class S>
    static MYRIAD_FUNCTION S largest(const S& own) {
        if constexpr (threads == 1) {
            return own;
        } else if constexpr (sizeof(S) == sizeof(std::uint32_t)) {
            return __builtin_bit_cast(S, largest_of(__builtin_bit_cast(std::uint32_t, own) & 0x7fffffffu));
        } else {
            return __builtin_bit_cast(S,
                                      largest_of(__builtin_bit_cast(std::uint64_t, own) & ~(std::uint64_t{1} << 63)));
        }
    }

    /// The smallest of the threads' numbers, none of which is NaN. Their bits as unsigned integers have the same order,
    /// once the sign is inverted and, of negative real numbers, all bits.
    template <class S>
    static MYRIAD_FUNCTION S smallest(const S& own) {
        if constexpr (threads == 1) {
            return own;
        } else {
            using U = std::conditional_t<sizeof(S) == sizeof(std::uint32_t), std::uint32_t, std::uint64_t>;
            constexpr U sign = U{1} << (8 * sizeof(U) - 1);
            const auto inverted = [](U bits, bool negative) MYRIAD_LAMBDA {
                return negative && !std::is_integral_v<S> ? ~bits : bits ^ sign;
            };
            const U bits = __builtin_bit_cast(U, own), ordered = inverted(bits, (bits & sign) != 0);
            const U least = ~largest_of(static_cast<U>(~ordered));
            return __builtin_bit_cast(S, inverted(least, (least & sign) == 0));
        }
    }

    /// The value that the team's thread of that number has.
    template <class T>
    static MYRIAD_FUNCTION T of_thread(int number, T own) {
        if constexpr (threads > 1) {
#if MYRIAD_ON_GPU
            if constexpr (is_block) {
                T* const exchanged = static_cast<T*>(memory_of_block());
                if (number_of_thread() == number) *exchanged = own;
                __syncthreads();
                own = *exchanged;
                __syncthreads();  // all have read it
            } else {
                own = gpu::shuffle(mask(), own, number, threads);
            }
#elif defined(MYRIAD_SIMULATED_TEAM) && !MYRIAD_FOR_GPU
            std::uint64_t bits = 0;
            __builtin_memcpy(&bits, &own, sizeof own);
            bits = simulated_team::exchange(bits, number_of_team() * threads + number, threads);
            __builtin_memcpy(&own, &bits, sizeof own);
#endif
        }
        static_cast<void>(number);
        return own;
    }
    /// The value of the leading thread.
    template <class T>
    static MYRIAD_FUNCTION T of_leader(T own) {
        return of_thread(0, own);
    }

private:
#if MYRIAD_ON_GPU
    static __device__ __forceinline__ gpu::lane_mask mask() {
        if constexpr (threads == gpu::warp_size) {
            return ~gpu::lane_mask(0);
        } else {
            return ((gpu::lane_mask(1) << threads) - 1u) << (threadIdx.x % gpu::warp_size / threads * threads);
        }
    }
#endif
    template <int>
    friend struct thread_team;
    /// The largest of the threads' unsigned integers.
    template <class U>
    static MYRIAD_FUNCTION U largest_of(U own) {
#if MYRIAD_ON_GPU
        if constexpr (is_block) {
            constexpr int lanes = gpu::warp_size, warps = threads / lanes;
            U* const of_warps = static_cast<U*>(memory_of_block());
            own = thread_team<lanes>::largest_in_warp(own);
            if (number_of_thread() % lanes == 0) of_warps[number_of_thread() / lanes] = own;
            __syncthreads();
            own = thread_team<warps>::largest_in_warp(of_warps[number_of_thread() % warps]);
            __syncthreads();  // all have read them
            return own;
        } else {
            return largest_in_warp(own);
        }
#else
        return largest_in_warp(own);
#endif
    }
    /// The same in a warp, or in a simulated team.
    template <class U>
    static MYRIAD_FUNCTION U largest_in_warp(U own) {
#if defined(MYRIAD_GPU_HAS_LARGEST_OF_WARP)
        if constexpr (sizeof(U) == sizeof(unsigned)) {
            return gpu::largest_of_warp(mask(), own);
        } else {
            return largest_by_pairs(own);
        }
#else
        return largest_by_pairs(own);
#endif
    }
    template <class U>
    static MYRIAD_FUNCTION U largest_by_pairs(U own) {
        MYRIAD_UNROLL
        for (int distance = threads / 2; distance > 0; distance /= 2) {
            const U other = of_pair(own, distance);
            own = other > own ? other : own;
        }
        return own;
    }
    /// The value of the thread whose number differs in one bit.
    template <class U>
    static MYRIAD_FUNCTION U of_pair(U own, int distance) {
#if MYRIAD_ON_GPU
        return gpu::shuffle_xor(mask(), static_cast<device_integer<U>>(own), distance, threads);
#elif defined(MYRIAD_SIMULATED_TEAM) && !MYRIAD_FOR_GPU
        return static_cast<U>(simulated_team::exchange(own, simulated_team::number_of_thread() ^ distance, threads));
#else
        static_cast<void>(distance);
        return own;
#endif
    }
    /// CUDA's functions know no other 64-bit integer.
    template <class U>
    using device_integer = std::conditional_t<sizeof(U) == 8, unsigned long long, unsigned>;
};

/// A model that is the part of one thread: by this name its members are those that users' models do not have.
template <class Model>
using as_part = Model;

/// The team that integrates an instance of a model, or of the one of which it is a part.
template <class Model>
using team_for = thread_team<team_size<Model>>;

/// The number of a thread's state among those of the whole model.
template <class Model>
MYRIAD_FUNCTION int whole_state(int c) {
    if constexpr (team_size<Model> == 1) {
        return c;
    } else {
        return as_part<Model>::whole_state(c);
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
