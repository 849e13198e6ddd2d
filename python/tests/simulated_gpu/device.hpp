// SPDX-License-Identifier: MIT
// Compiles a program for GPUs as code for this CPU, for tests of everything around it: what test_simulated_gpu.py puts
// before and after the source that NVRTC would get.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>  // which has an attribute of the name of a macro below
#include <tuple>
#include <utility>

#include "myriad/gpu/runtime.hpp"

#define MYRIAD_COMPILED_AT_RUN_TIME
#define MYRIAD_SIMULATED_TEAM 1
#define __global__
#define __device__
#define __forceinline__ inline __attribute__((always_inline))
#define __noinline__ __attribute__((noinline))
#define __launch_bounds__(...)
#define __grid_constant__

namespace simulated {

struct index {
    unsigned x, y;
};
/// What the driver sets for each thread, and its turn to another thread of the block.
struct place {
    index block, thread, blocks, threads;
    void (*yield)();
    unsigned long long* exchanged;  // one value per thread
};
inline place now;

inline void wait_for_block() { now.yield(); }

template <class T>
T add(T* to, T value) {
    const T before = *to;
    *to += value;
    return before;
}

template <class... A, std::size_t... i>
void call_with(void (*kernel)(A...), void** arguments, std::index_sequence<i...>) {
    kernel(*static_cast<std::remove_cv_t<A>*>(arguments[i])...);
}
template <class... A>
void call(void (*kernel)(A...), void** arguments) {
    simulated::call_with(kernel, arguments, std::index_sequence_for<A...>());
}

/// Copies of the arguments, which a launch may not outlive. For good, as tests are short.
template <class... A>
void** copy(void (*)(A...), void** arguments) {
    void** const copies = new void*[sizeof...(A) + 1];
    std::size_t i = 0;
    ((copies[i] = new std::remove_cv_t<A>(*static_cast<std::remove_cv_t<A>*>(arguments[i])), ++i), ...);
    return copies;
}

}  // namespace simulated

#define blockIdx (simulated::now.block)
#define threadIdx (simulated::now.thread)
#define gridDim (simulated::now.blocks)
#define blockDim (simulated::now.threads)
inline void __syncthreads() { simulated::wait_for_block(); }
inline unsigned atomicAdd(unsigned* to, unsigned value) { return simulated::add(to, value); }
inline unsigned long long atomicAdd(unsigned long long* to, unsigned long long value) {
    return simulated::add(to, value);
}
inline unsigned long long atomicMax(unsigned long long* to, unsigned long long value) {
    return std::exchange(*to, value > *to ? value : *to);
}
inline unsigned long long atomicMin(unsigned long long* to, unsigned long long value) {
    return std::exchange(*to, value < *to ? value : *to);
}

namespace myriad::gpu {
using lane_mask = std::uint32_t;
inline unsigned long long shuffle_down(lane_mask, unsigned long long value, int distance) {
    const unsigned me = simulated::now.thread.x, other = me + static_cast<unsigned>(distance);
    simulated::now.exchanged[me] = value;
    simulated::wait_for_block();
    const auto result = other / warp_size == me / warp_size ? simulated::now.exchanged[other] : value;
    simulated::wait_for_block();
    return result;
}
}  // namespace myriad::gpu

namespace myriad::simulated_team {
inline int number_of_thread() { return static_cast<int>(simulated::now.thread.x); }
inline void synchronise(int threads) {
    static struct {
        int waiting;
        unsigned times;
    } barriers[1024];
    auto& barrier = barriers[number_of_thread() / threads * threads];
    const unsigned before = barrier.times;
    if (++barrier.waiting == threads) {
        barrier.waiting = 0;
        ++barrier.times;
    }
    while (barrier.times == before) simulated::now.yield();
}
inline std::uint64_t exchange(std::uint64_t value, int from, int threads) {
    simulated::now.exchanged[number_of_thread()] = value;
    synchronise(threads);
    const std::uint64_t found = simulated::now.exchanged[from];
    synchronise(threads);
    return found;
}
inline void* memory() {
    alignas(16) static double of_block[32'768];
    return of_block;
}
}  // namespace myriad::simulated_team

// One copy of what a block shares, as blocks run one after the other.
#define __shared__ static
#include "myriad/cuda/cost_order_kernels.cuh"
#undef __shared__
#define __shared__
namespace myriad::detail::inline MYRIAD_TARGET {
double staged[32'768];
unsigned long long reduced_in_block[32'768];
}

#define SIMULATED_KERNEL(name)                                                          \
    extern "C" void run_##name(void** arguments) { simulated::call(&name, arguments); } \
    extern "C" void** copy_##name(void** arguments) { return simulated::copy(&name, arguments); }
#define SIMULATED_PROGRAM           \
    using namespace myriad::detail; \
    extern "C" void set_place(const simulated::place* where) { simulated::now = *where; }
