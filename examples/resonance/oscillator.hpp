// SPDX-License-Identifier: MIT
// A forced oscillator with a hardening spring, and its response per phase in accessories.
#pragma once

#include <myriad/model.hpp>

/// x'' + 2 zeta x' + x + beta x^3 = cos(omega t): Duffing's equation, see Nayfeh and Mook, Nonlinear Oscillations
/// (1979), 4.1. Time is in units of 1/omega_0, x in units of the static deflection of the linear spring, so that x is
/// the amplification.
struct oscillator {
    enum state { x, v, n_state };
    enum parameter { omega, beta, n_parameter };
    enum shared { zeta, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], myriad::cos(p[omega] * t) - R(2) * p.shared[zeta] * y[v] - y[x] - p[beta] * y[x] * y[x] * y[x]};
    }
};

// snippet: response
/// The same with the largest and smallest x and the integral of x^2 over all steps since the host last reset them. The
/// event, v = 0, needs no action: it ends a step at every extremum, so that the maximum is as accurate as the steps.
struct response : oscillator {
    static constexpr bool accessories_are_outputs = true;
    enum accessory { maximum, minimum, integral, x_before, v_before, n_accessory };
    enum event { extremum, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[v]};
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        const R x0 = lane.accessory[x_before], v0 = lane.accessory[v_before], x1 = lane.y[x], v1 = lane.y[v],
                h = lane.h;
        lane.accessory[maximum] = myriad::max(R(lane.accessory[maximum]), x1);
        lane.accessory[minimum] = myriad::min(R(lane.accessory[minimum]), x1);
        // The trapezoidal rule with the slopes of x^2 at both ends: the integral of its Hermite polynomial, of order
        // four.
        lane.accessory[integral] += R(0.5) * h * (x0 * x0 + x1 * x1) + h * h / R(6) * (x0 * v0 - x1 * v1);
        lane.accessory[x_before] = x1;
        lane.accessory[v_before] = v1;
    }
};
// end of snippet
