// SPDX-License-Identifier: MIT
// Systems of coupled units, each with a model of the same equations that is written as a whole.
#pragma once

#include <myriad/coupled_units.hpp>
#include <myriad/model.hpp>
#include <myriad/tangent.hpp>

namespace units {

/// Oscillators in a ring, x'' = -k x - c x' + s (sum of the neighbours' x) + forcing, which read the states of others.
struct oscillator {
    enum unit_state { x, v, n_unit_state };
    enum parameter { c, n_parameter };
    enum unit_parameter { k, n_unit_parameter };
    enum shared { s, n_shared };
    enum unit_shared { forcing, n_unit_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto t, const auto& y, const auto& p) {
        const auto left = y.of((unit + y.units - 1) % y.units), right = y.of((unit + 1) % y.units);
        return {y[v], -p.unit_parameter[k] * y[x] - p[c] * y[v] + p.shared[s] * (left[x] + right[x]) +
                          p.unit_shared[forcing] * myriad::cos(t)};
    }
};
template <int n>
using ring = myriad::coupled_units<oscillator, n>;

/// The same, written as a whole.
template <int n>
struct whole_ring {
    static constexpr int n_state = 2 * n, n_parameter = 1 + n, n_shared = 1 + n;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_state> slopes;
        for (int i = 0; i < n; ++i) {
            const int left = (i + n - 1) % n, right = (i + 1) % n;
            slopes[2 * i] = y[2 * i + 1];
            slopes[2 * i + 1] = -p[1 + i] * y[2 * i] - p[0] * y[2 * i + 1] +
                                p.shared[0] * (y[2 * left] + y[2 * right]) + p.shared[1 + i] * myriad::cos(t);
        }
        return slopes;
    }
};

/// Phases that pull each other by what they publish, with couplings of every shape; the unit's own publications, too.
struct phase_oscillator {
    enum unit_state { phase, lag, n_unit_state };
    enum unit_parameter { speed, n_unit_parameter };
    enum publication { sine, cosine, n_publication };
    enum { full_sine, banded_cosine, ring_sine, all_round, full_cosine };
    static constexpr myriad::coupling couplings[] = {
        myriad::full_coupling(sine), myriad::banded_coupling(cosine, 2), myriad::circulant_coupling(sine, 1),
        myriad::circulant_coupling(cosine), myriad::same_coupling(cosine, full_sine)};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_publication> publish(int, auto, const auto& y, const auto&) {
        return {myriad::sin(y[phase]), myriad::cos(y[phase])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto, const auto& y, const auto& p) {
        return {p.unit_parameter[speed] + y.published(cosine) * y.coupled(full_sine) -
                    y.published(sine) * y.coupled(banded_cosine),
                y[phase] - y[lag] + y.coupled(ring_sine) + y.coupled(all_round) + y.coupled(full_cosine)};
    }
};
template <int n>
using phases = myriad::coupled_units<phase_oscillator, n>;

/// Balls that fall on a table; where one lands, it takes a part of every other's speed. Hooks of every kind.
struct ball {
    static constexpr bool accessories_are_outputs = true;
    enum unit_state { height, velocity, n_unit_state };
    enum unit_parameter { restitution, n_unit_parameter };
    enum shared { gravity, kick, n_shared };
    enum accessory { impacts_seen, n_accessory };
    enum unit_accessory { last_impact, steps, highest, n_unit_accessory };
    enum integer_accessory { impacts, n_integer_accessory };
    enum unit_integer_accessory { own_impacts, n_unit_integer_accessory };
    enum unit_event { landing, n_unit_event };
    enum unit_observed { elevation, n_unit_observed };
    static constexpr myriad::summary summaries[] = {{elevation, myriad::over_phase::maximum, highest}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto, const auto& y, const auto& p) {
        return {y[velocity], R(-p.shared[gravity])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_event> events(int, auto, const auto& y, const auto&) {
        return myriad::vec<R, n_unit_event>{y[height]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_observed> observe(int, auto, const auto& y, const auto&) {
        return myriad::vec<R, n_unit_observed>{y[height]};
    }
    MYRIAD_FUNCTION static void initialise(int unit, auto& lane) {
        if (unit == 0) {
            lane.accessory[impacts_seen] = 0;
            lane.integer_accessory[impacts] = 0;
        }
        lane.unit_accessory[last_impact] = -1;
        lane.unit_accessory[steps] = 0;
        lane.unit_integer_accessory[own_impacts] = 0;
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(int, auto& lane) {
        lane.unit_accessory[steps] += R(1);
    }
    MYRIAD_FUNCTION static myriad::action after_event(int unit, int, auto& lane) {
        lane.y[velocity] = -lane.unit_parameter[restitution] * lane.y[velocity];
        for (int other = 0; other < lane.y.units; ++other)
            if (other != unit) lane.of(other).y[velocity] *= 1 - lane.shared[kick];
        lane.unit_accessory[last_impact] = lane.t;
        lane.unit_integer_accessory[own_impacts] = static_cast<int>(lane.event_count[landing]);
        lane.integer_accessory[impacts] += 1;
        return lane.integer_accessory[impacts] == 12 ? myriad::action::end_instance : myriad::action::proceed;
    }
    MYRIAD_FUNCTION static void finalise(int, auto& lane) {
        lane.accessory[impacts_seen] += lane.unit_integer_accessory[own_impacts];
    }
};
template <int n>
using balls = myriad::coupled_units<ball, n>;

/// Two units, of which each reads the one that a shared integer names.
struct pointing {
    enum unit_state { x, n_unit_state };
    enum unit_shared_integer { target, n_unit_shared_integer };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_state>{y.of(p.unit_shared_integer[target])[x]};
    }
};

using ring_of_3 = ring<3>;
using ring_of_20 = ring<20>;
using whole_ring_of_3 = whole_ring<3>;
using whole_ring_of_20 = whole_ring<20>;
using phases_of_7 = phases<7>;
using phases_of_19 = phases<19>;
using balls_of_2 = balls<2>;
using balls_of_9 = balls<9>;
using ring_of_3_with_tangents = myriad::with_tangents<ring<3>, 2>;
using whole_ring_of_3_with_tangents = myriad::with_tangents<whole_ring<3>, 2>;
using pointing_at_2 = myriad::coupled_units<pointing, 2>;

}  // namespace units
