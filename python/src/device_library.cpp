// SPDX-License-Identifier: MIT
// Programs loaded on GPUs, and the launch parameters of their kernels.
#include "device_library.hpp"

#include <cstring>

#include "myriad/cuda/devices.cuh"
#include "myriad/host/core/error.hpp"

namespace myriad::python {

namespace {

device_facts told_by(const void* kernel) {
    cuda::device_memory memory;
    memory.reserve(sizeof(device_facts));
    const cuda::stream where;
    void* to = memory.data();
    void* arguments[] = {&to};
    cuda::check(cudaLaunchKernel(kernel, dim3(1), dim3(1), arguments, 0, where.get()), "reading a kernel's facts");
    device_facts facts{};
    MYRIAD_CUDA(cudaMemcpyAsync(&facts, to, sizeof facts, cudaMemcpyDeviceToHost, where.get()));
    cuda::check(cudaStreamSynchronize(where.get()), "reading a kernel's facts");
    return facts;
}

/// A program, loaded on the current device.
void* loaded(const std::string& image) {
    void* module = nullptr;
    const cudaError_t status = load_module(&module, image.c_str());
    require(status != cudaErrorUnsupportedPtxVersion && status != cudaErrorNoKernelImageForDevice,
            "the driver, of CUDA ", driver_version() / 1000, '.', driver_version() % 1000 / 10,
            ", cannot load what a newer NVRTC compiled: update the driver, or install nvidia-cuda-nvrtc of the "
            "driver's version");
    cuda::check(status, "loading the model's kernel");
    return module;
}

}  // namespace

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
    void* const module = loaded(image_);
    kernels found;
    found.device = device;
    const auto find = [module](const void*& kernel, const char* name) {
        cuda::check(find_kernel(&kernel, module, name), name);
    };
    const void* tell_facts = nullptr;
    find(tell_facts, "myriad_tell_facts");
    found.facts = told_by(tell_facts);
    require(found.facts.model.interface_version == interface_version && found.facts.layout.size > 0,
            "the model's kernel was compiled for another version of Myriad");
    find(found.integrate, "myriad_integrate");
    find(found.sum, "myriad_sum");
    find(found.find_not_finite, "myriad_find_not_finite");
    find(found.sort.count_all_costs, "count_all_costs");
    find(found.sort.sum_costs, "sum_costs");
    find(found.sort.place_by_cost, "place_by_cost");
    if (find_kernel(&found.generate, module, "myriad_generate") != cudaSuccess) found.generate = nullptr;
    return loaded_.emplace(device, found).first->second;
}

namespace {

/// The kernels of studies by device.
struct kernels_of_studies {
    std::mutex mutex;
    std::map<int, cuda::study_kernels> loaded;
};
kernels_of_studies& of_studies() {
    static kernels_of_studies* const all = new kernels_of_studies;  // never destroyed, as programs are
    return *all;
}

}  // namespace

void load_study_kernels(const std::string& image, int device) {
    cuda::require_device({.device = device});
    const std::lock_guard lock(of_studies().mutex);
    if (of_studies().loaded.count(device) > 0) return;
    const cuda::current_device here(device);
    void* const module = loaded(image);
    cuda::study_kernels found{};
    for (const auto& [kernel, name] :
         {std::pair{&found.fill_components, "fill_components"}, std::pair{&found.gather_values, "gather_values"},
          std::pair{&found.reduce_values, "reduce_values"}})
        cuda::check(find_kernel(kernel, module, name), name);
    of_studies().loaded.emplace(device, found);
}

template <class R>
cuda::study_kernels loaded_kernel<R>::study() const {
    const std::lock_guard lock(of_studies().mutex);
    cuda::study_kernels found = of_studies().loaded.at(all_->device);
    found.generate_instances = all_->generate;
    return found;
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

template <class R>
template <class Object, class Member>
void loaded_kernel<R>::put_head(std::uint32_t offset, const Object& object, const Member& last, std::uint32_t bytes) {
    const auto* const begin = reinterpret_cast<const std::byte*>(&object);
    require(reinterpret_cast<const std::byte*>(&last + 1) - begin == std::ptrdiff_t{bytes},
            "the model's kernel was compiled for another version of Myriad");
    put(offset, begin, static_cast<int>(bytes));
}

template <class R>
void loaded_kernel<R>::launch(shared_placement, const arguments& a, unsigned long long* queue,
                              const cuda::launch_shape& how) {
    const model_facts& m = all_->facts.model;
    const argument_layout& at = all_->facts.layout;
    put_head(0, static_cast<const any_arguments<R>&>(a), a.shrink_limit, at.head);
    put(at.relative_tolerance, a.relative_tolerance, m.n_state);
    put(at.absolute_tolerance, a.absolute_tolerance, m.n_state);
    put(at.event, a.event, m.n_event);
    put(at.rising, a.rising, m.n_event / 32 + 1);
    put(at.falling, a.falling, m.n_event / 32 + 1);
    put(at.sub_samples, &a.sub_samples, 1);
    put(at.accumulation_limit, &a.accumulation_limit, 1);
    put_head(at.record, a.record, a.record.time_column, at.record_head);
    put(at.record_columns[0], a.record.state_column, m.n_state);
    put(at.record_columns[1], a.record.accessory_column, m.n_accessory);
    put(at.record_columns[2], a.record.integer_accessory_column, m.n_integer_accessory);
    put_head(at.sample, a.sample, a.sample.minimum_spacing, at.sample_head);
    put(at.sample_columns, a.sample.column, m.n_state);
    put(at.queue, &queue, 1);
    put(at.stop, &how.stop, 1);
    void* all[] = {parameters_.data()};
    cuda::check(
        cudaLaunchKernel(all_->integrate, dim3(how.blocks), dim3(how.threads), all, how.shared_bytes, how.stream),
        "the launch of the integration kernel");
}

template class loaded_kernel<double>;
template class loaded_kernel<float>;

}  // namespace myriad::python
