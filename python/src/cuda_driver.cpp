// SPDX-License-Identifier: MIT
// The GPU's runtime (gpu/runtime.hpp) on top of the driver's library, libcuda.so.1, which is loaded when it is first
// asked for: the Python package is compiled without CUDA, and runs where there is none. Numbers are those of cuda.h.
#include "cuda_driver.hpp"

#include <array>
#include <mutex>

#include <dlfcn.h>

namespace myriad::gpu {

namespace {

using device_pointer = std::uintptr_t;
using context = void*;

/// A function of the driver.
template <class... Arguments>
class function {
public:
    void find(void* library, const char* name) {
        call_ = reinterpret_cast<result (*)(Arguments...)>(dlsym(library, name));
    }
    bool exists() const { return call_ != nullptr; }
    result operator()(Arguments... a) const { return exists() ? call_(a...) : result::insufficient_driver; }

private:
    result (*call_)(Arguments...) = nullptr;
};

/// CUDA_MEMCPY2D of cuda.h.
struct copy_of_rows {
    std::size_t from_x = 0, from_y = 0;
    unsigned from_kind = 0;
    const void* from_host = nullptr;
    device_pointer from_device = 0;
    void* from_array = nullptr;
    std::size_t from_pitch = 0;
    std::size_t to_x = 0, to_y = 0;
    unsigned to_kind = 0;
    void* to_host = nullptr;
    device_pointer to_device = 0;
    void* to_array = nullptr;
    std::size_t to_pitch = 0;
    std::size_t width = 0, height = 0;
};

struct driver {
    result status = result::insufficient_driver;  // of loading it

    function<unsigned> init;
    function<int*> version;
    function<result, const char**> error_string, error_name;
    function<int*> device_count;
    function<int*, int> device;
    function<char*, int, int> device_name;
    function<std::size_t*, int> device_memory;
    function<int*, int, int> device_attribute;
    function<context*, int> retain_context;
    function<context> set_context;
    function<context*> current_context;
    function<int*> context_device;
    function<> synchronize;
    function<device_pointer*, std::size_t> allocate;
    function<device_pointer> release;
    function<std::size_t*, std::size_t*> memory_info;
    function<void**, std::size_t, unsigned> allocate_host;
    function<void*> release_host;
    function<void*, std::size_t, unsigned> pin;
    function<void*> unpin;
    function<void*, int, device_pointer> pointer_attribute;
    function<device_pointer, device_pointer, std::size_t, stream_handle> copy;
    function<const copy_of_rows*, stream_handle> copy_rows;
    function<device_pointer, unsigned char, std::size_t, stream_handle> set;
    function<stream_handle*, unsigned> create_stream;
    function<stream_handle> destroy_stream, wait_for_stream, query_stream;
    function<stream_handle, event_handle, unsigned> wait_for_event;
    function<event_handle*, unsigned> create_event;
    function<event_handle> destroy_event, synchronize_event;
    function<event_handle, stream_handle> record;
    function<float*, event_handle, event_handle> elapsed;
    function<int*, int, const void*> kernel_attribute;
    function<const void*, int, int> set_kernel_attribute;
    function<int*, const void*, int, std::size_t> occupancy;
    function<const void*, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, stream_handle, void**,
             void**>
        launch;
    function<void**, const void*> load;
    function<const void**, void*, const char*> kernel_of;

    driver() {
        void* const library = dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) return;
        bool complete = true;
        const auto find = [&](auto& f, const char* name, const char* newer = nullptr) {
            f.find(library, name);
            if (!f.exists() && newer != nullptr) f.find(library, newer);
            complete = complete && f.exists();
        };
        find(init, "cuInit");
        find(version, "cuDriverGetVersion");
        find(error_string, "cuGetErrorString");
        find(error_name, "cuGetErrorName");
        find(device_count, "cuDeviceGetCount");
        find(device, "cuDeviceGet");
        find(device_name, "cuDeviceGetName");
        find(device_memory, "cuDeviceTotalMem_v2");
        find(device_attribute, "cuDeviceGetAttribute");
        find(retain_context, "cuDevicePrimaryCtxRetain");
        find(set_context, "cuCtxSetCurrent");
        find(current_context, "cuCtxGetCurrent");
        find(context_device, "cuCtxGetDevice");
        find(synchronize, "cuCtxSynchronize");
        find(allocate, "cuMemAlloc_v2");
        find(release, "cuMemFree_v2");
        find(memory_info, "cuMemGetInfo_v2");
        find(allocate_host, "cuMemHostAlloc");
        find(release_host, "cuMemFreeHost");
        find(pin, "cuMemHostRegister_v2");
        find(unpin, "cuMemHostUnregister");
        find(pointer_attribute, "cuPointerGetAttribute");
        find(copy, "cuMemcpyAsync");
        find(copy_rows, "cuMemcpy2DAsync_v2");
        find(set, "cuMemsetD8Async");
        find(create_stream, "cuStreamCreate");
        find(destroy_stream, "cuStreamDestroy_v2");
        find(wait_for_stream, "cuStreamSynchronize");
        find(query_stream, "cuStreamQuery");
        find(wait_for_event, "cuStreamWaitEvent");
        find(create_event, "cuEventCreate");
        find(destroy_event, "cuEventDestroy_v2");
        find(synchronize_event, "cuEventSynchronize");
        find(record, "cuEventRecord");
        find(elapsed, "cuEventElapsedTime", "cuEventElapsedTime_v2");
        find(kernel_attribute, "cuFuncGetAttribute");
        find(set_kernel_attribute, "cuFuncSetAttribute");
        find(occupancy, "cuOccupancyMaxActiveBlocksPerMultiprocessor");
        find(launch, "cuLaunchKernel");
        find(load, "cuModuleLoadData");
        find(kernel_of, "cuModuleGetFunction");
        if (complete) status = init(0);
    }
};

driver& the() {
    static driver loaded;
    return loaded;
}

constexpr int most_devices = 64;
constexpr unsigned portable = 1;  // host memory for all devices

/// The primary context of a device, which other users of the driver, such as the runtime, have too. Kept for good.
result primary_context(int device, context* found) {
    static std::array<context, most_devices> known{};
    static std::mutex mutex;
    if (device < 0 || device >= most_devices) return result::invalid_device;
    const std::lock_guard lock(mutex);
    context& c = known[static_cast<std::size_t>(device)];
    if (c == nullptr) {
        int number = 0;
        if (const auto status = the().device(&number, device); status != result::success) return status;
        if (const auto status = the().retain_context(&c, number); status != result::success) return status;
    }
    *found = c;
    return result::success;
}

device_pointer number(const void* memory) { return reinterpret_cast<device_pointer>(memory); }

}  // namespace

const char* text_of(result status) {
    const char* text = nullptr;
    if (the().error_string.exists()) the().error_string(status, &text);
    if (text == nullptr && status == result::insufficient_driver)
        text = "there is no NVIDIA driver, or a very old one: libcuda.so.1 cannot be loaded";
    return text != nullptr ? text : "unknown error";
}
const char* name_of(result status) {
    const char* name = nullptr;
    if (the().error_name.exists()) the().error_name(status, &name);
    return name != nullptr ? name : "cudaErrorInsufficientDriver";
}
void forget_failure() {}  // the driver keeps none

result find_device_count(int* count) {
    if (the().status != result::success) return the().status;
    return the().device_count(count);
}
result find_device(int* device) {
    *device = -1;
    context now = nullptr;
    if (const auto status = the().current_context(&now); status != result::success || now == nullptr) return status;
    return the().context_device(device);
}
result set_device(int device) {
    context wanted = nullptr;
    if (device >= 0)
        if (const auto status = primary_context(device, &wanted); status != result::success) return status;
    return the().set_context(wanted);
}
result synchronise_device() { return the().synchronize(); }
result find_attribute(int* value, device_attribute which, int device) {
    constexpr int numbers[] = {16, 81, 97};
    return the().device_attribute(value, numbers[static_cast<int>(which)], device);
}
result find_properties(device_properties* p, int device) {
    constexpr int major = 75, minor = 76;
    for (const auto status :
         {the().device_name(p->name, sizeof p->name, device), the().device_memory(&p->memory_bytes, device),
          find_attribute(&p->multiprocessors, device_attribute::multiprocessors, device),
          the().device_attribute(&p->major, major, device), the().device_attribute(&p->minor, minor, device)})
        if (status != result::success) return status;
    return result::success;
}

result allocate(void** memory, std::size_t bytes) {
    device_pointer p = 0;
    const auto status = the().allocate(&p, bytes);
    *memory = reinterpret_cast<void*>(p);
    return status;
}
result release(void* memory) { return memory == nullptr ? result::success : the().release(number(memory)); }
result find_memory(std::size_t* free, std::size_t* total) { return the().memory_info(free, total); }
result allocate_pinned(void** memory, std::size_t bytes) { return the().allocate_host(memory, bytes, portable); }
result release_pinned(void* memory) { return memory == nullptr ? result::success : the().release_host(memory); }
result pin(void* memory, std::size_t bytes) { return the().pin(memory, bytes, portable); }
result unpin(void* memory) { return the().unpin(memory); }
result find_pinned(bool* pinned, const void* address) {
    constexpr int memory_type = 2;
    constexpr unsigned of_host = 1;
    unsigned type = 0;
    // an error for memory that the driver does not know
    const bool known = the().pointer_attribute(&type, memory_type, number(address)) == result::success;
    *pinned = known && type == of_host;
    return result::success;
}
result copy(void* to, const void* from, std::size_t bytes, direction, stream_handle stream) {
    return the().copy(number(to), number(from), bytes, stream);
}
result copy_rows(void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch, std::size_t width,
                 std::size_t height, direction, stream_handle stream) {
    constexpr unsigned found_by_address = 4;  // CU_MEMORYTYPE_UNIFIED
    copy_of_rows all;
    all.from_kind = all.to_kind = found_by_address;
    all.from_device = number(from);
    all.to_device = number(to);
    all.from_pitch = from_pitch;
    all.to_pitch = to_pitch;
    all.width = width;
    all.height = height;
    return the().copy_rows(&all, stream);
}
result fill(void* memory, int byte, std::size_t bytes, stream_handle stream) {
    return the().set(number(memory), static_cast<unsigned char>(byte), bytes, stream);
}

result create_stream(stream_handle* stream) {
    constexpr unsigned non_blocking = 1;
    return the().create_stream(stream, non_blocking);
}
result destroy_stream(stream_handle stream) { return the().destroy_stream(stream); }
result synchronise(stream_handle stream) { return the().wait_for_stream(stream); }
result query(stream_handle stream) { return the().query_stream(stream); }
result wait_for(stream_handle stream, event_handle event) { return the().wait_for_event(stream, event, 0); }
result create_event(event_handle* event, bool timed) {
    constexpr unsigned disable_timing = 2;
    return the().create_event(event, timed ? 0 : disable_timing);
}
result destroy_event(event_handle event) { return the().destroy_event(event); }
result record(event_handle event, stream_handle stream) { return the().record(event, stream); }
result synchronise(event_handle event) { return the().synchronize_event(event); }
result find_milliseconds(float* milliseconds, event_handle begin, event_handle end) {
    return the().elapsed(milliseconds, begin, end);
}

result find_attributes(kernel_attributes* attributes, const void* kernel) {
    constexpr int most_threads = 0, local_bytes = 3, registers = 4;
    int bytes = 0;
    for (const auto status : {the().kernel_attribute(&attributes->most_threads, most_threads, kernel),
                              the().kernel_attribute(&attributes->registers, registers, kernel),
                              the().kernel_attribute(&bytes, local_bytes, kernel)})
        if (status != result::success) return status;
    attributes->local_bytes = static_cast<std::size_t>(bytes);
    return result::success;
}
result allow_shared_bytes(const void* kernel, int bytes) {
    constexpr int most_shared_bytes = 8;
    return the().set_kernel_attribute(kernel, most_shared_bytes, bytes);
}
result prefer_shared_memory(const void* kernel, int percent) {
    constexpr int shared_memory_carveout = 9;
    return the().set_kernel_attribute(kernel, shared_memory_carveout, percent);
}
result find_resident_blocks(int* blocks, const void* kernel, int threads, std::size_t shared_bytes) {
    return the().occupancy(blocks, kernel, threads, shared_bytes);
}
result launch(const void* kernel, grid blocks, unsigned threads, void** arguments, std::size_t shared_bytes,
              stream_handle stream) {
    return the().launch(kernel, blocks.x, blocks.y, 1, threads, 1, 1, static_cast<unsigned>(shared_bytes), stream,
                        arguments, nullptr);
}

result load_module(void** module, const void* image) { return the().load(module, image); }
result find_kernel(const void** kernel, void* module, const char* name) {
    return the().kernel_of(kernel, module, name);
}
int driver_version() {
    int found = 0;
    if (the().status == result::success) the().version(&found);
    return found;
}

}  // namespace myriad::gpu
