// SPDX-License-Identifier: MIT
// A driver of GPUs, libcuda.so.1, that computes on this CPU: device memory is the host's, streams do their work at
// once, except for kernels, which run in a thread until their stream is used again, and programs are shared objects of
// device.hpp, whose threads are run one block at a time, each with a stack of its own. MYRIAD_SIMULATED_GPUS says how
// many devices there are, MYRIAD_SIMULATED_CAPABILITY which, MYRIAD_SIMULATED_MEGABYTES what memory each has, and
// MYRIAD_SIMULATED_LAUNCHES how many kernels the last one runs before it fails, and MYRIAD_SIMULATED_FULL_AFTER how
// many before another program takes what is left of its memory.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <dlfcn.h>
#include <elf.h>
#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

namespace {

constexpr int success = 0, invalid_value = 1, out_of_memory = 2, no_device = 100, invalid_context = 201,
              no_kernel_image = 209, not_found = 500, launch_failed = 719;
int number_from(const char* variable, int otherwise) {
    const char* const text = std::getenv(variable);
    return text != nullptr ? std::atoi(text) : otherwise;
}
const std::size_t memory_per_device = static_cast<std::size_t>(number_from("MYRIAD_SIMULATED_MEGABYTES", 1024)) << 20;
int devices() { return number_from("MYRIAD_SIMULATED_GPUS", 1); }

// Of the last device.
std::atomic<int> launches_left{number_from("MYRIAD_SIMULATED_LAUNCHES", 1 << 30)};
std::atomic<int> launches_before_full{number_from("MYRIAD_SIMULATED_FULL_AFTER", 1 << 30)};

thread_local int current = -1;  // device; contexts are its number plus one
/// Whether the current device works.
int state() {
    if (current < 0) return invalid_context;
    return current == devices() - 1 && launches_left <= 0 ? launch_failed : success;
}
std::mutex mutex;
std::map<std::uintptr_t, std::size_t> on_device;  // addresses and bytes
std::set<void*> pinned;
std::atomic<unsigned long long> uploaded{0};  // bytes copied to devices
bool is_on_device(std::uintptr_t address) {
    const std::lock_guard lock(mutex);
    const auto after = on_device.upper_bound(address);
    return after != on_device.begin() && address - std::prev(after)->first < std::prev(after)->second;
}

struct index {
    unsigned x, y;
};
struct place {
    index block, thread, blocks, threads;
    void (*yield)();
    unsigned long long* exchanged;
};
struct kernel {
    void (*run)(void**);
    void** (*copy)(void**);  // of the arguments
    void (*set_place)(const place*);
};

/// The threads of a block, each of which runs until it waits for the others.
class block_of_threads {
public:
    static void run(const kernel& code, index block, index blocks, unsigned threads, void** arguments) {
        block_of_threads all(code, block, blocks, threads, arguments);
        one = &all;
        for (unsigned t = 0; t < threads; ++t) all.start(t);
        for (bool left = true; left;) {
            left = false;
            for (unsigned t = 0; t < threads; ++t) {
                if (all.ended_[t]) continue;
                all.go_on(t);
                left = left || !all.ended_[t];
            }
        }
    }

private:
    static constexpr std::size_t stack_bytes = std::size_t{256} << 10;

    block_of_threads(const kernel& code, index block, index blocks, unsigned threads, void** arguments)
        : code_(code), arguments_(arguments), contexts_(threads), ended_(threads), exchanged_(threads + 32),
          stacks_(static_cast<std::byte*>(
              mmap(nullptr, threads * stack_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))),
          place_{block, {}, blocks, {threads, 1}, &yield, exchanged_.data()} {}
    ~block_of_threads() { munmap(stacks_, contexts_.size() * stack_bytes); }

    static void yield() { swapcontext(&one->contexts_[one->place_.thread.x], &one->main_); }
    static void begin() {
        one->code_.run(one->arguments_);
        one->ended_[one->place_.thread.x] = true;
    }
    void start(unsigned thread) {
        ucontext_t& c = contexts_[thread];
        getcontext(&c);
        c.uc_stack.ss_sp = stacks_ + thread * stack_bytes;
        c.uc_stack.ss_size = stack_bytes;
        c.uc_link = &main_;
        makecontext(&c, &begin, 0);
    }
    void go_on(unsigned thread) {
        place_.thread.x = thread;
        code_.set_place(&place_);
        swapcontext(&main_, &contexts_[thread]);
    }

    static inline block_of_threads* one = nullptr;

    kernel code_;
    void** arguments_;
    ucontext_t main_{};
    std::vector<ucontext_t> contexts_;
    std::vector<bool> ended_;
    std::vector<unsigned long long> exchanged_;
    std::byte* stacks_;
    place place_;
};

}  // namespace

namespace {

/// Work in order: the kernel that is running, which other work of the stream waits for.
class stream {
public:
    ~stream() { wait(); }
    bool busy() const { return running_; }
    void wait() {
        const std::lock_guard lock(mutex_);
        if (thread_.joinable()) thread_.join();
    }
    template <class Work>
    void begin(Work work) {
        wait();
        const std::lock_guard lock(mutex_);
        running_ = true;
        thread_ = std::thread([this, work] {
            work();
            running_ = false;
        });
    }

private:
    std::mutex mutex_;
    std::thread thread_;
    std::atomic<bool> running_{false};
};
/// What was recorded last.
struct event {
    std::atomic<stream*> of{nullptr};
};
void wait_for(void* s) {
    if (s != nullptr) static_cast<stream*>(s)->wait();
}

}  // namespace

#define DRIVER extern "C" __attribute__((visibility("default"))) int
#define NEEDS_CONTEXT \
    if (state() != success) return state()

/// Bytes that were copied to devices, for tests.
extern "C" __attribute__((visibility("default"))) unsigned long long simulated_uploaded() { return uploaded; }

DRIVER cuInit(unsigned) { return devices() > 0 ? success : no_device; }
DRIVER cuDriverGetVersion(int* version) {
    *version = 13000;
    return success;
}
DRIVER cuGetErrorString(int status, const char** text) {
    *text = status == no_device       ? "no CUDA-capable device is detected"
            : status == launch_failed ? "unspecified launch failure"
                                      : "simulated error";
    return success;
}
DRIVER cuGetErrorName(int, const char** text) {
    *text = "CUDA_ERROR_SIMULATED";
    return success;
}
DRIVER cuDeviceGetCount(int* count) {
    *count = devices();
    return success;
}
DRIVER cuDeviceGet(int* device, int number) {
    *device = number;
    return number < devices() ? success : invalid_value;
}
DRIVER cuDeviceGetName(char* name, int size, int device) {
    std::snprintf(name, static_cast<std::size_t>(size), "simulated GPU %d", device);
    return success;
}
DRIVER cuDeviceTotalMem_v2(std::size_t* bytes, int) {
    *bytes = memory_per_device;
    return success;
}
DRIVER cuDeviceGetAttribute(int* value, int attribute, int) {
    const int capability = number_from("MYRIAD_SIMULATED_CAPABILITY", 90);
    switch (attribute) {
        case 16:  // multiprocessors
            *value = 4;
            return success;
        case 75:
            *value = capability / 10;
            return success;
        case 76:
            *value = capability % 10;
            return success;
        case 81:  // shared memory of a multiprocessor
            *value = 233'472;
            return success;
        case 97:  // shared memory per block
            *value = 232'448;
            return success;
        default:
            return invalid_value;
    }
}
DRIVER cuDevicePrimaryCtxRetain(void** context, int device) {
    *context = reinterpret_cast<void*>(static_cast<std::uintptr_t>(device + 1));
    return success;
}
DRIVER cuCtxSetCurrent(void* context) {
    current = static_cast<int>(reinterpret_cast<std::uintptr_t>(context)) - 1;
    return success;
}
DRIVER cuCtxGetCurrent(void** context) {
    *context = reinterpret_cast<void*>(static_cast<std::uintptr_t>(current + 1));
    return success;
}
DRIVER cuCtxGetDevice(int* device) {
    *device = current;
    return current >= 0 ? success : invalid_context;
}
DRIVER cuCtxSynchronize() { return state(); }  // for work of other libraries, which there is none of
DRIVER cuMemAlloc_v2(std::uintptr_t* memory, std::size_t bytes) {
    NEEDS_CONTEXT;
    if (bytes > memory_per_device || (current == devices() - 1 && launches_before_full <= 0)) return out_of_memory;
    void* const p = std::aligned_alloc(512, (bytes + 511) / 512 * 512);
    std::memset(p, 0xa5, bytes);
    const std::lock_guard lock(mutex);
    *memory = reinterpret_cast<std::uintptr_t>(p);
    on_device[*memory] = bytes;
    return success;
}
DRIVER cuMemFree_v2(std::uintptr_t memory) {
    NEEDS_CONTEXT;
    const std::lock_guard lock(mutex);
    if (on_device.erase(memory) == 0) return invalid_value;
    std::free(reinterpret_cast<void*>(memory));
    return success;
}
DRIVER cuMemGetInfo_v2(std::size_t* free, std::size_t* total) {
    NEEDS_CONTEXT;
    *free = *total = memory_per_device;
    return success;
}
DRIVER cuMemHostAlloc(void** memory, std::size_t bytes, unsigned) {
    NEEDS_CONTEXT;
    *memory = std::malloc(bytes);
    const std::lock_guard lock(mutex);
    pinned.insert(*memory);
    return success;
}
DRIVER cuMemFreeHost(void* memory) {
    NEEDS_CONTEXT;
    const std::lock_guard lock(mutex);
    if (pinned.erase(memory) == 0) return invalid_value;
    std::free(memory);
    return success;
}
DRIVER cuMemHostRegister_v2(void*, std::size_t, unsigned) { return success; }
DRIVER cuMemHostUnregister(void*) { return success; }
DRIVER cuPointerGetAttribute(void*, int, std::uintptr_t) { return invalid_value; }  // pageable memory
DRIVER cuMemcpyAsync(std::uintptr_t to, std::uintptr_t from, std::size_t bytes, void* where) {
    NEEDS_CONTEXT;
    wait_for(where);
    if (is_on_device(to)) uploaded += bytes;
    std::memcpy(reinterpret_cast<void*>(to), reinterpret_cast<const void*>(from), bytes);
    return success;
}
/// CUDA_MEMCPY2D of cuda.h.
struct copy_of_rows {
    std::size_t from_x, from_y;
    unsigned from_kind;
    const void* from_host;
    std::uintptr_t from_device;
    void* from_array;
    std::size_t from_pitch, to_x, to_y;
    unsigned to_kind;
    void* to_host;
    std::uintptr_t to_device;
    void* to_array;
    std::size_t to_pitch, width, height;
};
DRIVER cuMemcpy2DAsync_v2(const copy_of_rows* all, void* where) {
    NEEDS_CONTEXT;
    if (all->width > std::min(all->from_pitch, all->to_pitch)) return invalid_value;
    wait_for(where);
    for (std::size_t row = 0; row < all->height; ++row)
        std::memcpy(reinterpret_cast<void*>(all->to_device + row * all->to_pitch),
                    reinterpret_cast<const void*>(all->from_device + row * all->from_pitch), all->width);
    return success;
}
DRIVER cuMemsetD8Async(std::uintptr_t memory, unsigned char value, std::size_t bytes, void* where) {
    NEEDS_CONTEXT;
    wait_for(where);
    std::memset(reinterpret_cast<void*>(memory), value, bytes);
    return success;
}
DRIVER cuStreamCreate(void** made, unsigned) {
    NEEDS_CONTEXT;
    *made = new stream;
    return success;
}
DRIVER cuStreamDestroy_v2(void* old) {
    NEEDS_CONTEXT;
    delete static_cast<stream*>(old);
    return success;
}
DRIVER cuStreamSynchronize(void* s) {
    wait_for(s);
    return state();
}
DRIVER cuStreamQuery(void* s) {
    constexpr int not_ready = 600;
    return s != nullptr && static_cast<stream*>(s)->busy() ? not_ready : state();
}
DRIVER cuStreamWaitEvent(void*, void* reached, unsigned) {
    wait_for(static_cast<event*>(reached)->of);
    return state();
}
DRIVER cuEventCreate(void** made, unsigned) {
    NEEDS_CONTEXT;
    *made = new event;
    return success;
}
DRIVER cuEventDestroy_v2(void* old) {
    NEEDS_CONTEXT;
    delete static_cast<event*>(old);
    return success;
}
DRIVER cuEventSynchronize(void* reached) {
    wait_for(static_cast<event*>(reached)->of);
    return success;
}
DRIVER cuEventRecord(void* reached, void* s) {
    static_cast<event*>(reached)->of = static_cast<stream*>(s);
    return state();
}
DRIVER cuEventElapsedTime(float* milliseconds, void*, void*) {
    *milliseconds = 1;
    return success;
}
DRIVER cuFuncGetAttribute(int* value, int attribute, const void*) {
    *value = attribute == 0 ? 128 : attribute == 4 ? 99 : 0;  // threads per block, registers
    return success;
}
DRIVER cuFuncSetAttribute(const void*, int, int) { return success; }
DRIVER cuOccupancyMaxActiveBlocksPerMultiprocessor(int* blocks, const void*, int threads, std::size_t) {
    *blocks = 256 / threads;
    return success;
}
DRIVER cuLaunchKernel(const void* function, unsigned blocks, unsigned rows, unsigned, unsigned threads, unsigned,
                      unsigned, unsigned, void* where, void** arguments, void**) {
    NEEDS_CONTEXT;
    if (current == devices() - 1) {
        --launches_left;
        --launches_before_full;
    }
    const kernel code = *static_cast<const kernel*>(function);
    const auto work = [=, copies = code.copy(arguments)] {
        static std::mutex one_at_a_time;
        const std::lock_guard lock(one_at_a_time);
        for (unsigned row = 0; row < rows; ++row)
            for (unsigned b = 0; b < blocks; ++b)
                block_of_threads::run(code, {b, row}, {blocks, rows}, threads, copies);
    };
    if (where == nullptr) {
        work();
    } else {
        static_cast<stream*>(where)->begin(work);
    }
    return success;
}
DRIVER cuModuleLoadData(void** module, const void* image) {
    NEEDS_CONTEXT;
    if (std::memcmp(image, ELFMAG, SELFMAG) != 0) return no_kernel_image;
    const auto& head = *static_cast<const Elf64_Ehdr*>(image);
    const int file = memfd_create("program", 0);
    const std::size_t bytes = head.e_shoff + std::size_t{head.e_shnum} * head.e_shentsize;
    if (write(file, image, bytes) != static_cast<ssize_t>(bytes)) return invalid_value;
    *module = dlopen(("/proc/self/fd/" + std::to_string(file)).c_str(), RTLD_NOW | RTLD_LOCAL);
    return *module != nullptr ? success : no_kernel_image;
}
DRIVER cuModuleGetFunction(const void** function, void* module, const char* name) {
    void* const run = dlsym(module, (std::string("run_") + name).c_str());
    void* const copy = dlsym(module, (std::string("copy_") + name).c_str());
    void* const set_place = dlsym(module, "set_place");
    if (run == nullptr || copy == nullptr || set_place == nullptr) return not_found;
    *function = new kernel{reinterpret_cast<void (*)(void**)>(run), reinterpret_cast<void** (*)(void**)>(copy),
                           reinterpret_cast<void (*)(const place*)>(set_place)};
    return success;
}
