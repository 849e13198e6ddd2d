// SPDX-License-Identifier: MIT
// Programs loaded on GPUs, and the launch parameters of their kernels.
#include "device_library.hpp"

#include <cstring>
#include <utility>

#include "cuda_driver.hpp"
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
    cuda::check(gpu::launch(kernel, {1}, 1, arguments, 0, where.get()), "reading a kernel's facts");
    device_facts facts{};
    MYRIAD_GPU_CALL(gpu::copy(&facts, to, sizeof facts, gpu::direction::to_host, where.get()));
    cuda::check(gpu::synchronise(where.get()), "reading a kernel's facts");
    return facts;
}

/// A program, loaded on the current device.
void* loaded(const std::string& image) {
    void* module = nullptr;
    const gpu::result status = gpu::load_module(&module, image.c_str());
    require(status != gpu::result::unsupported_ptx_version && status != gpu::result::no_code_for_device,
            "the driver, of CUDA ", gpu::driver_version() / 1000, '.', gpu::driver_version() % 1000 / 10,
            ", cannot load what a newer NVRTC compiled", host::cure,
            "update the driver, or install nvidia-cuda-nvrtc of the driver's version");
    cuda::check(status, "loading the model's kernel");
    return module;
}

}  // namespace

gpu_facts facts_of_gpu(int device) {
    cuda::require_device({.device = device});
    std::string why_none;
    const auto all = cuda::list_devices(why_none);
    int shared_bytes = 0;
    MYRIAD_GPU_CALL(gpu::find_attribute(&shared_bytes, gpu::device_attribute::shared_bytes_of_block, device));
    const auto& one = all.at(static_cast<std::size_t>(device));
    return {one.name, one.capability, shared_bytes};
}

void wait_for_gpu(int device) {
    const cuda::current_device here(device);
    MYRIAD_GPU_CALL(gpu::synchronise_device());
}

void copy_on_gpu(int device, std::uintptr_t stream, const std::vector<copy_of_bytes>& all) {
    const cuda::current_device here(device);
    const auto in_stream = reinterpret_cast<gpu::stream_handle>(stream);
    for (const copy_of_bytes& one : all)
        MYRIAD_GPU_CALL(gpu::copy(reinterpret_cast<void*>(one.to), reinterpret_cast<const void*>(one.from), one.bytes,
                                  gpu::direction::on_device, in_stream));
    cuda::check(gpu::synchronise(in_stream), "a copy of results on the GPU");
}

gpu_memory::gpu_memory(int device, std::size_t bytes) : device_(device) {
    cuda::require_device({.device = device});
    const cuda::current_device here(device);
    memory_ = std::make_unique<cuda::device_memory>();
    memory_->reserve(bytes);
}
gpu_memory::~gpu_memory() {
    const cuda::current_device here(device_);
    memory_.reset();
}
void gpu_memory::write(std::size_t to, const void* from, std::size_t bytes) {
    require(to + bytes <= this->bytes(), "a copy ends behind the memory of a GPU");
    const cuda::current_device here(device_);
    MYRIAD_GPU_CALL(gpu::copy(static_cast<std::byte*>(memory_->data()) + to, from, bytes, gpu::direction::to_device,
                              gpu::default_stream));
    cuda::check(gpu::synchronise(gpu::default_stream), "a copy to a GPU");
}
void gpu_memory::read(std::size_t from, void* to, std::size_t bytes) const {
    require(from + bytes <= this->bytes(), "a copy begins behind the memory of a GPU");
    const cuda::current_device here(device_);
    MYRIAD_GPU_CALL(gpu::copy(to, static_cast<const std::byte*>(memory_->data()) + from, bytes, gpu::direction::to_host,
                              gpu::default_stream));
    cuda::check(gpu::synchronise(gpu::default_stream), "a copy from a GPU");
}

gpu_kernel::gpu_kernel(const std::string& image, const std::string& name, int device) : device_(device) {
    cuda::require_device({.device = device});
    const cuda::current_device here(device);
    cuda::check(gpu::find_kernel(&kernel_, loaded(image), name.c_str()), "finding a kernel");
    gpu::kernel_attributes attributes{};
    MYRIAD_GPU_CALL(gpu::find_attributes(&attributes, kernel_));
    block_size_ = attributes.most_threads;
}
void gpu_kernel::run(const std::string& argument, std::int64_t size) const {
    const cuda::current_device here(device_);
    std::vector<std::uint64_t> aligned((argument.size() + 7) / 8);
    std::memcpy(aligned.data(), argument.data(), argument.size());
    void* arguments[] = {aligned.data()};
    const auto blocks = static_cast<unsigned>((size + block_size_ - 1) / block_size_);
    cuda::check(gpu::launch(kernel_, {blocks}, static_cast<unsigned>(block_size_), arguments, 0, gpu::default_stream),
                "a launch");
    cuda::check(gpu::synchronise(gpu::default_stream), "a kernel");
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

/// Those that `load_study_kernels` has loaded, with a model's own.
cuda::study_kernels study_kernels_on(int device, const void* generate) {
    const std::lock_guard lock(of_studies().mutex);
    cuda::study_kernels found = of_studies().loaded.at(device);
    found.generate_instances = generate;
    return found;
}

}  // namespace

const device_program::kernels& device_program::on(int device) {
    cuda::require_device({.device = device});
    const std::lock_guard lock(mutex_);
    const auto known = loaded_.find(device);
    if (known != loaded_.end()) return known->second;
    const cuda::current_device here(device);
    void* const module = loaded(image_);
    kernels found;
    const auto find = [module](const void*& kernel, const char* name) {
        cuda::check(gpu::find_kernel(&kernel, module, name), name);
    };
    const void* tell_facts = nullptr;
    find(tell_facts, "myriad_tell_facts");
    found.facts = told_by(tell_facts);
    require(found.facts.facts.interface_version == interface_version,
            "the model's kernel was compiled for another version of Myriad");
    cuda::model_kernels& launched = found.launched;
    launched.traits = found.facts.traits;
    find(launched.integrate, "myriad_integrate");
    launched.integrate_staged = launched.integrate;  // compiled for one place of the shared parameters
    find(found.sum, "myriad_sum");
    find(found.find_not_finite, "myriad_find_not_finite");
    find(launched.sort.count_all_costs, "count_all_costs");
    find(launched.sort.sum_costs, "sum_costs");
    find(launched.sort.place_by_cost, "place_by_cost");
    const void* generate = nullptr;
    if (gpu::find_kernel(&generate, module, "myriad_generate") != gpu::result::success) generate = nullptr;
    launched.study = [device, generate] { return study_kernels_on(device, generate); };
    return loaded_.emplace(device, found).first->second;
}

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
        cuda::check(gpu::find_kernel(kernel, module, name), name);
    of_studies().loaded.emplace(device, found);
}

}  // namespace myriad::python
