// SPDX-License-Identifier: MIT
// The GPU's runtime, all that the library uses of it, under names of its own: what a compiler makes, warps, approximate
// functions, and for the host memory, streams, events and kernels. Its definitions: cuda.hpp, by the driver alone
// python/src/cuda_driver.cpp, and of what kernels use hip.hpp. What CUDA and HIP spell alike is used as it is:
// __global__, threadIdx, __syncthreads, atomicAdd.
#pragma once

#include <cstddef>
#include <cstdint>

// What the host asks for. CUDA, its driver and HIP give the results of calls the same numbers.
namespace myriad::gpu {

enum class result : int {
    success = 0,
    invalid_value = 1,
    out_of_memory = 2,
    not_initialised = 3,
    insufficient_driver = 35,
    invalid_device_function = 98,
    no_device = 100,
    invalid_device = 101,
    no_code_for_device = 209,
    unsupported_ptx_version = 222,
    not_ready = 600,
    illegal_address = 700,
    launch_out_of_resources = 701,
    launch_timeout = 702,
    illegal_instruction = 715,
    misaligned_address = 716,
    launch_failure = 719,
};
const char* text_of(result status);
const char* name_of(result status);
/// So that the next call does not report a failure again.
void forget_failure();

using stream_handle = struct stream_of_runtime*;
using event_handle = struct event_of_runtime*;
/// That in which work waits for all other.
inline constexpr stream_handle default_stream = nullptr;

enum class device_attribute { multiprocessors, shared_bytes_of_multiprocessor, shared_bytes_of_block };
struct device_properties {
    char name[256];
    std::size_t memory_bytes;
    int multiprocessors, major, minor;
};
result find_device_count(int* count);
/// -1 where the thread has no current device and the runtime knows none.
result find_device(int* device);
result set_device(int device);
result synchronise_device();
result find_attribute(int* value, device_attribute which, int device);
result find_properties(device_properties* properties, int device);

enum class direction { to_device, to_host, on_device };
result allocate(void** memory, std::size_t bytes);
result release(void* memory);
result find_memory(std::size_t* free, std::size_t* total);
/// Host memory that all devices copy fast.
result allocate_pinned(void** memory, std::size_t bytes);
result release_pinned(void* memory);
result pin(void* memory, std::size_t bytes);
result unpin(void* memory);
/// Whether an address is in such memory.
result find_pinned(bool* pinned, const void* address);
result copy(void* to, const void* from, std::size_t bytes, direction way, stream_handle stream);
result copy_rows(void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch, std::size_t width,
                 std::size_t height, direction way, stream_handle stream);
result fill(void* memory, int byte, std::size_t bytes, stream_handle stream);

/// Work in it waits for none in others.
result create_stream(stream_handle* stream);
result destroy_stream(stream_handle stream);
result synchronise(stream_handle stream);
result query(stream_handle stream);
result wait_for(stream_handle stream, event_handle event);
/// Of events, only timed ones tell the time between them.
result create_event(event_handle* event, bool timed);
result destroy_event(event_handle event);
result record(event_handle event, stream_handle stream);
result synchronise(event_handle event);
result find_milliseconds(float* milliseconds, event_handle begin, event_handle end);

struct kernel_attributes {
    int registers, most_threads;
    std::size_t local_bytes;  // of a thread
};
struct grid {
    unsigned x, y = 1;  // blocks
};
result find_attributes(kernel_attributes* attributes, const void* kernel);
/// The shared memory that its launches may ask for.
result allow_shared_bytes(const void* kernel, int bytes);
/// The part of a multiprocessor's memory to be shared memory, not cache.
result prefer_shared_memory(const void* kernel, int percent);
result find_resident_blocks(int* blocks, const void* kernel, int threads, std::size_t shared_bytes);
result launch(const void* kernel, grid blocks, unsigned threads, void** arguments, std::size_t shared_bytes,
              stream_handle stream);

}  // namespace myriad::gpu

// MYRIAD_FOR_GPU: whether a compiler for GPUs reads this, for the GPU or for the host.
// MYRIAD_ON_GPU: whether it makes a GPU's code.
#if defined(__CUDACC__)
#define MYRIAD_FOR_GPU 1
#include "myriad/gpu/cuda.hpp"
#elif defined(__HIP__)
#define MYRIAD_FOR_GPU 1
#include "myriad/gpu/hip.hpp"
#else
#define MYRIAD_FOR_GPU 0
#define MYRIAD_ON_GPU 0
namespace myriad::gpu {
/// Threads of a warp: those of NVIDIA's GPUs.
inline constexpr int warp_size = 32;
}  // namespace myriad::gpu
#endif
