// SPDX-License-Identifier: MIT
// Coupled units twice: integrated by one thread, and by a team of so many.
#pragma once

#include <myriad/methods.hpp>

#include "tests/kernel/model/order_of_threads.hpp"
#include "tests/kernel/model/unit_models.hpp"

namespace teams {

/// Lorenz 96: dx_i/dt = (x_(i+1) - x_(i-2)) x_(i-1) - x_i + F, whose units read the states of others.
struct place {
    enum unit_state { x, n_unit_state };
    enum parameter { F, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& y, const auto& p) {
        const int next = (unit + 1) % y.units, before = (unit + y.units - 1) % y.units,
                  second_before = (unit + y.units - 2) % y.units;
        return myriad::vec<R, n_unit_state>{(y.of(next)[x] - y.of(second_before)[x]) * y.of(before)[x] - y[x] + p[F]};
    }
};

/// The same with noise: one state that is noisy by its size, in a system with another that has additive noise.
struct noisy_place {
    enum unit_state { x, memory, n_unit_state };
    enum parameter { F, n_parameter };
    enum unit_parameter { strength, n_unit_parameter };
    enum publication { level, n_publication };
    static constexpr myriad::coupling couplings[] = {myriad::circulant_coupling(level, 1)};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_publication> publish(int, auto, const auto& y, const auto&) {
        return myriad::vec<R, n_publication>{y[memory]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& y, const auto& p) {
        return {p[F] - y[x] + R(0.1) * y.of((unit + 1) % y.units)[x] + y.coupled(0), y[x] - R(3) * y[memory]};
    }
    // snippet: diffusion
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> diffusion(int unit, auto, const auto& y, const auto& p) {
        return {R(0.1) * p.unit_parameter[strength] * y[x], R(0.2 + 0.01 * unit)};
    }
    // end of snippet
};
/// Of one state each, so that units share groups of processes.
struct noisy_point {
    enum unit_state { x, n_unit_state };
    enum parameter { F, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_state>{p[F] * (y.of((unit + 1) % y.units)[x] - y[x])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> diffusion(int, auto t, const auto&, const auto& p) {
        return myriad::vec<R, n_unit_state>{R(p[F] + t)};
    }
};

/// Balls on springs between neighbours, which fall on a table; where one lands, it takes a part of every other's speed.
/// Hooks of every kind, events, and stop times at which the system is kicked.
struct hopper {
    static constexpr bool accessories_are_outputs = true;
    enum unit_state { height, velocity, n_unit_state };
    enum parameter { spring, n_parameter };
    enum unit_parameter { restitution, n_unit_parameter };
    enum accessory { sum_of_heights, n_accessory };
    enum integer_accessory { landings, n_integer_accessory };
    enum unit_accessory { highest, apex, n_unit_accessory };
    enum unit_integer_accessory { own_landings, n_unit_integer_accessory };
    enum unit_event { landing, turning, n_unit_event };
    enum stop { kick, n_stop };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& y, const auto& p) {
        const int next = (unit + 1) % y.units, before = (unit + y.units - 1) % y.units;
        return {y[velocity],
                R(-9.81) + R(0.1) * p[spring] * (y.of(next)[height] + y.of(before)[height] - R(2) * y[height])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_event> events(int unit, auto, const auto& y, const auto& p) {
        // The height above a table that the next ball tilts a little.
        return {y[height] - R(0.01) * p.unit_parameter[restitution] * y.of((unit + 1) % y.units)[height], y[velocity]};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return R(0.11) * p[spring] * R(number + 1);
    }
    MYRIAD_FUNCTION static void initialise(int unit, auto& lane) {
        if (unit == 0) lane.integer_accessory[landings] = 0;
        lane.unit_accessory[highest] = lane.y[height];
        lane.unit_accessory[apex] = -1;
        lane.y[velocity] += 0.01 * unit;
    }
    MYRIAD_FUNCTION static myriad::action after_step(int unit, auto& lane) {
        if (lane.y[height] > lane.unit_accessory[highest]) lane.unit_accessory[highest] = lane.y[height];
        const bool is_last = unit == lane.y.units - 1;
        return is_last && lane.integer_accessory[landings] >= 30 ? myriad::action::end_phase : myriad::action::proceed;
    }
    MYRIAD_FUNCTION static myriad::action after_event(int unit, int event, auto& lane) {
        if (event == turning) {
            lane.unit_accessory[apex] = lane.t;
            return myriad::action::proceed;
        }
        lane.y[velocity] = -0.2 * lane.unit_parameter[restitution] * lane.y[velocity];
        for (int other = 0; other < lane.y.units; ++other)
            if (other != unit) lane.of(other).y[velocity] *= 0.99;
        lane.unit_integer_accessory[own_landings] = static_cast<int>(lane.event_count[landing]);
        lane.integer_accessory[landings] += 1;
        lane.h_next = 0.01;
        return myriad::action::proceed;
    }
    MYRIAD_FUNCTION static myriad::action after_stop(int unit, int, int number, auto& lane) {
        lane.y[velocity] += 0.1 * number + 0.01 * unit;
        return number == 9 ? myriad::action::end_instance : myriad::action::proceed;
    }
    MYRIAD_FUNCTION static void finalise(int unit, auto& lane) {
        if (unit == 0) lane.accessory[sum_of_heights] = 0;
        lane.accessory[sum_of_heights] += lane.y[height];
    }
};
/// Drifting points, whose hook, written for packs, ends the phase sooner and stops it.
struct drifter {
    static constexpr bool accessories_are_outputs = true, writes_time_domain = true;
    enum unit_state { x, n_unit_state };
    enum unit_parameter { rate, n_unit_parameter };
    enum unit_accessory { steps, n_unit_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto t, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_state>{p.unit_parameter[rate] * myriad::cos(t * R(3)) -
                                            y.of((unit + 1) % y.units)[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::mask_of<R> after_step(int unit, auto& lane) {
        lane.unit_accessory[steps] += R(1);
        if (unit == 3) lane.t_end = lane.t_end - R(0.0625) * lane.h;
        lane.y[x] = lane.y[x] * R(0.9990234375);
        return lane.y[x] > R(40);
    }
};

/// Pendulums between neighbours, with extrema and integrals of what each has, and of a difference between neighbours.
struct watched {
    static constexpr bool accessories_are_outputs = true;
    enum unit_state { angle, speed, n_unit_state };
    enum parameter { spring, n_parameter };
    enum unit_observed { energy, stretch, n_unit_observed };
    enum accessory { phases_seen, n_accessory };
    enum unit_accessory { most, when_most, work, widest, narrowest, when_narrowest, n_unit_accessory };
    static constexpr myriad::summary summaries[] = {{energy, myriad::over_phase::maximum, most},
                                                    {energy, myriad::over_phase::time_of_maximum, when_most},
                                                    {energy, myriad::over_phase::integral, work},
                                                    {stretch, myriad::over_phase::maximum, widest},
                                                    {stretch, myriad::over_phase::minimum, narrowest},
                                                    {stretch, myriad::over_phase::time_of_minimum, when_narrowest}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto t, const auto& y, const auto& p) {
        const int next = (unit + 1) % y.units, before = (unit + y.units - 1) % y.units;
        return {y[speed], p[spring] * (y.of(next)[angle] + y.of(before)[angle] - R(2) * y[angle]) -
                              R(4) * myriad::sin(R(2) * y[angle]) + myriad::cos(R(3) * t)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_observed> observe(int unit, auto, const auto& y, const auto& p) {
        return {R(0.5) * y[speed] * y[speed], p[spring] * (y.of((unit + 1) % y.units)[angle] - y[angle])};
    }
    MYRIAD_FUNCTION static void finalise(int unit, auto& lane) {
        if (unit == 0) lane.accessory[phases_seen] = lane.phase + 1 + lane.unit_accessory[widest];
    }
};
/// What is observed depends on the next unit's maximum and integral so far.
struct envious {
    enum unit_state { x, v, n_unit_state };
    enum parameter { spring, n_parameter };
    enum unit_observed { envy, n_unit_observed };
    enum unit_accessory { most, total, n_unit_accessory };
    static constexpr myriad::summary summaries[] = {{envy, myriad::over_phase::maximum, most},
                                                    {envy, myriad::over_phase::integral, total}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& y, const auto& p) {
        return {y[v], R(0.1) * y.of((unit + 1) % y.units)[x] - p[spring] * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_observed> observe(int unit, auto, const auto& y, const auto& p) {
        const auto next = p.of((unit + 1) % y.units);
        return myriad::vec<R, n_unit_observed>{y[x] + R(0.25) * next.unit_accessory[most] +
                                               R(0.1) * next.unit_accessory[total]};
    }
};
/// Charges that flow to the next unit, with an integral and no extrema: steps need no slopes of what is observed.
struct metered {
    static constexpr bool accessories_are_outputs = true;
    enum unit_state { charge, n_unit_state };
    enum unit_parameter { rate, n_unit_parameter };
    enum unit_observed { flow, n_unit_observed };
    enum unit_accessory { passed, n_unit_accessory };
    static constexpr myriad::summary summaries[] = {{flow, myriad::over_phase::integral, passed}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto t, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_state>{p.unit_parameter[rate] * (y.of((unit + 1) % y.units)[charge] - y[charge]) +
                                            myriad::sin(R(2) * t)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_observed> observe(int, auto, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_observed>{p.unit_parameter[rate] * y[charge] * y[charge]};
    }
};
/// Cells that fire at thresholds of their own: right-hand side and events read accessories, among them the largest
/// charge so far, and the hooks write them and parameters.
struct adapting {
    static constexpr bool writes_parameters = true;
    enum unit_state { charge, n_unit_state };
    enum parameter { gain, n_parameter };
    enum unit_parameter { drive, n_unit_parameter };
    enum accessory { inhibition, n_accessory };
    enum unit_accessory { threshold, largest, n_unit_accessory };
    enum integer_accessory { mode, n_integer_accessory };
    enum unit_integer_accessory { spikes, n_unit_integer_accessory };
    enum unit_event { fires, n_unit_event };
    enum unit_observed { height, n_unit_observed };
    enum stop { switched, n_stop };
    static constexpr myriad::summary summaries[] = {{height, myriad::over_phase::maximum, largest}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto t, const auto& y, const auto& p) {
        const R pull = p[gain] * (y.of((unit + 1) % y.units)[charge] - y[charge]);
        return myriad::vec<R, n_unit_state>{p.unit_parameter[drive] + R(0.1) * pull - p.accessory[inhibition] -
                                            R(0.05) * p.unit_accessory[largest] +
                                            myriad::select(p.integer_accessory[mode] > 0, myriad::cos(t * R(5)), R(0))};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_event> events(int unit, auto, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_event>{y[charge] - p.unit_accessory[threshold] -
                                            R(0.01) * p.of((unit + 2) % y.units).unit_parameter[drive]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_observed> observe(int, auto, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_observed>{y[charge] * (R(1) + R(0.01) * p.accessory[inhibition])};
    }
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto& p) {
        return R(0.2) * R(number + 1) + R(0.001) * p[gain];
    }
    MYRIAD_FUNCTION static void initialise(int unit, auto& lane) {
        if (unit == 0) {
            lane.accessory[inhibition] = 0.1;
            lane.integer_accessory[mode] = 0;
        }
        lane.unit_accessory[threshold] = 2.2 + 0.01 * unit;
        lane.unit_integer_accessory[spikes] = 0;
    }
    MYRIAD_FUNCTION static void after_step(int unit, auto& lane) {
        if (unit == 3 && lane.y[charge] > 2) lane.accessory[inhibition] = 0.125 * static_cast<int>(8 * lane.t);
    }
    MYRIAD_FUNCTION static void after_event(int unit, int, auto& lane) {
        lane.y[charge] *= 0.5;
        lane.unit_accessory[threshold] += 0.05;
        lane.unit_integer_accessory[spikes] += 1;
        lane.of((unit + 1) % lane.y.units).unit_parameter[drive] *= 0.96;
    }
    MYRIAD_FUNCTION static void after_stop(int unit, int, int number, auto& lane) {
        if (unit == 0) lane.integer_accessory[mode] = 1 + number % 2;
        if (unit == lane.y.units - 1) lane.parameter[gain] *= 1.01;
    }
};

template <class Unit, int threads>
struct of_team : Unit {
    static constexpr bool scalar_only = true;  // with the functions of one lane
    static constexpr int threads_per_instance = threads;
};
template <int threads>
using places = myriad::coupled_units<of_team<place, threads>, 30>;
template <int threads>
using phases = myriad::coupled_units<of_team<units::phase_oscillator, threads>, 19>;
template <int threads>
using ring = myriad::coupled_units<of_team<units::oscillator, threads>, 20>;
template <int threads>
using hoppers = myriad::coupled_units<of_team<hopper, threads>, 14>;
template <int threads>
using drifters = myriad::coupled_units<of_team<drifter, threads>, 21>;
template <int threads>
using watched_ring = myriad::coupled_units<of_team<watched, threads>, 11>;
template <int threads>
using envious_ring = myriad::coupled_units<of_team<envious, threads>, 9>;
template <int threads>
using metered_line = myriad::coupled_units<of_team<metered, threads>, 18>;
template <int threads>
using adapting_cells = myriad::coupled_units<of_team<adapting, threads>, 17>;
template <int threads>
using noisy_places = myriad::coupled_units<of_team<noisy_place, threads>, 11>;
template <int threads>
struct noisy_point_of_team : of_team<noisy_point, threads> {
    static constexpr bool additive_noise = true;  // of a model with `scalar_only` that is not found
};
template <int threads>
using noisy_points = myriad::coupled_units<noisy_point_of_team<threads>, 13>;
/// The last, written as a whole.
struct whole_of_points {
    static constexpr int n_state = 13, n_parameter = 1, n_shared = 0, n_accessory = 0, n_integer_accessory = 0;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_state> slopes;
        for (int i = 0; i < n_state; ++i) slopes[i] = p[0] * (y[(i + 1) % n_state] - y[i]);
        return slopes;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto t, const myriad::vec<R, n_state>&, const auto& p) {
        myriad::vec<R, n_state> factors;
        for (int i = 0; i < n_state; ++i) factors[i] = R(p[0] + t);
        return factors;
    }
};

using sriw1_by_halves = myriad::adaptive<myriad::sriw1>;

using with_memory = myriad::controlled<myriad::dormand_prince_5, myriad::pi_control>;
using sampled = myriad::dense<myriad::dormand_prince_5>;
using sampled_8 = myriad::dense<myriad::dormand_prince_8>;
using averaged = myriad::controlled<myriad::dormand_prince_8, myriad::rms_norm>;
using careful_start = myriad::controlled<myriad::cash_karp, myriad::automatic_first_step, myriad::mixed_scale>;

}  // namespace teams
