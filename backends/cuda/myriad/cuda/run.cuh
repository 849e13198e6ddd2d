// SPDX-License-Identifier: MIT
// The CUDA backend as a model's source file sees it: the definitions of MYRIAD_INSTANTIATE when nvcc compiles that
// file.
#pragma once

#include <memory>

#include "myriad/cuda/compiled_kernels.cuh"
#include "myriad/cuda/devices.cuh"
#include "myriad/cuda/study_engine.cuh"
#include "myriad/host/backend/backend.hpp"

namespace myriad::cuda {

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
