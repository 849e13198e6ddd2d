// SPDX-License-Identifier: MIT
// MYRIAD_INSTANTIATE, for the source file of a model: compiles its kernels for the current backend. Include it in that
// file only, which is compiled with the instruction-set flags and includes no Eigen.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/core/macros.hpp"
#include MYRIAD_BACKEND_HEADER
#include "myriad/kernel/stepper/method_check.hpp"
#include "myriad/methods.hpp"
#include "myriad/version.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// An undefined macro expands to its own name.
constexpr bool is_number(const char* text) { return *text >= '0' && *text <= '9'; }

}  // namespace myriad::host::inline MYRIAD_ABI
#define MYRIAD_TEXT_OF(macro) MYRIAD_TEXT(macro)
#define MYRIAD_TEXT(text) #text
#define MYRIAD_REFUSE_EIGEN                                                                                          \
    static_assert(                                                                                                   \
        !myriad::host::is_number(MYRIAD_TEXT_OF(EIGEN_WORLD_VERSION)),                                               \
        "this model file includes Eigen, perhaps through <myriad/myriad.hpp>. The memory layout of Eigen's objects " \
        "depends on the flags of model files, so that the program would end in a double free: keep what needs "      \
        "Eigen in other files");

/// Compiles the kernels of a model for the given methods in double precision: `MYRIAD_INSTANTIATE(duffing,
/// myriad::cash_karp, myriad::tsitouras_5)`. It stands at namespace scope, in one source file of the program.
#define MYRIAD_INSTANTIATE(Model, ...) MYRIAD_INSTANTIATE_EACH(Model, double, __VA_ARGS__)
/// The same in single precision, for `ensemble<model, float>`.
#define MYRIAD_INSTANTIATE_FLOAT(Model, ...) MYRIAD_INSTANTIATE_EACH(Model, float, __VA_ARGS__)

#define MYRIAD_INSTANTIATE_EACH(Model, R, ...) \
    MYRIAD_REFUSE_EIGEN                        \
    __VA_OPT__(MYRIAD_EXPAND(MYRIAD_INSTANTIATE_NEXT(Model, R, __VA_ARGS__)))
#define MYRIAD_INSTANTIATE_NEXT(Model, R, Method, ...)             \
    static_assert(myriad::detail::check_linkage<Model, Method>()); \
    static_assert(myriad::detail::check_method<Method>());         \
    MYRIAD_BACKEND_INSTANTIATE(Model, Method, R)                   \
    __VA_OPT__(MYRIAD_INSTANTIATE_AGAIN MYRIAD_PARENS(Model, R, __VA_ARGS__))
#define MYRIAD_INSTANTIATE_AGAIN() MYRIAD_INSTANTIATE_NEXT
#define MYRIAD_PARENS ()
// Every expansion handles one more method: 365 in all, after which an error would name MYRIAD_INSTANTIATE_AGAIN.
#define MYRIAD_EXPAND(...) MYRIAD_EXPAND_1(MYRIAD_EXPAND_1(MYRIAD_EXPAND_1(__VA_ARGS__)))
#define MYRIAD_EXPAND_1(...) MYRIAD_EXPAND_2(MYRIAD_EXPAND_2(MYRIAD_EXPAND_2(__VA_ARGS__)))
#define MYRIAD_EXPAND_2(...) MYRIAD_EXPAND_3(MYRIAD_EXPAND_3(MYRIAD_EXPAND_3(__VA_ARGS__)))
#define MYRIAD_EXPAND_3(...) MYRIAD_EXPAND_4(MYRIAD_EXPAND_4(MYRIAD_EXPAND_4(__VA_ARGS__)))
#define MYRIAD_EXPAND_4(...) MYRIAD_EXPAND_5(MYRIAD_EXPAND_5(MYRIAD_EXPAND_5(__VA_ARGS__)))
#define MYRIAD_EXPAND_5(...) __VA_ARGS__
