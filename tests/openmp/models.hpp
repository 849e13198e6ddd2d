// SPDX-License-Identifier: MIT
// Models for the tests of teams of threads: one with many states, one whose hooks throw, one that divides and takes
// roots.
#pragma once

#include <stdexcept>

#include <myriad/model.hpp>

namespace teams {

/// Forty masses in a ring, each pulled by the next.
struct ring {
    static constexpr int masses = 40;
    enum state { first, n_state = masses };
    enum parameter { rate, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_state> slope;
        for (int i = 0; i < masses; ++i) slope[i] = p[rate] * (y[(i + 1) % masses] - y[i]);
        return slope;
    }
};

/// x' = 1, whose hooks throw where an accessory says.
struct thrower {
    enum state { x, n_state };
    enum integer_accessory { where, n_integer_accessory };
    enum places { nowhere, in_initialise, in_after_step, in_finalise, n_places };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::vec<R, n_state>{R(1)};
    }
    MYRIAD_FUNCTION static void throw_if(bool here) {
        if (here) throw std::domain_error("no such oscillator");
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { throw_if(lane.integer_accessory[where] == in_initialise); }
    MYRIAD_FUNCTION static void after_step(auto& lane) { throw_if(lane.integer_accessory[where] == in_after_step); }
    MYRIAD_FUNCTION static void finalise(auto& lane) { throw_if(lane.integer_accessory[where] == in_finalise); }
};

/// x' = rate / x, so x = sqrt(x0^2 + 2 rate t), and y' = sqrt(x).
struct root {
    enum state { x, y, n_state };
    enum parameter { rate, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {p[rate] / s[x], myriad::sqrt(s[x])};
    }
};

}  // namespace teams
