// SPDX-License-Identifier: MIT
// The kernels of one model, method and real type that nvcc compiled into the program, as launches see them.
#pragma once

#include <algorithm>
#include <cstddef>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/cost_order.cuh"
#include "myriad/cuda/cost_order_kernels.cuh"
#include "myriad/cuda/generate_kernel.cuh"
#include "myriad/cuda/kernel.cuh"
#include "myriad/cuda/launch.cuh"
#include "myriad/cuda/study_kernels.cuh"
#include "myriad/cuda/study_work.cuh"

namespace myriad::cuda {

template <class Model, class Method, class R>
class compiled_kernel {
    using place = shared_placement;
    static constexpr bool in_constant_bank = is_compiled(place::constant_bank, shared_parameter_bytes<Model, R>);

public:
    using arguments = kernel_arguments<Model, R>;
    using real = R;

    static constexpr kernel_traits traits() {
        return {n_shared<Model>, n_shared_integer<Model>, shared_parameter_bytes<Model, R>, max_block_size<Model>(),
                costs_differ<Model, Method>};
    }
    static const void* function(place where) {
        if constexpr (in_constant_bank) {
            return address<place::constant_bank>();
        } else {
            return where == place::shared_memory ? address<place::shared_memory>() : address<place::cache>();
        }
    }
    static cost_kernels sort() {
        return {reinterpret_cast<const void*>(&count_all_costs), reinterpret_cast<const void*>(&sum_costs),
                reinterpret_cast<const void*>(&place_by_cost)};
    }

    static study_kernels study() {
        const void* generate = nullptr;
        if constexpr (generates<Model, R>) generate = reinterpret_cast<const void*>(&generate_instances<Model, R>);
        return {reinterpret_cast<const void*>(&fill_components<>), reinterpret_cast<const void*>(&gather_values<>),
                reinterpret_cast<const void*>(&reduce_values<>), generate};
    }

    /// Stores the shared parameters for launches from the constant bank; `shared` is on the host.
    void set_shared(const shared_parameters<R>& shared) {
        if constexpr (in_constant_bank) {
            std::copy_n(shared.real, n_shared<Model>, all_.shared);
            std::copy_n(shared.integer, n_shared_integer<Model>, all_.shared_integer);
        }
    }
    /// Launches the kernel of that place on device pointers.
    void launch(place where, const arguments& ensemble, unsigned long long* queue, const launch_shape& how) {
        all_.ensemble = ensemble;
        all_.queue = queue;
        all_.stop = how.stop;
        void* arguments[] = {&all_};
        // Not <<<>>>, which returns the status of the thread's last failure, whatever its cause.
        check(cudaLaunchKernel(function(where), dim3(how.blocks), dim3(how.threads), arguments, how.shared_bytes,
                               how.stream),
              "the launch of the integration kernel");
    }

private:
    template <place p>
    static const void* address() {
        return reinterpret_cast<const void*>(&integrate_ensemble<Model, Method, R, p>);
    }

    // the same for shared memory and the cache
    launch_arguments<Model, R, in_constant_bank ? place::constant_bank : place::cache> all_{};
};

}  // namespace myriad::cuda
