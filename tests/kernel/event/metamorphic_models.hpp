// SPDX-License-Identifier: MIT
// One model for many motions and for many functions of the same sign: what distinguishes them are values of instances
// and shared ones, so that it is compiled once and its packs have different motions beside each other.
#pragma once

#include <myriad/model.hpp>

/// Up to four bodies (or anything else with a position and a speed), x' = v + rate - decay x and v' = weight - spring
/// x; where the mode is not 0, x' = v + other_rate - decay x. Up to four event functions: of level and one of the
/// states or the time, written in the form that a shared integer selects. Each logs its first times and does what its
/// integer says. Shared values are the units of states and time in which all of it is given to the integrator.
struct metamorphic {
    static constexpr int bodies = 4, slots = 4, log_length = 10;
    enum state { n_state = 2 * bodies };  // x, v of each body
    enum parameter {
        rate,
        other_rate = rate + bodies,
        decay = other_rate + bodies,
        weight = decay + bodies,
        spring = weight + bodies,
        level = spring + bodies,
        value = level + slots,  // what actions set, subtract or add
        kept = value + slots,   // part of the speed that is left after a bounce
        factor = kept + slots,
        ramp,  // of time, part of the rate of the first body in mode 0
        n_parameter
    };
    enum shared { per_state_unit, state_unit, per_time_unit, time_unit, n_shared };
    enum shared_integer { form, n_shared_integer };
    enum accessory { at, n_accessory = at + slots * log_length };
    enum integer_accessory {
        mode,
        source,                    // state, or n_state for the time; -1: none
        only_in = source + slots,  // the mode in which the function is not constant; -1: both
        act = only_in + slots,
        count = act + slots,
        n_integer_accessory = count + slots
    };
    enum event { n_event = slots };

    enum forms { plain, scaled, cubed, sinh, exp_minus_1, atan, with_time, square_with_sign, root, jump, n_form };
    enum actions {
        nothing,
        set,           // x to the value
        subtract,      // the value from x
        bounce,        // x to the value, and v turned
        turn,          // v alone turned
        other_mode,    // 1 instead of 0, and 0 instead of 1
        stick,         // x to the value, and the other mode
        set_and_push,  // x to 0, and the value added to x of the next body
        push,          // the value added to x of the next body
    };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        const auto still = p.integer_accessory[mode] == 0;
        const R time = R(t) * p.shared[per_time_unit];
        myriad::vec<R, n_state> f;
        for (int b = 0; b < bodies; ++b) {
            const R x = y[2 * b] * p.shared[per_state_unit], v = y[2 * b + 1] * p.shared[per_state_unit];
            R r = myriad::select(still, p[rate + b], p[other_rate + b]);
            if (b == 0) r += myriad::select(still, p[ramp] * time, R(0));
            f[2 * b] = (v + r - p[decay + b] * x) * (p.shared[state_unit] * p.shared[per_time_unit]);
            f[2 * b + 1] = (p[weight + b] - p[spring + b] * x) * (p.shared[state_unit] * p.shared[per_time_unit]);
        }
        return f;
    }

    /// A function with the sign of g.
    template <class R>
    MYRIAD_FUNCTION static R written(int which, const R& g, const R& k, const R& time) {
        switch (which) {
            case scaled:
                return k * g;
            case cubed:
                return g * g * g;
            case sinh:
                return myriad::sinh(k * g);
            case exp_minus_1:
                return myriad::exp(k * g) - R(1);
            case atan:
                return myriad::atan(k * g);
            case with_time:
                return g * (R(1) + time * time);
            case square_with_sign:
                return g * myriad::abs(g);
            case root:
                return myriad::select(g < R(0), -myriad::sqrt(myriad::abs(g)), myriad::sqrt(myriad::abs(g)));
            case jump:
                return myriad::select(g < R(0), R(-1), myriad::select(g > R(0), R(1), R(0)));
            default:
                return g;
        }
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        const R time = R(t) * p.shared[per_time_unit];
        const auto still = p.integer_accessory[mode] == 0;
        myriad::vec<R, n_event> g;
        for (int j = 0; j < slots; ++j) {
            R of = p[level + j] - R(1);  // constant
            for (int i = 0; i < n_state; ++i)
                of = myriad::select(p.integer_accessory[source + j] == i, y[i] * p.shared[per_state_unit], of);
            of = myriad::select(p.integer_accessory[source + j] == int(n_state), time, of);
            const R idle = p[level + j] - R(1);
            const R in_still = myriad::select(p.integer_accessory[only_in + j] == 1, idle, of);
            const R in_other = myriad::select(p.integer_accessory[only_in + j] == 0, idle, of);
            g[j] = written<R>(p.shared_integer[form], myriad::select(still, in_still, in_other) - p[level + j],
                              R(p[factor]), time);
        }
        return g;
    }

    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        const int n = lane.integer_accessory[count + event];
        if (n < log_length) lane.accessory[at + event * log_length + n] = lane.t;
        lane.integer_accessory[count + event] = n + 1;

        const int of = lane.integer_accessory[source + event], what = lane.integer_accessory[act + event];
        const int x = 2 * (of / 2), v = x + 1, next = (x + 2) % n_state;
        const auto to = lane.parameter[value + event] * lane.shared[state_unit];
        if (what == set || what == bounce || what == stick) lane.y[of] = to;
        if (what == subtract) lane.y[of] -= to;
        if (what == bounce || what == turn) lane.y[v] = -lane.parameter[kept + event] * lane.y[v];
        if (what == other_mode || what == stick) lane.integer_accessory[mode] = 1 - lane.integer_accessory[mode];
        if (what == set_and_push) lane.y[of] = 0;
        if (what == set_and_push || what == push) lane.y[next] += to;
    }
};

/// The same for lanes by themselves.
struct metamorphic_alone : metamorphic {};
