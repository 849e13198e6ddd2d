// SPDX-License-Identifier: MIT
// A model that integrates nothing: its hook records the values of elementary functions on the device that runs it.
#pragma once

#include <myriad/model.hpp>

namespace function_values {

struct values {
    enum state { unused, n_state };
    enum parameter { x, y, n_parameter };
    enum accessory {
        power,
        inverse,
        inverse_root,
        sine,
        cosine,
        sine_alone,
        cosine_alone,
        sine_pi,
        cosine_pi,
        root,
        smaller,
        larger,
        n_accessory
    };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {R(0) * s[unused]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        const auto angle = lane.parameter[x];
        const auto both = myriad::sincos(angle), both_pi = myriad::sincospi(angle);
        lane.accessory[power] = myriad::powr(angle, lane.parameter[y]);
        lane.accessory[inverse] = myriad::reciprocal(angle);
        lane.accessory[inverse_root] = myriad::rsqrt(angle);
        lane.accessory[sine] = both.sine;
        lane.accessory[cosine] = both.cosine;
        lane.accessory[sine_alone] = myriad::sin(angle);
        lane.accessory[cosine_alone] = myriad::cos(angle);
        lane.accessory[sine_pi] = both_pi.sine;
        lane.accessory[cosine_pi] = both_pi.cosine;
        lane.accessory[root] = myriad::sqrt(angle);
        lane.accessory[smaller] = myriad::min(angle, lane.parameter[y]);
        lane.accessory[larger] = myriad::max(angle, lane.parameter[y]);
    }
};

/// The same of those that GPUs have in two ways in single precision, also of infinities and NaN, which parameters
/// cannot be.
struct elementary {
    enum state { unused, n_state };
    enum parameter { x, y, kind_of_x, kind_of_y, n_parameter };
    static constexpr float infinite = 1, not_a_number = 2;  // kinds of x and y
    enum accessory { exp, exp2, log, log2, log10, sin, cos, tan, tanh, sinh, cosh, expm1, log1p, root, n_of_one };
    enum { pow = n_of_one, quotient, inverse, tenth, angle, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {R(0) * s[unused]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        using R = decltype(+lane.parameter[x]);
        const auto argument = [](R value, R kind) MYRIAD_LAMBDA {
            const R infinity = R(3e38f) * (value * value + R(10));
            return kind == R(infinite)       ? myriad::copysign(infinity, value)
                   : kind == R(not_a_number) ? infinity - infinity
                                             : value;
        };
        const R a = argument(lane.parameter[x], lane.parameter[kind_of_x]);
        const R b = argument(lane.parameter[y], lane.parameter[kind_of_y]);
        lane.accessory[exp] = myriad::exp(a);
        lane.accessory[exp2] = myriad::exp2(a);
        lane.accessory[log] = myriad::log(a);
        lane.accessory[log2] = myriad::log2(a);
        lane.accessory[log10] = myriad::log10(a);
        lane.accessory[sin] = myriad::sin(a);
        lane.accessory[cos] = myriad::cos(a);
        lane.accessory[tan] = myriad::tan(a);
        lane.accessory[tanh] = myriad::tanh(a);
        lane.accessory[sinh] = myriad::sinh(a);
        lane.accessory[cosh] = myriad::cosh(a);
        lane.accessory[expm1] = myriad::expm1(a);
        lane.accessory[log1p] = myriad::log1p(a);
        lane.accessory[root] = myriad::sqrt(a);
        lane.accessory[pow] = myriad::pow(a, b);
        lane.accessory[quotient] = a / b;
        lane.accessory[inverse] = R(1) / a;
        lane.accessory[tenth] = a / R(10);
        lane.accessory[angle] = myriad::atan2(a, b);
    }
};

}  // namespace function_values
