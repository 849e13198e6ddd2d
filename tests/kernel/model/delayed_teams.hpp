// SPDX-License-Identifier: MIT
// Coupled units with delays twice: integrated by one thread, and by a team of so many.
#pragma once

#include <myriad/methods.hpp>

#include "tests/kernel/model/delayed_units.hpp"
#include "tests/kernel/model/order_of_threads.hpp"

namespace delayed_teams {

/// Springs that feel where the next one was, by a lag of their own, and how fast they were themselves. They read what
/// others have looked up too, in functions and hooks, and are kicked at stop times.
struct echo {
    enum unit_state { x, v, n_unit_state };
    enum parameter { strength, n_parameter };
    enum unit_parameter { tau, n_unit_parameter };
    enum unit_delayed { next_before, slope_before, n_unit_delayed };
    enum unit_event { crossing, n_unit_event };
    enum unit_accessory { seen, n_unit_accessory };
    enum stop { kick, n_stop };
    static constexpr bool accessories_are_outputs = true, writes_parameters = true;
    static constexpr int units = 7;

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    MYRIAD_FUNCTION static int delayed_unit(int unit, int delayed) {
        return delayed == next_before ? (unit + 1) % units : unit;
    }
    MYRIAD_FUNCTION static bool is_delayed_slope(int delayed) { return delayed == slope_before; }
    MYRIAD_FUNCTION static bool has_history(int delayed) { return delayed == next_before; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int unit, int delayed, const auto& p) {
        return delayed == next_before ? p.unit_parameter[tau]
                                      : R(1) + R(0.1) * p.of((unit + 1) % units).unit_parameter[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int unit, int, const R& t, const auto& p) {
        return myriad::cos(t * p.unit_parameter[tau]) + R(0.1 * unit);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& y, const auto& p) {
        return {y[v] - R(0.3) * p.unit_delayed[next_before],
                R(0.2) * p.unit_delayed[slope_before] - y[x] +
                    R(0.1) * p[strength] * p.of((unit + 3) % units).unit_delayed[next_before]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_event> events(int unit, auto, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_event>{y[x] + R(0.1) * p.of((unit + 2) % units).unit_delayed[next_before]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return R(0.3) * p[strength] * R(number + 1);
    }
    MYRIAD_FUNCTION static void initialise(int, auto& lane) {
        lane.unit_accessory[seen] = lane.unit_delayed[next_before];
    }
    MYRIAD_FUNCTION static void after_step(int unit, auto& lane) {
        if (unit == 3) lane.y[v] *= 0.999;  // so that the slope of its past has a kink there, which one thread sees
    }
    MYRIAD_FUNCTION static void after_event(int unit, int, auto& lane) {
        lane.y[v] += 0.1 * lane.of((unit + 1) % units).unit_delayed[next_before];
        lane.unit_accessory[seen] += lane.unit_delayed[slope_before];
    }
    MYRIAD_FUNCTION static void after_stop(int unit, int, int number, auto& lane) {
        lane.y[x] += 0.05 * number;
        lane.unit_accessory[seen] += lane.unit_delayed[next_before];
        if (unit == units - 1) lane.parameter[strength] *= 1.01;
    }
};

/// Kuramoto's oscillators, each of which sees each of the others after a time of its own: so many delayed values that
/// loops over them are not written out.
template <int n>
struct distant {
    enum unit_state { theta, n_unit_state };
    enum parameter { K, speed, n_parameter };
    enum unit_shared { n_unit_shared = n };  // how far the others are
    enum unit_delayed { n_unit_delayed = n };

    MYRIAD_FUNCTION static int delayed_state(int) { return theta; }
    MYRIAD_FUNCTION static int delayed_unit(int, int delayed) { return delayed; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, int delayed, const auto& p) {
        return R(p.unit_shared[delayed]) / p[speed];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& y, const auto& p) {
        R sum = R(1) + R(0.1) * R(unit);
        for (int j = 0; j < n; ++j) sum += p[K] * myriad::sin(p.unit_delayed[j] - y[theta]);
        return myriad::vec<R, n_unit_state>{sum};
    }
};

template <int n>
using pairs_of = myriad::coupled_units<distant<n>, n>;

template <class Unit, int threads>
struct of_team : Unit {
    static constexpr bool scalar_only = true;
    static constexpr int threads_per_instance = threads;
};
template <int threads>
using phases = myriad::coupled_units<of_team<delayed_units::phase, threads>, 19>;
template <int threads>
using cells = myriad::coupled_units<of_team<delayed_units::cell, threads>, delayed_units::cell::units>;
template <int threads>
using pairs = myriad::coupled_units<of_team<distant<9>, threads>, 9>;
template <int threads>
using echoes = myriad::coupled_units<of_team<echo, threads>, echo::units>;

}  // namespace delayed_teams
