// SPDX-License-Identifier: MIT
// Coupled units twice: integrated by one thread, and by a team of so many.
#pragma once

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

using with_memory = myriad::controlled<myriad::dormand_prince_5, myriad::pi_control>;
using careful_start = myriad::controlled<myriad::cash_karp, myriad::automatic_first_step, myriad::mixed_scale>;

/// Who comes first between two points at which the threads of a team wait for each other.
enum class order { first_thread_first, last_thread_first };
inline order order_of_threads = order::first_thread_first;

}  // namespace teams
