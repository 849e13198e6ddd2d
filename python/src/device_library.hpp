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

#include <cuda_runtime.h>

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
