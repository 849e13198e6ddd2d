// SPDX-License-Identifier: MIT
// MYRIAD_INSTANTIATE_ADJOINT, for the source file of a model: compiles what myriad::adjoint needs beside the kernels.
#pragma once

#include "myriad/instantiate.hpp"
#include "myriad/kernel/adjoint/adjoint_check.hpp"
#if defined(MYRIAD_ADJOINT_HEADER)
#include MYRIAD_ADJOINT_HEADER
#else  // it is the CPU's alone
#define MYRIAD_BACKEND_ADJOINT(Model, Method)
#endif

/// Compiles the adjoint of a model for methods with dense output, for CPUs: `MYRIAD_INSTANTIATE_ADJOINT(network,
/// myriad::dense<myriad::tsitouras_5>)`, beside MYRIAD_INSTANTIATE for the same method. In double precision.
#define MYRIAD_INSTANTIATE_ADJOINT(Model, ...) __VA_OPT__(MYRIAD_EXPAND(MYRIAD_ADJOINT_NEXT(Model, __VA_ARGS__)))
#define MYRIAD_ADJOINT_NEXT(Model, Method, ...)                    \
    static_assert(myriad::detail::check_linkage<Model, Method>()); \
    static_assert(myriad::detail::check_adjoint<Model, Method>()); \
    MYRIAD_BACKEND_ADJOINT(Model, Method)                          \
    __VA_OPT__(MYRIAD_ADJOINT_AGAIN MYRIAD_PARENS(Model, __VA_ARGS__))
#define MYRIAD_ADJOINT_AGAIN() MYRIAD_ADJOINT_NEXT
