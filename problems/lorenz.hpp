// SPDX-License-Identifier: MIT
// Lorenz' equations with sigma = 10 and beta = 8/3 (J. Atmos. Sci. 20 (1963) 130-141), in three forms that round
// differently.
#pragma once

#include <myriad/model.hpp>

namespace problems {

/// x' = 10 (y - x), y' = rho x - y - x z, z' = x y - 8/3 z, term by term.
struct lorenz {
    enum state { x, y, z, n_state };
    enum parameter { rho, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {R(10) * (s[y] - s[x]), p[rho] * s[x] - s[y] - s[x] * s[z], s[x] * s[y] - R(beta<R>) * s[z]};
    }

protected:
    template <class R>
    static constexpr auto beta = static_cast<myriad::real_of<R>>(8.0 / 3);
};

/// The same with x factored out of two terms: the form with which the validation's records were made.
struct factored_lorenz : lorenz {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {R(10) * (s[y] - s[x]), s[x] * (p[rho] - s[z]) - s[y], s[x] * s[y] - R(beta<R>) * s[z]};
    }
};

/// The same in six floating-point instructions, one of each line's two fused, with another beta on request: for
/// benchmarks.
template <class Constant>
struct lorenz_with : lorenz {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {R(10) * (s[y] - s[x]), myriad::fma(s[x], p[rho] - s[z], -s[y]),
                myriad::fma(s[x], s[y], -(R(Constant::b) * s[z]))};
    }
};
struct eight_thirds {
    static constexpr double b = 8.0 / 3;
};
using fused_lorenz = lorenz_with<eight_thirds>;

}  // namespace problems
