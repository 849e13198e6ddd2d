// SPDX-License-Identifier: MIT
// Coupled units that read their past, and the same systems with all states written out.
#pragma once

#include <myriad/coupled_units.hpp>
#include <myriad/model.hpp>
#include <myriad/tangent.hpp>

namespace delayed_units {

// snippet: phase
/// Kuramoto's oscillators, each of which sees the others a time tau ago: M. K. S. Yeung, S. H. Strogatz, Phys. Rev.
/// Lett. 82 (1999) 648. Synchronised they have the frequency Omega = omega - K sin(Omega tau).
struct phase {
    enum unit_state { theta, n_unit_state };
    enum unit_parameter { omega, n_unit_parameter };
    enum parameter { K, tau, n_parameter };
    enum unit_delayed { theta_before, n_unit_delayed };
    enum publication { sine, cosine, n_publication };
    static constexpr myriad::coupling couplings[] = {myriad::full_coupling(sine), myriad::same_coupling(cosine, 0)};

    MYRIAD_FUNCTION static int delayed_state(int) { return theta; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_publication> publish(int, auto, const auto&, const auto& p) {
        return {myriad::sin(p.unit_delayed[theta_before]), myriad::cos(p.unit_delayed[theta_before])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_state>{
            p.unit_parameter[omega] +
            p[K] * (myriad::cos(y[theta]) * y.coupled(sine) - myriad::sin(y[theta]) * y.coupled(cosine))};
    }
};
// end of snippet
template <int n>
using phases = myriad::coupled_units<phase, n>;

/// The same as one model, with the entries of the matrix as shared values.
template <int n>
struct written_phases {
    static constexpr int n_state = n, n_parameter = n + 2, n_shared = n * n, n_delayed = n;

    MYRIAD_FUNCTION static int delayed_state(int j) { return j; }
    MYRIAD_FUNCTION static int same_lag(int) { return 0; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[1];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto, const myriad::vec<R, n>& y, const auto& p) {
        myriad::vec<R, n> slopes;
        for (int i = 0; i < n; ++i) {
            R sines = R(0), cosines = R(0);
            for (int j = 0; j < n; ++j) {
                sines = myriad::fma(R(p.shared[j * n + i]), myriad::sin(p.delayed[j]), sines);
                cosines = myriad::fma(R(p.shared[j * n + i]), myriad::cos(p.delayed[j]), cosines);
            }
            slopes[i] = p[2 + i] + p[0] * (myriad::cos(y[i]) * sines - myriad::sin(y[i]) * cosines);
        }
        return slopes;
    }
};

/// A ring whose units see their neighbours by conduction times of their own, x_i' = -x_i + a tanh(x_(i-1)(t -
/// from_left)) - b x_(i+1)(t - from_right), and what they were themselves. Before the start x_i was cos(t + i).
struct cell {
    enum unit_state { x, crossings, n_unit_state };
    enum unit_parameter { from_left, from_right, n_unit_parameter };
    enum parameter { a, b, n_parameter };
    enum unit_delayed { left, right, own, n_unit_delayed };
    enum unit_event { crossing, n_unit_event };
    enum unit_observed { seen, n_unit_observed };
    enum unit_accessory { largest, n_unit_accessory };
    static constexpr bool accessories_are_outputs = true;
    static constexpr int threads_per_instance = 4;  // on a GPU, of which two have two units
    static constexpr int units = 6;
    static constexpr myriad::summary summaries[] = {{seen, myriad::over_phase::maximum, largest}};

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    // snippet: neighbours
    MYRIAD_FUNCTION static int delayed_unit(int unit, int delayed) {
        return delayed == left ? (unit + units - 1) % units : delayed == right ? (unit + 1) % units : unit;
    }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, int delayed, const auto& p) {
        return delayed == left ? p.unit_parameter[from_left] : p.unit_parameter[from_right];
    }
    // end of snippet
    MYRIAD_FUNCTION static int same_lag(int delayed) { return delayed == own ? right : delayed; }
    template <class R>
    MYRIAD_FUNCTION static R history(int unit, int delayed, const R& t, const auto&) {
        return myriad::cos(t + R(delayed_unit(unit, delayed)));
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto, const auto& y, const auto& p) {
        return {p[a] * myriad::tanh(p.unit_delayed[left]) - y[x] - p[b] * p.unit_delayed[right], R(0)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_event> events(int, auto, const auto&, const auto& p) {
        return myriad::vec<R, n_unit_event>{p.unit_delayed[own]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_observed> observe(int, auto, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_observed>{y[x] - p.unit_delayed[own]};
    }
    MYRIAD_FUNCTION static void after_event(int, int, auto& lane) {
        lane.y[crossings] += 1 + lane.unit_delayed[left] * lane.unit_delayed[left];
    }
};
using cells = myriad::coupled_units<cell, cell::units>;

/// The same as one model.
struct written_cells {
    static constexpr int units = cell::units, n_state = 2 * units, n_parameter = 2 + 2 * units;
    static constexpr int n_delayed = 3 * units, n_event = units, n_observed = units, n_accessory = units;
    static constexpr bool accessories_are_outputs = true;
    static constexpr auto summaries = myriad::detail::summaries_of_units<cell, units>();

    MYRIAD_FUNCTION static int delayed_state(int j) { return 2 * cell::delayed_unit(j / 3, j % 3); }
    MYRIAD_FUNCTION static int same_lag(int j) { return j % 3 == 2 ? j - 1 : j; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const auto& p) {
        return p[2 + 2 * (j / 3) + (j % 3 > 0 ? 1 : 0)];
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int j, const R& t, const auto&) {
        return myriad::cos(t + R(cell::delayed_unit(j / 3, j % 3)));
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_state> slopes;
        for (int i = 0; i < units; ++i) {
            slopes[2 * i] = p[0] * myriad::tanh(p.delayed[3 * i]) - y[2 * i] - p[1] * p.delayed[3 * i + 1];
            slopes[2 * i + 1] = R(0);
        }
        return slopes;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, units> events(auto, const myriad::vec<R, n_state>&, const auto& p) {
        myriad::vec<R, units> values;
        for (int i = 0; i < units; ++i) values[i] = p.delayed[3 * i + 2];
        return values;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, units> observe(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, units> values;
        for (int i = 0; i < units; ++i) values[i] = y[2 * i] - p.delayed[3 * i + 2];
        return values;
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        lane.y[2 * event + 1] += 1 + lane.delayed[3 * event] * lane.delayed[3 * event];
    }
};

/// Units whose lags depend on time and on a neighbour's state, and that read slopes too, some with a history:
/// x' = -x(t - 1 - y^2 / 10) + s x'(t - 1), y' = x_(next) - y.
struct changing {
    enum unit_state { x, y, n_unit_state };
    enum unit_shared { s, n_unit_shared };
    enum unit_delayed { before, slope_before, n_unit_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    MYRIAD_FUNCTION static bool is_delayed_slope(int delayed) { return delayed == slope_before; }
    MYRIAD_FUNCTION static bool has_history(int delayed) { return delayed == before; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int unit, int delayed, const R& t, const auto& state, const auto&) {
        const R other = state.of((unit + 1) % state.units)[y];
        return delayed == before ? R(1) + other * other / R(10) + R(0.01) * t : R(1);
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int unit, int, const R& t, const auto& p) {
        return R(unit + 1) + R(p.unit_shared[s]) * t;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& state, const auto& p) {
        return {R(p.unit_shared[s]) * p.unit_delayed[slope_before] - p.unit_delayed[before],
                state.of((unit + 1) % state.units)[x] - state[y]};
    }
};
using changing_units = myriad::coupled_units<changing, 3>;
struct written_changing {
    static constexpr int n_state = 6, n_shared = 3, n_delayed = 6;

    MYRIAD_FUNCTION static int delayed_state(int j) { return j - j % 2; }
    MYRIAD_FUNCTION static bool is_delayed_slope(int j) { return j % 2 == 1; }
    MYRIAD_FUNCTION static bool has_history(int j) { return j % 2 == 0; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const R& t, const myriad::vec<R, n_state>& y, const auto&) {
        const R other = y[2 * ((j / 2 + 1) % 3) + 1];
        return j % 2 == 0 ? R(1) + other * other / R(10) + R(0.01) * t : R(1);
    }
    template <class R>
    MYRIAD_FUNCTION static R history(int j, const R& t, const auto& p) {
        return R(j / 2 + 1) + R(p.shared[j / 2]) * t;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_state> slopes;
        for (int i = 0; i < 3; ++i) {
            slopes[2 * i] = R(p.shared[i]) * p.delayed[2 * i + 1] - p.delayed[2 * i];
            slopes[2 * i + 1] = y[2 * ((i + 1) % 3)] - y[2 * i + 1];
        }
        return slopes;
    }
};

using phases_with_tangent = myriad::with_tangents<phases<5>, 1>;
using written_with_tangent = myriad::with_tangents<written_phases<5>, 1>;

}  // namespace delayed_units
