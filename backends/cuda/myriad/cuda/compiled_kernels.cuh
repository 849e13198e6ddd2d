// SPDX-License-Identifier: MIT
// The kernels of one model, method and real type that nvcc compiled into the program, as launches see them.
#pragma once

#include "myriad/cuda/cost_order_kernels.cuh"
#include "myriad/cuda/generate_kernel.cuh"
#include "myriad/cuda/kernel.cuh"
#include "myriad/cuda/launch.cuh"
#include "myriad/cuda/study_kernels.cuh"

namespace myriad::cuda {

template <class Model, class Method, class R>
model_kernels compiled_kernels() {
    using place = shared_placement;
    constexpr auto here = [](auto* kernel) { return reinterpret_cast<const void*>(kernel); };
    constexpr kernel_traits traits = traits_of<Model, Method, R>;
    model_kernels all{traits, nullptr, nullptr, {}, {}};
    if constexpr (is_compiled(place::constant_bank, traits.shared_bytes)) {
        all.integrate = here(&integrate_ensemble<Model, Method, R, place::constant_bank>);
    } else {
        all.integrate = here(&integrate_ensemble<Model, Method, R, place::cache>);
        all.integrate_staged = here(&integrate_ensemble<Model, Method, R, place::shared_memory>);
    }
    all.sort = {here(&count_all_costs), here(&sum_costs), here(&place_by_cost)};
    all.study = [here]() -> study_kernels {
        const void* generate = nullptr;
        if constexpr (generates<Model, R>) generate = here(&generate_instances<Model, R>);
        return {here(&fill_components<>), here(&gather_values<>), here(&reduce_values<>), generate};
    };
    return all;
}

}  // namespace myriad::cuda
