// SPDX-License-Identifier: MIT
// The CUDA backend as a model's source file sees it: the definitions of MYRIAD_INSTANTIATE when nvcc compiles that
// file.
#pragma once

#include <memory>

#include "myriad/cuda/cost_order_kernels.cuh"
#include "myriad/cuda/devices.cuh"
#include "myriad/cuda/generate_kernel.cuh"
#include "myriad/cuda/kernel.cuh"
#include "myriad/cuda/launch.cuh"
#include "myriad/cuda/study_engine.cuh"
#include "myriad/cuda/study_kernels.cuh"
#include "myriad/host/backend/backend.hpp"

namespace myriad::cuda {

/// The kernels that nvcc compiled into the program, as launches see them.
template <class Model, class Method, class R>
model_kernels compiled_kernels() {
    using place = shared_placement;
    constexpr auto here = [](auto* kernel) { return reinterpret_cast<const void*>(kernel); };
    using part = model_of_thread<Model, Method, R>;
    constexpr kernel_traits traits = traits_of<part, Method, R>;
    model_kernels all{traits, nullptr, nullptr, {}, {}};
    if constexpr (is_compiled(place::constant_bank, traits.shared_bytes)) {
        all.integrate = here(&integrate_ensemble<part, Method, R, place::constant_bank>);
    } else {
        all.integrate = here(&integrate_ensemble<part, Method, R, place::cache>);
        all.integrate_staged = here(&integrate_ensemble<part, Method, R, place::shared_memory>);
    }
    all.sort = {here(&count_all_costs), here(&sum_costs), here(&place_by_cost)};
    all.study = [here]() -> study_kernels {
        const void* generate = nullptr;
        if constexpr (generates<Model, R>) generate = here(&generate_instances<Model, R>);
        return {here(&fill_components<>), here(&gather_values<>), here(&reduce_values<>), generate};
    };
    return all;
}

template <class Model, class Method, class R, class Counts>
std::unique_ptr<engine<R>> make_engine(const engine_options& options) {
    require_device(options);
    return std::make_unique<study_engine<R>>(options, compiled_kernels<Model, Method, R>());
}

}  // namespace myriad::cuda

/// Compiles the kernels of one model, method and real type.
#define MYRIAD_BACKEND_INSTANTIATE(Model, Method, R)                                                         \
    template <>                                                                                              \
    void myriad::detail::instantiated_in_one_file_alone<myriad::cuda::engine_options, Model, Method, R>() {} \
    template std::unique_ptr<myriad::cuda::engine<R>> myriad::cuda::make_engine<Model, Method, R>(           \
        const myriad::cuda::engine_options&);
