// SPDX-License-Identifier: MIT
// What a file that the Python package compiles for gradients by an adjoint on GPUs includes: MYRIAD_ADJOINT makes the
// program's one kernel, with a thread for each instance.
#pragma once

#include <cstdint>

#include "myriad/kernel/adjoint/adjoint_pack.hpp"
#include "myriad/kernel/stepper/method_check.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"

/// Makes the adjoint of a model and a method the program's. The arguments may not contain commas.
#define MYRIAD_ADJOINT(Adjoint, Method)                                                         \
    extern "C" __global__ void __launch_bounds__(64)                                            \
        myriad_adjoint(const __grid_constant__ myriad::detail::adjoint_call call) {             \
        const auto i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;        \
        if (i >= call.size) return;                                                             \
        if (call.values != nullptr) {                                                           \
            myriad::detail::adjoint_pack<Adjoint, Method, double, true>(call, i, i + 1).run();  \
        } else {                                                                                \
            myriad::detail::adjoint_pack<Adjoint, Method, double, false>(call, i, i + 1).run(); \
        }                                                                                       \
    }
