// SPDX-License-Identifier: MIT
// What a file that the Python package compiles for gradients by an adjoint on CPUs includes: MYRIAD_ADJOINT makes the
// shared object's one exported function.
#pragma once

#include <cstdint>

#include "myriad/kernel/stepper/method_check.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"
#include "myriad/openmp/adjoint_packs.hpp"

/// Makes the adjoint of a model and a method the shared object's. The arguments may not contain commas.
#define MYRIAD_ADJOINT(Adjoint, Method)                                                                             \
    extern "C" __attribute__((visibility("default"))) void myriad_adjoint(const myriad::detail::adjoint_call* call, \
                                                                          std::int64_t first, std::int64_t end) {   \
        myriad::detail::run_adjoint<Adjoint, Method>(*call, first, end);                                            \
    }
