// SPDX-License-Identifier: MIT
// Models for the tests of solvers and backends: one with every kind of data that a kernel copies in and out, one whose
// shared parameters are a matrix, one with many states, one that costs next to nothing.
#pragma once

#include <myriad/model.hpp>

namespace solving {

/// A driven, damped swing with a wall: events with an impact, accessories, a parameter that a hook writes.
struct swing {
    enum state { x, v, n_state };
    enum parameter { damping, drive, n_parameter };
    enum shared { stiffness, bounce, n_shared };
    enum shared_integer { weight, n_shared_integer };
    enum accessory { highest, my_number, n_accessory };
    enum integer_accessory { impacts, my_phase, n_integer_accessory };
    enum event { wall, n_event };
    static constexpr bool writes_parameters = true;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::cos;
        const auto factor = static_cast<myriad::real_of<R>>(p.shared_integer[weight]);
        return {y[v], factor * p[drive] * cos(t) - p.shared[stiffness] * y[x] - p[damping] * y[v]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[x] + R(1)};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[highest] = lane.y[x];
        lane.integer_accessory[my_phase] = static_cast<int>(lane.phase);
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[highest] = myriad::max(lane.accessory[highest], lane.y[x]);
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.y[v] = -lane.shared[bounce] * lane.y[v];
        ++lane.integer_accessory[impacts];
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        using real = std::remove_cvref_t<decltype(lane.accessory[my_number])>;
        lane.accessory[my_number] = static_cast<real>(lane.index);
        lane.parameter[damping] *= real(1.0625);
    }
};

/// dT/dt = rate * D T with one matrix D for all: 77 x 77 doubles, too many for a GPU's constant bank.
struct heat {
    static constexpr int points = 77;
    enum state { first, n_state = points };
    enum parameter { rate, n_parameter };
    enum shared { matrix, n_shared = points * points };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& temperature,
                                                       const auto& p) {
        myriad::vec<R, n_state> slope;
#pragma GCC unroll 1
        for (int i = 0; i < points; ++i) {
            R sum = R(0);
#pragma GCC unroll 1
            for (int j = 0; j < points; ++j) sum += p.shared[i * points + j] * temperature[j];
            slope[i] = p[rate] * sum;
        }
        return slope;
    }
};

/// A chain of populations, each of which becomes the next one: its trial steps are too large for a GPU's registers.
struct long_chain {
    enum state { first, last = 29, n_state };
    enum parameter { rate, n_parameter };
    enum integer_accessory { crossings, n_integer_accessory };
    enum event { half_gone, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_state> slope;
        slope[first] = p[rate] * (y[last] - y[first]);
        MYRIAD_UNROLL
        for (int i = 1; i < n_state; ++i) slope[i] = p[rate] * (y[i - 1] - y[i]);
        return slope;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[first] - R(0.5)};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        ++lane.integer_accessory[crossings];
        lane.y[last] *= myriad::real_of<std::remove_cvref_t<decltype(lane.y[last])>>(0.75);
    }
};

/// x' = speed, for ensembles so large that several chunks pay off. Counts the phases in which x exceeded a limit, and
/// then ends the instance.
struct drift {
    enum state { x, n_state };
    enum parameter { speed, n_parameter };
    enum accessory { limit, n_accessory };
    enum integer_accessory { phases, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{R(p[speed])};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { ++lane.integer_accessory[phases]; }
    MYRIAD_FUNCTION static myriad::action after_step(auto& lane) {
        return lane.y[x] > lane.accessory[limit] ? myriad::action::end_instance : myriad::action::proceed;
    }
};

}  // namespace solving
