// SPDX-License-Identifier: MIT
// The GPU's runtime by CUDA: gpu/runtime.hpp.
#pragma once
#if defined(__CUDACC__)

// A function without MYRIAD_FUNCTION is host code: nvcc would only warn if a kernel calls it, and leave the call out.
#pragma nv_diag_error 20011, 20013, 20014, 20015
#if defined(__CUDA_ARCH__)
#define MYRIAD_ON_GPU 1
#else
#define MYRIAD_ON_GPU 0
#endif
#if defined(__CUDACC_RTC__)
/// A program is compiled at run time, and its kernels are found by their names.
#define MYRIAD_COMPILED_AT_RUN_TIME
/// A function of other compilers: the number of a mask's lowest bit.
inline int __builtin_ctzll(unsigned long long x) { return __clzll(static_cast<long long>(__brevll(x))); }
#endif

#define MYRIAD_TARGET cuda_lane
#define MYRIAD_BACKEND_HEADER "myriad/cuda/run.cuh"
/// An optimisation barrier: hides from the compiler that a pointer or index has not changed, so that addresses are
/// recomputed instead of kept in registers through the loop.
#define MYRIAD_OPTIMISATION_BARRIER(value) asm volatile("" : "+l"(value))

namespace myriad::gpu {

/// Threads of a warp, and a set of them, a bit for each.
inline constexpr int warp_size = 32;
using lane_mask = std::uint32_t;

// What the threads of a warp do together, those of the mask.
/// Those that run at this place.
__device__ __forceinline__ lane_mask running_lanes() { return __activemask(); }
__device__ __forceinline__ lane_mask ballot(lane_mask of, bool holds) { return __ballot_sync(of, holds); }
__device__ __forceinline__ bool all(lane_mask of, bool holds) { return __all_sync(of, holds) != 0; }
__device__ __forceinline__ bool any(lane_mask of, bool holds) { return __any_sync(of, holds) != 0; }
__device__ __forceinline__ int count(lane_mask of) { return __popc(of); }
__device__ __forceinline__ void synchronise_warp(lane_mask of) { __syncwarp(of); }
/// The value of another one, among neighbours so many in number: that of a number, of one that differs in these bits,
/// and of one so many places behind.
template <class T>
__device__ __forceinline__ T shuffle(lane_mask of, T value, int from, int width) {
    return __shfl_sync(of, value, from, width);
}
template <class T>
__device__ __forceinline__ T shuffle_xor(lane_mask of, T value, int bits, int width) {
    return __shfl_xor_sync(of, value, bits, width);
}
template <class T>
__device__ __forceinline__ T shuffle_down(lane_mask of, T value, int distance) {
    return __shfl_down_sync(of, value, distance);
}
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
#define MYRIAD_GPU_HAS_LARGEST_OF_WARP
__device__ __forceinline__ unsigned largest_of_warp(lane_mask of, unsigned value) {
    return __reduce_max_sync(of, value);
}
#endif

/// Prefetches memory that is soon read into the nearest cache.
__device__ __forceinline__ void prefetch(const void* where) { asm volatile("prefetch.global.L1 [%0];" ::"l"(where)); }

// Functions of numbers. 1 / x and 1 / sqrt(x) to about 2^-20 in double precision; in single precision within an ulp
// or two; subnormal numbers are zero, but for the root and the logarithm of any number.
#define MYRIAD_APPROXIMATION(real, name, instruction, kind)  \
    __device__ __forceinline__ real name(real x) {           \
        real y;                                              \
        asm(instruction " %0, %1;" : "=" kind(y) : kind(x)); \
        return y;                                            \
    }
MYRIAD_APPROXIMATION(double, approximate_reciprocal, "rcp.approx.ftz.f64", "d")
MYRIAD_APPROXIMATION(float, approximate_reciprocal, "rcp.approx.ftz.f32", "f")
MYRIAD_APPROXIMATION(double, approximate_inverse_root, "rsqrt.approx.ftz.f64", "d")
MYRIAD_APPROXIMATION(float, approximate_inverse_root, "rsqrt.approx.ftz.f32", "f")
MYRIAD_APPROXIMATION(float, approximate_log2, "lg2.approx.ftz.f32", "f")
MYRIAD_APPROXIMATION(float, approximate_exp2, "ex2.approx.ftz.f32", "f")
MYRIAD_APPROXIMATION(float, approximate_root, "sqrt.approx.ftz.f32", "f")
MYRIAD_APPROXIMATION(float, approximate_log2_of_any, "lg2.approx.f32", "f")
MYRIAD_APPROXIMATION(float, approximate_root_of_any, "sqrt.approx.f32", "f")
#undef MYRIAD_APPROXIMATION
/// value (1 + growth) where |x| is at most a bound, else the value: without a choice between the two.
__device__ __forceinline__ float grown_up_to(float bound, float x, float value, float growth) {
    asm("{\n\t.reg .pred within;\n\tsetp.le.f32 within, %1, %2;\n\t@within fma.rn.f32 %0, %0, %3, %0;\n\t}"
        : "+f"(value)
        : "f"(fabsf(x)), "f"(bound), "f"(growth));
    return value;
}
/// Within a few ulps; zero where b is so large that its reciprocal is subnormal.
__device__ __forceinline__ float approximate_quotient(float a, float b) { return __fdividef(a, b); }
/// a / b rounded correctly, whatever option the compiler has for quotients.
__device__ __forceinline__ float rounded_quotient(float a, float b) { return __fdiv_rn(a, b); }
/// a * b rounded, where the compiler would fuse it with an addition.
__device__ __forceinline__ double rounded_product(double a, double b) { return __dmul_rn(a, b); }
#if defined(__CUDA_ARCH__)
#define MYRIAD_GPU_HAS_FMA_ROUNDED_DOWN
/// a * b + c rounded down.
__device__ __forceinline__ double fma_rounded_down(double a, double b, double c) { return __fma_rd(a, b, c); }
#endif
/// The upper half of a number's bits, and the number of two halves.
__device__ __forceinline__ int upper_half(double x) { return __double2hiint(x); }
__device__ __forceinline__ double from_halves(int upper, int lower) { return __hiloint2double(upper, lower); }
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
#define MYRIAD_GPU_HAS_LARGER_OR_NAN
/// NaN if either number is.
__device__ __forceinline__ float larger_or_nan(float a, float b) {
    float larger;
    asm("max.NaN.f32 %0, %1, %2;" : "=f"(larger) : "f"(a), "f"(b));
    return larger;
}
#endif

}  // namespace myriad::gpu

#if !defined(__CUDACC_RTC__)
#include <cuda_runtime.h>

namespace myriad::gpu {

inline result of_cuda(cudaError_t status) { return static_cast<result>(status); }
inline cudaError_t to_cuda(result status) { return static_cast<cudaError_t>(status); }
inline cudaStream_t to_cuda(stream_handle stream) { return reinterpret_cast<cudaStream_t>(stream); }
inline cudaEvent_t to_cuda(event_handle event) { return reinterpret_cast<cudaEvent_t>(event); }
inline cudaMemcpyKind to_cuda(direction way) {
    return way == direction::to_device ? cudaMemcpyHostToDevice
           : way == direction::to_host ? cudaMemcpyDeviceToHost
                                       : cudaMemcpyDeviceToDevice;
}

inline const char* text_of(result status) { return cudaGetErrorString(to_cuda(status)); }
inline const char* name_of(result status) { return cudaGetErrorName(to_cuda(status)); }
inline void forget_failure() { cudaGetLastError(); }

inline result find_device_count(int* count) { return of_cuda(cudaGetDeviceCount(count)); }
inline result find_device(int* device) { return of_cuda(cudaGetDevice(device)); }
inline result set_device(int device) { return of_cuda(cudaSetDevice(device)); }
inline result synchronise_device() { return of_cuda(cudaDeviceSynchronize()); }
inline result find_attribute(int* value, device_attribute which, int device) {
    constexpr cudaDeviceAttr all[] = {cudaDevAttrMultiProcessorCount, cudaDevAttrMaxSharedMemoryPerMultiprocessor,
                                      cudaDevAttrMaxSharedMemoryPerBlockOptin};
    return of_cuda(cudaDeviceGetAttribute(value, all[static_cast<int>(which)], device));
}
inline result find_properties(device_properties* properties, int device) {
    cudaDeviceProp all{};
    const result status = of_cuda(cudaGetDeviceProperties(&all, device));
    __builtin_memcpy(properties->name, all.name, sizeof properties->name);
    properties->memory_bytes = all.totalGlobalMem;
    properties->multiprocessors = all.multiProcessorCount;
    properties->major = all.major;
    properties->minor = all.minor;
    return status;
}

inline result allocate(void** memory, std::size_t bytes) { return of_cuda(cudaMalloc(memory, bytes)); }
inline result release(void* memory) { return of_cuda(cudaFree(memory)); }
inline result find_memory(std::size_t* free, std::size_t* total) { return of_cuda(cudaMemGetInfo(free, total)); }
inline result allocate_pinned(void** memory, std::size_t bytes) {
    return of_cuda(cudaHostAlloc(memory, bytes, cudaHostAllocPortable));
}
inline result release_pinned(void* memory) { return of_cuda(cudaFreeHost(memory)); }
inline result pin(void* memory, std::size_t bytes) {
    return of_cuda(cudaHostRegister(memory, bytes, cudaHostRegisterPortable));
}
inline result unpin(void* memory) { return of_cuda(cudaHostUnregister(memory)); }
inline result find_pinned(bool* pinned, const void* address) {
    cudaPointerAttributes facts{};
    const result status = of_cuda(cudaPointerGetAttributes(&facts, address));
    *pinned = facts.type == cudaMemoryTypeHost;
    return status;
}
inline result copy(void* to, const void* from, std::size_t bytes, direction way, stream_handle stream) {
    return of_cuda(cudaMemcpyAsync(to, from, bytes, to_cuda(way), to_cuda(stream)));
}
inline result copy_rows(void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch, std::size_t width,
                        std::size_t height, direction way, stream_handle stream) {
    return of_cuda(cudaMemcpy2DAsync(to, to_pitch, from, from_pitch, width, height, to_cuda(way), to_cuda(stream)));
}
inline result fill(void* memory, int byte, std::size_t bytes, stream_handle stream) {
    return of_cuda(cudaMemsetAsync(memory, byte, bytes, to_cuda(stream)));
}

inline result create_stream(stream_handle* stream) {
    return of_cuda(cudaStreamCreateWithFlags(reinterpret_cast<cudaStream_t*>(stream), cudaStreamNonBlocking));
}
inline result destroy_stream(stream_handle stream) { return of_cuda(cudaStreamDestroy(to_cuda(stream))); }
inline result synchronise(stream_handle stream) { return of_cuda(cudaStreamSynchronize(to_cuda(stream))); }
inline result query(stream_handle stream) { return of_cuda(cudaStreamQuery(to_cuda(stream))); }
inline result wait_for(stream_handle stream, event_handle event) {
    return of_cuda(cudaStreamWaitEvent(to_cuda(stream), to_cuda(event), 0));
}
inline result create_event(event_handle* event, bool timed) {
    return of_cuda(cudaEventCreateWithFlags(reinterpret_cast<cudaEvent_t*>(event),
                                            timed ? cudaEventDefault : cudaEventDisableTiming));
}
inline result destroy_event(event_handle event) { return of_cuda(cudaEventDestroy(to_cuda(event))); }
inline result record(event_handle event, stream_handle stream) {
    return of_cuda(cudaEventRecord(to_cuda(event), to_cuda(stream)));
}
inline result synchronise(event_handle event) { return of_cuda(cudaEventSynchronize(to_cuda(event))); }
inline result find_milliseconds(float* milliseconds, event_handle begin, event_handle end) {
    return of_cuda(cudaEventElapsedTime(milliseconds, to_cuda(begin), to_cuda(end)));
}

inline result find_attributes(kernel_attributes* attributes, const void* kernel) {
    cudaFuncAttributes all{};
    const result status = of_cuda(cudaFuncGetAttributes(&all, kernel));
    *attributes = {all.numRegs, all.maxThreadsPerBlock, all.localSizeBytes};
    return status;
}
inline result allow_shared_bytes(const void* kernel, int bytes) {
    return of_cuda(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes));
}
inline result prefer_shared_memory(const void* kernel, int percent) {
    return of_cuda(cudaFuncSetAttribute(kernel, cudaFuncAttributePreferredSharedMemoryCarveout, percent));
}
inline result find_resident_blocks(int* blocks, const void* kernel, int threads, std::size_t shared_bytes) {
    return of_cuda(cudaOccupancyMaxActiveBlocksPerMultiprocessor(blocks, kernel, threads, shared_bytes));
}
/// Not <<<>>>, which returns the status of the thread's last failure, whatever its cause.
inline result launch(const void* kernel, grid blocks, unsigned threads, void** arguments, std::size_t shared_bytes,
                     stream_handle stream) {
    return of_cuda(
        cudaLaunchKernel(kernel, dim3(blocks.x, blocks.y), dim3(threads), arguments, shared_bytes, to_cuda(stream)));
}

}  // namespace myriad::gpu
#endif
#endif
