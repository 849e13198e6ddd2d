// SPDX-License-Identifier: MIT
// Kernels for GPUs that NVRTC compiled: programs loaded on devices, and launched by the engine of backends/cuda.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <cuda_runtime.h>

#include "myriad/cuda/study_engine.cuh"
#include "myriad/host/backend/arrays.hpp"
#include "myriad/host/model/model_shape.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/python/any_arguments.hpp"
#include "myriad/python/device_layout.hpp"

namespace myriad::python {

/// The arguments of a model of that shape, as engines take them.
template <class R>
struct shaped_arguments : any_arguments<R> {
    const host::model_shape* shape;
};
template <class R, class Visit>
void for_each_array(shaped_arguments<R>& a, Visit&& visit) {
    detail::for_each_array_of<R>(*a.shape, a, detail::columns_in(a.sample.column, a.shape->n_state), visit);
}
template <class R, class Visit>
void for_each_record(shaped_arguments<R>& a, Visit&& visit) {
    const auto& r = a.record;
    const int reals = std::max({detail::columns_in(r.state_column, a.shape->n_state),
                                detail::columns_in(r.accessory_column, a.shape->n_accessory), r.time_column + 1});
    const int integers = detail::columns_in(r.integer_accessory_column, a.shape->n_integer_accessory);
    detail::for_each_record_of(a.record, reals, integers, visit);
}

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

/// A program as machine code or PTX, and the devices it was loaded on; kept for the life of the process.
class device_program {
public:
    /// The kernels of a program on one device.
    struct kernels {
        device_facts facts{};
        int device = 0;
        const void *integrate = nullptr, *sum = nullptr, *find_not_finite = nullptr;
        const void* generate = nullptr;  ///< of a model that sets the instances of studies
        cuda::cost_kernels sort{};
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

/// A program's kernel on a device, for `cuda::study_engine`.
template <class R>
class loaded_kernel {
public:
    using arguments = shaped_arguments<R>;
    using real = R;

    explicit loaded_kernel(const device_program::kernels& all);

    cuda::kernel_traits traits() const;
    const void* function(shared_placement) const { return all_->integrate; }
    cuda::cost_kernels sort() const { return all_->sort; }
    /// Those that `load_study_kernels` has loaded.
    cuda::study_kernels study() const;
    void set_shared(const detail::shared_parameters<R>& shared);
    void launch(shared_placement, const arguments& a, unsigned long long* queue, const cuda::launch_shape& how);

private:
    /// Writes values to a place of the launch parameters.
    template <class T>
    void put(std::uint32_t offset, const T* values, int count);
    /// Writes an object up to a member, which must be as many bytes.
    template <class Object, class Member>
    void put_head(std::uint32_t offset, const Object& object, const Member& last, std::uint32_t bytes);

    const device_program::kernels* all_;
    std::vector<std::uint64_t> parameters_;  // 64-bit, for their alignment
};
extern template class loaded_kernel<double>;
extern template class loaded_kernel<float>;

template <class R>
using device_engine = cuda::study_engine<loaded_kernel<R>>;

/// Makes engines for a program on a GPU.
template <class R>
using engine_source =
    std::function<std::unique_ptr<cuda::engine_for<shaped_arguments<R>>>(const cuda::engine_options& how)>;
template <class R>
engine_source<R> engines_of(device_program& program) {
    return [&program](const cuda::engine_options& how) {
        return std::make_unique<device_engine<R>>(how, loaded_kernel<R>(program.on(how.device)));
    };
}
/// How they are to run a call.
inline cuda::engine_options engine_options_for(device_program& program, int device, const options& o) {
    return {device, o.block_size, program.on(device).facts.shared_placement, o.schedule};
}

}  // namespace myriad::python
