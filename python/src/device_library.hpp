// SPDX-License-Identifier: MIT
// Kernels for GPUs that NVRTC compiled: programs loaded on devices, and launched by the engine of backends/cuda.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "myriad/cuda/study_engine.cuh"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/python/device_facts.hpp"

namespace myriad::python {

/// What kernels are compiled for on a GPU.
struct gpu_facts {
    std::string name;
    int capability;    ///< 90 for 9.0
    int shared_bytes;  ///< the most shared memory of a block
};
/// Throws `error` if there is no GPU of that number.
gpu_facts facts_of_gpu(int device);
/// Waits for all work on the GPU, also of other libraries.
void wait_for_gpu(int device);
/// Copies within a GPU's memory, each from one address to another so many bytes, in a stream of another library, and
/// waits for it.
struct copy_of_bytes {
    std::uintptr_t to, from;
    std::size_t bytes;
};
void copy_on_gpu(int device, std::uintptr_t stream, const std::vector<copy_of_bytes>& all);

/// Memory of a GPU for a `gpu_kernel`. Throws `error` if there is too little.
class gpu_memory {
public:
    gpu_memory(int device, std::size_t bytes);
    ~gpu_memory();
    std::uintptr_t address() const { return reinterpret_cast<std::uintptr_t>(memory_->data()); }
    std::size_t bytes() const { return memory_->bytes(); }
    /// Copies bytes of the host to the memory, from its byte `to` on, and bytes of the memory, from its byte `from` on,
    /// to the host.
    void write(std::size_t to, const void* from, std::size_t bytes);
    void read(std::size_t from, void* to, std::size_t bytes) const;

private:
    int device_;
    std::unique_ptr<cuda::device_memory> memory_;
};

/// A kernel of a program in machine code or PTX. It takes one structure, by value, and has a thread for each element,
/// in blocks as large as its launch bounds. Throws `error` if the driver refuses the program.
class gpu_kernel {
public:
    gpu_kernel(const std::string& image, const std::string& name, int device);
    /// Launches it for `size` elements, and waits for its end.
    void run(const std::string& argument, std::int64_t size) const;

private:
    const void* kernel_ = nullptr;
    int device_, block_size_ = 1;
};

/// A program as machine code or PTX, and the devices it was loaded on; kept for the life of the process.
class device_program {
public:
    /// The kernels of a program on one device.
    struct kernels {
        device_facts facts{};
        const void *sum = nullptr, *find_not_finite = nullptr;
        cuda::model_kernels launched{};
    };

    explicit device_program(std::string image) : image_(std::move(image)) {}
    /// Loads the program on the device, unless it is there. Throws `error` if the driver refuses it, or if it is of
    /// another version.
    const kernels& on(int device);

private:
    std::string image_;
    std::mutex mutex_;
    std::map<int, kernels> loaded_;
};

/// Loads the kernels that set and reduce the instances of any study, from a program as machine code or PTX, unless the
/// device has them. Throws `error` if the driver refuses it.
void load_study_kernels(const std::string& image, int device);

/// Engines for a program on a GPU, as the options say that they are to work. Each is a `study_engine`.
template <class R>
host::engine_source<R> engines_of(device_program& program, const device& where, const options& o) {
    host::check_may_use_gpus();
    cuda::engine_options how = host::engine_options_for(where, o);
    how.shared_placement = program.on(how.device).facts.shared_placement;
    return {&program,
            [&program](const cuda::engine_options& wanted) {
                return std::make_unique<cuda::study_engine<R>>(wanted, program.on(wanted.device).launched);
            },
            how};
}

}  // namespace myriad::python
