// SPDX-License-Identifier: MIT
// Programs loaded on GPUs, and the launch parameters of their kernels.
#include "device_library.hpp"

#include <cstring>

#include "myriad/cuda/devices.cuh"
#include "myriad/host/core/error.hpp"

namespace myriad::python {

gpu_facts facts_of_gpu(int device) {
    cuda::require_device({.device = device});
    std::string why_none;
    const auto all = cuda::list_devices(why_none);
    int shared_bytes = 0;
    MYRIAD_CUDA(cudaDeviceGetAttribute(&shared_bytes, cudaDevAttrMaxSharedMemoryPerBlockOptin, device));
    const auto& one = all.at(static_cast<std::size_t>(device));
    return {one.name, one.capability, shared_bytes};
}

void wait_for_gpu(int device) {
    const cuda::current_device here(device);
    MYRIAD_CUDA(cudaDeviceSynchronize());
}

const device_program::kernels& device_program::on(int device) {
    cuda::require_device({.device = device});
    const std::lock_guard lock(mutex_);
    const auto known = loaded_.find(device);
    if (known != loaded_.end()) return known->second;
    const cuda::current_device here(device);
    void* module = nullptr;
    const cudaError_t status = load_module(&module, image_.c_str());
    require(status != cudaErrorUnsupportedPtxVersion && status != cudaErrorNoKernelImageForDevice,
            "the driver, of CUDA ", driver_version() / 1000, '.', driver_version() % 1000 / 10,
            ", cannot load what a newer NVRTC compiled: update the driver, or install nvidia-cuda-nvrtc of the "
            "driver's version");
    cuda::check(status, "loading the model's kernel");
    kernels found;
    cuda::check(read_variable(&found.facts, sizeof found.facts, module, "myriad_device_facts"), "reading its facts");
    require(found.facts.model.interface_version == interface_version,
            "the model's kernel was compiled for another version of Myriad");
    const auto find = [module](const void*& kernel, const char* name) {
        cuda::check(find_kernel(&kernel, module, name), name);
    };
    find(found.integrate, "myriad_integrate");
    find(found.sum, "myriad_sum");
    find(found.find_not_finite, "myriad_find_not_finite");
    find(found.sort.count_all_costs, "count_all_costs");
    find(found.sort.sum_costs, "sum_costs");
    find(found.sort.place_by_cost, "place_by_cost");
    return loaded_.emplace(device, found).first->second;
}

template <class R>
loaded_kernel<R>::loaded_kernel(const device_program::kernels& all)
    : all_(&all), parameters_((all.facts.layout.size + 7) / 8) {}

template <class R>
cuda::kernel_traits loaded_kernel<R>::traits() const {
    const device_facts& f = all_->facts;
    return {f.model.n_shared, f.model.n_shared_integer, f.shared_bytes, f.max_block_size, f.costs_differ};
}

template <class R>
template <class T>
void loaded_kernel<R>::put(std::uint32_t offset, const T* values, int count) {
    auto* const bytes = reinterpret_cast<std::byte*>(parameters_.data());
    if (count > 0) std::memcpy(bytes + offset, values, static_cast<std::size_t>(count) * sizeof(T));
}

template <class R>
void loaded_kernel<R>::set_shared(const detail::shared_parameters<R>& shared) {
    const device_facts& f = all_->facts;
    if (f.shared_placement != shared_placement::constant_bank) return;
    put(f.layout.shared, shared.real, f.model.n_shared);
    put(f.layout.shared_integer, shared.integer, f.model.n_shared_integer);
}

namespace {

/// Bytes from the beginning of an object to the end of one of its members.
template <class Object, class Member>
int bytes_until(const Object& object, const Member& last) {
    return static_cast<int>(reinterpret_cast<const std::byte*>(&last + 1) -
                            reinterpret_cast<const std::byte*>(&object));
}

}  // namespace

template <class R>
void loaded_kernel<R>::launch(shared_placement, const arguments& a, unsigned long long* queue,
                              const cuda::launch_shape& how) {
    const model_facts& m = all_->facts.model;
    const argument_layout& at = all_->facts.layout;
    const any_arguments<R>& head = a;
    put(0, reinterpret_cast<const std::byte*>(&head), bytes_until(head, a.shrink_limit));
    put(at.relative_tolerance, a.relative_tolerance, m.n_state);
    put(at.absolute_tolerance, a.absolute_tolerance, m.n_state);
    put(at.event, a.event, m.n_event);
    put(at.rising, a.rising, m.n_event / 32 + 1);
    put(at.falling, a.falling, m.n_event / 32 + 1);
    put(at.sub_samples, &a.sub_samples, 1);
    put(at.accumulation_limit, &a.accumulation_limit, 1);
    put(at.record, reinterpret_cast<const std::byte*>(&a.record), bytes_until(a.record, a.record.time_column));
    put(at.record_columns[0], a.record.state_column, m.n_state);
    put(at.record_columns[1], a.record.accessory_column, m.n_accessory);
    put(at.record_columns[2], a.record.integer_accessory_column, m.n_integer_accessory);
    put(at.sample, reinterpret_cast<const std::byte*>(&a.sample), bytes_until(a.sample, a.sample.minimum_spacing));
    put(at.sample_columns, a.sample.column, m.n_state);
    put(at.queue, &queue, 1);
    void* all[] = {parameters_.data()};
    cuda::check(
        cudaLaunchKernel(all_->integrate, dim3(how.blocks), dim3(how.threads), all, how.shared_bytes, how.stream),
        "the launch of the integration kernel");
}

template class loaded_kernel<double>;
template class loaded_kernel<float>;

}  // namespace myriad::python
