// SPDX-License-Identifier: MIT
// What kernels use of the GPU's runtime (gpu/runtime.hpp) by HIP, for AMD's GPUs with 64 lanes: compiled for gfx90a by
// clang (tests/hip), and never run. The host's part is not there.
#pragma once
#if defined(__HIP__)

// Functions of the kernel body are constexpr, also those that use what is not; nvcc wants parentheses in #pragma
// unroll.
#pragma clang diagnostic ignored "-Winvalid-constexpr"
#pragma clang diagnostic ignored "-Wcuda-compat"
#if defined(__HIP_DEVICE_COMPILE__)
#define MYRIAD_ON_GPU 1
#else
#define MYRIAD_ON_GPU 0
#endif
#define MYRIAD_TARGET hip_lane
#define MYRIAD_OPTIMISATION_BARRIER(value) asm volatile("" : "+v"(value))

// HIP's language, as far as clang has it from a header of HIP's.
#define __forceinline__ inline __attribute__((always_inline))
#define __noinline__ __attribute__((noinline))
#define __align__(bytes) __attribute__((aligned(bytes)))
#define __grid_constant__
#define __launch_bounds__(threads, ...) __attribute__((amdgpu_flat_work_group_size(1, threads)))

namespace myriad::gpu {
struct coordinates {
    unsigned x, y;
};
__device__ __forceinline__ coordinates thread_in_block() {
    return {__builtin_amdgcn_workitem_id_x(), __builtin_amdgcn_workitem_id_y()};
}
__device__ __forceinline__ coordinates block_in_grid() {
    return {__builtin_amdgcn_workgroup_id_x(), __builtin_amdgcn_workgroup_id_y()};
}
__device__ __forceinline__ coordinates threads_of_block() {
    return {__builtin_amdgcn_workgroup_size_x(), __builtin_amdgcn_workgroup_size_y()};
}
__device__ __forceinline__ coordinates blocks_of_grid() {
    return {__builtin_amdgcn_grid_size_x() / __builtin_amdgcn_workgroup_size_x(),
            __builtin_amdgcn_grid_size_y() / __builtin_amdgcn_workgroup_size_y()};
}
}  // namespace myriad::gpu
#define threadIdx (::myriad::gpu::thread_in_block())
#define blockIdx (::myriad::gpu::block_in_grid())
#define blockDim (::myriad::gpu::threads_of_block())
#define gridDim (::myriad::gpu::blocks_of_grid())

__device__ __forceinline__ void __syncthreads() {
    __builtin_amdgcn_fence(__ATOMIC_RELEASE, "workgroup");
    __builtin_amdgcn_s_barrier();
    __builtin_amdgcn_fence(__ATOMIC_ACQUIRE, "workgroup");
}
__device__ __forceinline__ int __syncthreads_and(int holds) {
    __shared__ unsigned without;
    if (threadIdx.x == 0) without = 0;
    __syncthreads();
    if (!holds) __hip_atomic_fetch_add(&without, 1u, __ATOMIC_RELAXED, __HIP_MEMORY_SCOPE_WORKGROUP);
    __syncthreads();
    const bool all = without == 0;
    __syncthreads();  // all have read it
    return all;
}
template <class T>
__device__ __forceinline__ T atomicAdd(T* to, T value) {
    return __hip_atomic_fetch_add(to, value, __ATOMIC_RELAXED, __HIP_MEMORY_SCOPE_AGENT);
}
template <class T>
__device__ __forceinline__ T atomicMax(T* to, T value) {
    return __hip_atomic_fetch_max(to, value, __ATOMIC_RELAXED, __HIP_MEMORY_SCOPE_AGENT);
}
template <class T>
__device__ __forceinline__ T atomicMin(T* to, T value) {
    return __hip_atomic_fetch_min(to, value, __ATOMIC_RELAXED, __HIP_MEMORY_SCOPE_AGENT);
}

namespace myriad::gpu {

inline constexpr int warp_size = 64;
using lane_mask = std::uint64_t;
#if defined(__HIP_DEVICE_COMPILE__)
static_assert(__AMDGCN_WAVEFRONT_SIZE__ == warp_size, "a GPU whose waves have 64 lanes");
#endif

// The lanes of a wave that are on the same path go in step.
__device__ __forceinline__ lane_mask running_lanes() { return __builtin_amdgcn_ballot_w64(true); }
__device__ __forceinline__ lane_mask ballot(lane_mask of, bool holds) {
    return __builtin_amdgcn_ballot_w64(holds) & of;
}
__device__ __forceinline__ bool all(lane_mask of, bool holds) { return ballot(of, !holds) == 0; }
__device__ __forceinline__ bool any(lane_mask of, bool holds) { return ballot(of, holds) != 0; }
__device__ __forceinline__ int count(lane_mask of) { return __builtin_popcountll(of); }
__device__ __forceinline__ void synchronise_warp(lane_mask) {
    __builtin_amdgcn_fence(__ATOMIC_RELEASE, "wavefront");
    __builtin_amdgcn_wave_barrier();
    __builtin_amdgcn_fence(__ATOMIC_ACQUIRE, "wavefront");
}
__device__ __forceinline__ int number_of_lane() {
    return static_cast<int>(__builtin_amdgcn_mbcnt_hi(~0u, __builtin_amdgcn_mbcnt_lo(~0u, 0)));
}
/// The value of another lane, of 4 or 8 bytes, word by word.
template <class T>
__device__ __forceinline__ T of_lane(T value, int lane) {
    static_assert(sizeof(T) % sizeof(int) == 0);
    int words[sizeof(T) / sizeof(int)];
    __builtin_memcpy(words, &value, sizeof value);
    for (int& word : words) word = __builtin_amdgcn_ds_bpermute(static_cast<int>(sizeof(int)) * lane, word);
    __builtin_memcpy(&value, words, sizeof value);
    return value;
}
template <class T>
__device__ __forceinline__ T shuffle(lane_mask, T value, int from, int width) {
    return of_lane(value, number_of_lane() / width * width + from);
}
template <class T>
__device__ __forceinline__ T shuffle_xor(lane_mask, T value, int bits, int) {
    return of_lane(value, number_of_lane() ^ bits);
}
template <class T>
__device__ __forceinline__ T shuffle_down(lane_mask, T value, int distance) {
    const int lane = number_of_lane();
    return of_lane(value, lane + distance < warp_size ? lane + distance : lane);
}

__device__ __forceinline__ void prefetch(const void* where) { __builtin_prefetch(where); }

__device__ __forceinline__ double approximate_reciprocal(double x) { return __builtin_amdgcn_rcp(x); }
__device__ __forceinline__ float approximate_reciprocal(float x) { return __builtin_amdgcn_rcpf(x); }
__device__ __forceinline__ double approximate_inverse_root(double x) { return __builtin_amdgcn_rsq(x); }
__device__ __forceinline__ float approximate_inverse_root(float x) { return __builtin_amdgcn_rsqf(x); }
__device__ __forceinline__ float approximate_log2(float x) { return __builtin_amdgcn_logf(x); }
__device__ __forceinline__ float approximate_exp2(float x) { return __builtin_amdgcn_exp2f(x); }
__device__ __forceinline__ float approximate_root(float x) { return __builtin_amdgcn_sqrtf(x); }
__device__ __forceinline__ float approximate_log2_of_any(float x) {
    const bool subnormal = x < 0x1p-126f;
    return __builtin_amdgcn_logf(subnormal ? 0x1p23f * x : x) - (subnormal ? 23.0f : 0.0f);
}
__device__ __forceinline__ float approximate_root_of_any(float x) {
    const bool subnormal = x < 0x1p-126f;
    return __builtin_amdgcn_sqrtf(subnormal ? 0x1p24f * x : x) * (subnormal ? 0x1p-12f : 1.0f);
}
__device__ __forceinline__ float grown_up_to(float bound, float x, float value, float growth) {
    return __builtin_fabsf(x) <= bound ? __builtin_fmaf(value, growth, value) : value;
}
__device__ __forceinline__ float approximate_quotient(float a, float b) { return a * __builtin_amdgcn_rcpf(b); }
__device__ __forceinline__ float rounded_quotient(float a, float b) { return a / b; }
__device__ __forceinline__ double rounded_product(double a, double b) {
#pragma clang fp contract(off)
    return a * b;
}
__device__ __forceinline__ int upper_half(double x) {
    return static_cast<int>(__builtin_bit_cast(std::uint64_t, x) >> 32);
}
__device__ __forceinline__ double from_halves(int upper, int lower) {
    return __builtin_bit_cast(double, static_cast<std::uint64_t>(static_cast<std::uint32_t>(upper)) << 32 |
                                          static_cast<std::uint32_t>(lower));
}

}  // namespace myriad::gpu
#endif
