// SPDX-License-Identifier: MIT
// The part of the CUDA runtime that backends/cuda uses, on top of the driver's library, libcuda.so.1.
#include <array>
#include <mutex>

#include <cuda_runtime.h>
#include <dlfcn.h>

namespace {

using device_pointer = std::uintptr_t;
using context = void*;

/// A function of the driver.
template <class... Arguments>
class function {
public:
    void find(void* library, const char* name) {
        call_ = reinterpret_cast<cudaError_t (*)(Arguments...)>(dlsym(library, name));
    }
    bool exists() const { return call_ != nullptr; }
    cudaError_t operator()(Arguments... a) const { return exists() ? call_(a...) : cudaErrorInsufficientDriver; }

private:
    cudaError_t (*call_)(Arguments...) = nullptr;
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
    cudaError_t status = cudaErrorInsufficientDriver;  // of loading it

    function<unsigned> init;
    function<int*> version;
    function<cudaError_t, const char**> error_string, error_name;
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
    function<device_pointer, device_pointer, std::size_t, cudaStream_t> copy;
    function<const copy_of_rows*, cudaStream_t> copy_rows;
    function<device_pointer, unsigned char, std::size_t, cudaStream_t> set;
    function<cudaStream_t*, unsigned> create_stream;
    function<cudaStream_t> destroy_stream, wait_for_stream, query_stream;
    function<cudaStream_t, cudaEvent_t, unsigned> wait_for_event;
    function<cudaEvent_t*, unsigned> create_event;
    function<cudaEvent_t> destroy_event, synchronize_event;
    function<cudaEvent_t, cudaStream_t> record;
    function<float*, cudaEvent_t, cudaEvent_t> elapsed;
    function<int*, int, const void*> kernel_attribute;
    function<const void*, int, int> set_kernel_attribute;
    function<int*, const void*, int, std::size_t> occupancy;
    function<const void*, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, cudaStream_t, void**,
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

/// The primary context of a device, which other users of the driver, such as the runtime, have too. Kept for good.
cudaError_t primary_context(int device, context* found) {
    static std::array<context, most_devices> known{};
    static std::mutex mutex;
    if (device < 0 || device >= most_devices) return cudaErrorInvalidDevice;
    const std::lock_guard lock(mutex);
    context& c = known[static_cast<std::size_t>(device)];
    if (c == nullptr) {
        int number = 0;
        if (const auto status = the().device(&number, device); status != cudaSuccess) return status;
        if (const auto status = the().retain_context(&c, number); status != cudaSuccess) return status;
    }
    *found = c;
    return cudaSuccess;
}

device_pointer number(const void* memory) { return reinterpret_cast<device_pointer>(memory); }

}  // namespace

const char* cudaGetErrorString(cudaError_t status) {
    const char* text = nullptr;
    if (the().error_string.exists()) the().error_string(status, &text);
    if (text == nullptr && status == cudaErrorInsufficientDriver)
        text = "there is no NVIDIA driver, or a very old one: libcuda.so.1 cannot be loaded";
    return text != nullptr ? text : "unknown error";
}
const char* cudaGetErrorName(cudaError_t status) {
    const char* name = nullptr;
    if (the().error_name.exists()) the().error_name(status, &name);
    return name != nullptr ? name : "cudaErrorInsufficientDriver";
}

cudaError_t cudaGetDeviceCount(int* count) {
    if (the().status != cudaSuccess) return the().status;
    return the().device_count(count);
}
cudaError_t cudaGetDevice(int* device) {
    *device = -1;
    context now = nullptr;
    if (const auto status = the().current_context(&now); status != cudaSuccess || now == nullptr) return status;
    return the().context_device(device);
}
cudaError_t cudaSetDevice(int device) {
    context wanted = nullptr;
    if (device >= 0)
        if (const auto status = primary_context(device, &wanted); status != cudaSuccess) return status;
    return the().set_context(wanted);
}
cudaError_t cudaDeviceSynchronize() { return the().synchronize(); }
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int device) {
    return the().device_attribute(value, attribute, device);
}
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* p, int device) {
    constexpr int multiprocessors = cudaDevAttrMultiProcessorCount, major = 75, minor = 76;
    for (const auto status :
         {the().device_name(p->name, sizeof p->name, device), the().device_memory(&p->totalGlobalMem, device),
          the().device_attribute(&p->multiProcessorCount, multiprocessors, device),
          the().device_attribute(&p->major, major, device), the().device_attribute(&p->minor, minor, device)})
        if (status != cudaSuccess) return status;
    return cudaSuccess;
}

cudaError_t cudaMalloc(void** memory, std::size_t bytes) {
    device_pointer p = 0;
    const auto status = the().allocate(&p, bytes);
    *memory = reinterpret_cast<void*>(p);
    return status;
}
cudaError_t cudaFree(void* memory) { return memory == nullptr ? cudaSuccess : the().release(number(memory)); }
cudaError_t cudaMemGetInfo(std::size_t* free, std::size_t* total) { return the().memory_info(free, total); }
cudaError_t cudaHostAlloc(void** memory, std::size_t bytes, unsigned flags) {
    return the().allocate_host(memory, bytes, flags);
}
cudaError_t cudaFreeHost(void* memory) { return memory == nullptr ? cudaSuccess : the().release_host(memory); }
cudaError_t cudaHostRegister(void* memory, std::size_t bytes, unsigned flags) {
    return the().pin(memory, bytes, flags);
}
cudaError_t cudaHostUnregister(void* memory) { return the().unpin(memory); }
cudaError_t cudaPointerGetAttributes(cudaPointerAttributes* attributes, const void* memory) {
    constexpr int memory_type = 2;
    unsigned type = 0;
    // an error for memory that the driver does not know
    const bool known = the().pointer_attribute(&type, memory_type, number(memory)) == cudaSuccess;
    attributes->type = known ? static_cast<cudaMemoryType>(type) : cudaMemoryTypeUnregistered;
    return cudaSuccess;
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind, cudaStream_t stream) {
    return the().copy(number(to), number(from), bytes, stream);
}
cudaError_t cudaMemcpy2DAsync(void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
                              std::size_t width, std::size_t height, cudaMemcpyKind, cudaStream_t stream) {
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
cudaError_t cudaMemsetAsync(void* memory, int value, std::size_t bytes, cudaStream_t stream) {
    return the().set(number(memory), static_cast<unsigned char>(value), bytes, stream);
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags) {
    return the().create_stream(stream, flags);
}
cudaError_t cudaStreamDestroy(cudaStream_t stream) { return the().destroy_stream(stream); }
cudaError_t cudaStreamSynchronize(cudaStream_t stream) { return the().wait_for_stream(stream); }
cudaError_t cudaStreamQuery(cudaStream_t stream) { return the().query_stream(stream); }
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned flags) {
    return the().wait_for_event(stream, event, flags);
}
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned flags) { return the().create_event(event, flags); }
cudaError_t cudaEventDestroy(cudaEvent_t event) { return the().destroy_event(event); }
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) { return the().record(event, stream); }
cudaError_t cudaEventSynchronize(cudaEvent_t event) { return the().synchronize_event(event); }
cudaError_t cudaEventElapsedTime(float* milliseconds, cudaEvent_t begin, cudaEvent_t end) {
    return the().elapsed(milliseconds, begin, end);
}

cudaError_t cudaFuncGetAttributes(cudaFuncAttributes* attributes, const void* kernel) {
    constexpr int most_threads = 0, local_bytes = 3, registers = 4;
    int bytes = 0;
    for (const auto status : {the().kernel_attribute(&attributes->maxThreadsPerBlock, most_threads, kernel),
                              the().kernel_attribute(&attributes->numRegs, registers, kernel),
                              the().kernel_attribute(&bytes, local_bytes, kernel)})
        if (status != cudaSuccess) return status;
    attributes->localSizeBytes = static_cast<std::size_t>(bytes);
    return cudaSuccess;
}
cudaError_t cudaFuncSetAttribute(const void* kernel, cudaFuncAttribute attribute, int value) {
    return the().set_kernel_attribute(kernel, attribute, value);
}
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int* blocks, const void* kernel, int threads,
                                                          std::size_t shared_bytes) {
    return the().occupancy(blocks, kernel, threads, shared_bytes);
}
cudaError_t cudaLaunchKernel(const void* kernel, dim3 blocks, dim3 threads, void** arguments, std::size_t shared_bytes,
                             cudaStream_t stream) {
    return the().launch(kernel, blocks.x, blocks.y, blocks.z, threads.x, threads.y, threads.z,
                        static_cast<unsigned>(shared_bytes), stream, arguments, nullptr);
}

namespace myriad::python {

cudaError_t load_module(void** module, const void* image) { return the().load(module, image); }
cudaError_t find_kernel(const void** kernel, void* module, const char* name) {
    return the().kernel_of(kernel, module, name);
}
int driver_version() {
    int found = 0;
    if (the().status == cudaSuccess) the().version(&found);
    return found;
}

}  // namespace myriad::python
