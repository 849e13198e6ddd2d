// SPDX-License-Identifier: MIT
// The standard library's functions called with packs or dual numbers: what the compiler says then. Overloads in
// namespace std alone can say it, as a call of `std::sin` looks nowhere else. They are worse than every other
// candidate, so that what compiles without them means the same. Not for nvcc: the host's compiler sees every model too.
#pragma once

#include <cmath>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/select.hpp"

#define MYRIAD_REFUSED(name, remedy)                                                                            \
    namespace myriad::detail::inline MYRIAD_TARGET {                                                            \
    struct argument_of_std_##name {                                                                             \
        template <class S>                                                                                      \
        requires(kind_rank<S> > 0 || std::is_arithmetic_v<S>) argument_of_std_##name(const S&) {                \
            static_assert(sizeof(S) == 0, "this model calls std::" #name                                        \
                                          ", which knows neither packs of instances nor derivatives: " remedy); \
        }                                                                                                       \
    };                                                                                                          \
    }
#define MYRIAD_REFUSED_OF_ONE(name, remedy)                \
    MYRIAD_REFUSED(name, remedy)                           \
    namespace std {                                        \
    double name(::myriad::detail::argument_of_std_##name); \
    }
#define MYRIAD_REFUSED_OF_TWO(name, remedy)                                                          \
    MYRIAD_REFUSED(name, remedy)                                                                     \
    namespace std {                                                                                  \
    double name(::myriad::detail::argument_of_std_##name, ::myriad::detail::argument_of_std_##name); \
    }
MYRIAD_REFUSED_OF_ONE(sqrt, "call myriad::sqrt")
MYRIAD_REFUSED_OF_ONE(cbrt, "call myriad::cbrt")
MYRIAD_REFUSED_OF_ONE(abs, "call myriad::abs")
MYRIAD_REFUSED_OF_ONE(sin, "call myriad::sin")
MYRIAD_REFUSED_OF_ONE(cos, "call myriad::cos")
MYRIAD_REFUSED_OF_ONE(tan, "call myriad::tan")
MYRIAD_REFUSED_OF_ONE(asin, "call myriad::asin")
MYRIAD_REFUSED_OF_ONE(acos, "call myriad::acos")
MYRIAD_REFUSED_OF_ONE(atan, "call myriad::atan")
MYRIAD_REFUSED_OF_ONE(sinh, "call myriad::sinh")
MYRIAD_REFUSED_OF_ONE(cosh, "call myriad::cosh")
MYRIAD_REFUSED_OF_ONE(tanh, "call myriad::tanh")
MYRIAD_REFUSED_OF_ONE(exp, "call myriad::exp")
MYRIAD_REFUSED_OF_ONE(exp2, "call myriad::exp2")
MYRIAD_REFUSED_OF_ONE(log, "call myriad::log")
MYRIAD_REFUSED_OF_ONE(log2, "call myriad::log2")
MYRIAD_REFUSED_OF_ONE(log10, "call myriad::log10")
MYRIAD_REFUSED_OF_ONE(expm1, "call myriad::expm1")
MYRIAD_REFUSED_OF_ONE(log1p, "call myriad::log1p")
MYRIAD_REFUSED_OF_ONE(floor, "call myriad::floor")
MYRIAD_REFUSED_OF_ONE(round, "call myriad::round")
MYRIAD_REFUSED_OF_ONE(rint, "call myriad::rint")
MYRIAD_REFUSED_OF_ONE(fabs, "call myriad::abs")
MYRIAD_REFUSED_OF_ONE(ceil, "call -myriad::floor(-x)")
MYRIAD_REFUSED_OF_ONE(isfinite, "call myriad::is_finite")
MYRIAD_REFUSED_OF_ONE(isnan, "write x != x")
MYRIAD_REFUSED_OF_TWO(pow, "call myriad::pow")
MYRIAD_REFUSED_OF_TWO(atan2, "call myriad::atan2")
MYRIAD_REFUSED_OF_TWO(hypot, "call myriad::hypot")
MYRIAD_REFUSED_OF_TWO(fmod, "call myriad::fmod")
MYRIAD_REFUSED_OF_TWO(copysign, "call myriad::copysign")
MYRIAD_REFUSED_OF_TWO(fmin, "call myriad::min")
MYRIAD_REFUSED_OF_TWO(fmax, "call myriad::max")
#undef MYRIAD_REFUSED_OF_TWO
#undef MYRIAD_REFUSED_OF_ONE
#undef MYRIAD_REFUSED
