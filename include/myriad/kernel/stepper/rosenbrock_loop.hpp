// SPDX-License-Identifier: MIT
// A Rosenbrock step whose stages are a loop: for systems whose stages are too large for a GPU thread's registers.
#pragma once

#include <cstddef>
#include <utility>

#include "myriad/kernel/stepper/step_memory.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Components whose sums over stages are added up in registers at a time, so that as many loads are under way. Equal
/// parts of 33 states, 11 each, took 6 % longer than 16, 16 and 1 (ras/cAMP/PKA, NVIDIA H100).
inline constexpr int summed_at_once = 16;

/// The weights as tables, for a loop over stages.
template <class Method, class R>
struct rosenbrock_table {
    static constexpr int stages = Method::stages;
    struct weights {
        R argument, coupling;
    };
    struct {
        bool extends;  // the row before it, by one stage
        weights weight[stages];
    } row[stages + 1]{};
    R stage_node[stages]{}, time_weight[stages]{};

    constexpr rosenbrock_table() : rosenbrock_table(std::make_integer_sequence<int, stages>{}) {}

private:
    template <int... i>
    constexpr explicit rosenbrock_table(std::integer_sequence<int, i...>)
        : stage_node{node<Method, i, R>...}, time_weight{rosenbrock_time_weight<Method, i, R>...} {
        ((row[i + 1].extends = i > 0 && first_new_stage<Method, i + 1> == i), ...);
        (set(row[i], &weights::coupling, kept_rosenbrock_weights<Method, rosenbrock_row::coupling, i, R>), ...);
        (set(row[i + 1], &weights::argument, kept_rosenbrock_weights<Method, rosenbrock_row::argument, i + 1, R>), ...);
    }
    template <class Row, class Weights>
    static constexpr void set(Row& to, R weights::*which, const Weights& values) {
        for (int j = 0; j < stages; ++j) to.weight[j].*which = values[static_cast<std::size_t>(j)];
    }
};
template <class Method, class R>
MYRIAD_CONSTANT_MEMORY rosenbrock_table<Method, R> rosenbrock_table_of{};

/// `rosenbrock_step` by a loop over stages: a stage is solved for, and added up with those before it to the next one's
/// argument and right side. Where a stiffly accurate method's argument repeats the one before it, only the new stage is
/// added.
template <class Method, class Model, class R>
MYRIAD_FUNCTION void rosenbrock_step_in_a_loop(const R& t, const R& h, const R& t1, const vec<R, n_state<Model>>& y,
                                               const inputs<Model, R>& p,
                                               trial_step<Method, R, n_state<Model>>& trial) {
    constexpr auto n = n_state<Model>;
    constexpr auto& table = rosenbrock_table_of<Method, R>;
    using loop = unrolled_loop<n>;
    const R per_h = detail::reciprocal_of_step(h);
    step_storage<Method, Model, R> storage(trial);
    auto& u = storage.u();
    auto& argument = storage.argument();
    sparse_lu_factors<Model, R> lu;
    trial.singular = !detail::factorise_stage_matrix<Method, Model>(
        t, per_h, y, p, lu, [&](auto entry, const R& value) MYRIAD_LAMBDA { storage.keep(entry, value); });
    vec<R, n> slope_t;
    if constexpr (depends_on_time<Model>) slope_t = detail::time_derivative<Model>(t, y, p);

    vec<R, n> right = trial.k[0];  // of the system of a stage
    const auto add_time = [&](int stage) MYRIAD_LAMBDA {
        if constexpr (depends_on_time<Model>) {
            const R weight = h * table.time_weight[stage];
            loop::all([&](auto c) MYRIAD_LAMBDA { right[c] = fma(weight, slope_t[c], right[c]); });
        }
    };
    add_time(0);
    MYRIAD_ROLLED
    for (int i = 1;; ++i) {
        storage.read_again();
        solve_factorised<Model>(storage.factors(lu), right);
        loop::all([&](auto c) MYRIAD_LAMBDA { u[i - 1][c] = right[c]; });
        storage.read_again();
        const auto& solved = storage.solved(i - 1, right);
        const auto& row = table.row[i];
        static_for<0, (n + summed_at_once - 1) / summed_at_once>([&](auto part) MYRIAD_LAMBDA {
            constexpr int begin = decltype(part)::value * summed_at_once;
            constexpr int count = n - begin < summed_at_once ? n - begin : summed_at_once;
            R sum[count], moved[count];
            static_for<0, count>([&](auto c) MYRIAD_LAMBDA {
                sum[c] = row.weight[i - 1].argument * solved[begin + c];
                moved[c] = row.weight[i - 1].coupling * solved[begin + c];
            });
            if (row.extends) {
                const int coupled = i < Method::stages ? i - 1 : 0;
                MYRIAD_ROLLED
                for (int j = 0; j < coupled; ++j) {
                    const R coupling = row.weight[j].coupling;
                    static_for<0, count>([&](auto c)
                                             MYRIAD_LAMBDA { moved[c] = fma(coupling, u[j][begin + c], moved[c]); });
                }
                static_for<0, count>([&](auto c) MYRIAD_LAMBDA { argument[begin + c] = argument[begin + c] + sum[c]; });
            } else {
                MYRIAD_ROLLED
                for (int j = 0; j < i - 1; ++j) {
                    const auto weight = row.weight[j];
                    static_for<0, count>([&](auto c) MYRIAD_LAMBDA {
                        const R stage = u[j][begin + c];
                        sum[c] = fma(weight.argument, stage, sum[c]);
                        moved[c] = fma(weight.coupling, stage, moved[c]);
                    });
                }
                static_for<0, count>([&](auto c) MYRIAD_LAMBDA { argument[begin + c] = y[begin + c] + sum[c]; });
            }
            // Kept where the stage will be, as registers are short in the right-hand side.
            if (i < Method::stages) static_for<0, count>([&](auto c) MYRIAD_LAMBDA { u[i][begin + c] = moved[c]; });
        });
        storage.read_again();
        if (i == Method::stages) break;
        const bool at_end = Method::first_same_as_last && i == Method::stages - 1;
        right = detail::evaluate_rhs<Model>(at_end ? t1 : fma(table.stage_node[i], h, t), argument, p);
        if constexpr (Method::first_same_as_last)
            if (at_end) trial.k[1] = right;
        if constexpr (has_mass_matrix<Model>) {
            static_for<0, n_mass_entry<Model>>([&](auto m) MYRIAD_LAMBDA {
                constexpr int entry = decltype(m)::value, to = mass_row<Model, entry>;
                right[to] = fma(per_h * mass_value<Model, entry, R>, u[i][mass_column<Model, entry>], right[to]);
            });
        } else {
            loop::all([&](auto c) MYRIAD_LAMBDA { right[c] = fma(per_h, u[i][c], right[c]); });
        }
        add_time(i);
    }
    storage.finish();
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
