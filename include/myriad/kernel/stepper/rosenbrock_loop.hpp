// SPDX-License-Identifier: MIT
// A Rosenbrock step whose stages are a loop: for systems whose stages are too large for a GPU thread's registers.
#pragma once

#include <cstddef>
#include <utility>

#include "myriad/kernel/stepper/rosenbrock.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Bytes of stages up to which they are written out. Larger ones lie in local memory either way, and a loop has less
/// code and spills less. NVIDIA H200, rodas_5p, blocks of 64, ms for
/// written-out stages and for the loop: 8 states 4.3 and 14.5 (512 bytes), pollution with 20 states in single precision
/// 0.35 and 0.97 (640), in double precision 4.0 and 3.3 (1280), ring of 32 states 80 and 77 (2048), of 64 states 654
/// and 250 (4096).
inline constexpr int largest_stages_written_out = 1024;

/// Components whose sums over stages are added up in registers at a time.
inline constexpr int summed_at_once = 16;

template <class Method, class Model, class S>
constexpr bool loops_over_stages_of() {
    if constexpr (factorises_sparsely<Model> && lanes_of<S> == 1) {
        return static_cast<int>(sizeof(S)) * Method::stages * n_state<Model> > largest_stages_written_out;
    } else {
        return false;
    }
}
template <class Method, class Model, class S>
inline constexpr bool loops_over_stages = loops_over_stages_of<Method, Model, S>();

/// The weights of an argument in the kernel's precision, with those of the row that it repeats and extends.
template <class Method, int row, class R>
inline constexpr auto argument_weights = [] {
    auto weights = kept_rosenbrock_weights<Method, rosenbrock_row::argument, row, R>;
    if constexpr (first_new_stage < Method, row >> 0)
        for (std::size_t j = 0; j < first_new_stage<Method, row>; ++j)
            weights[j] = argument_weights<Method, row - 1, R>[j];
    return weights;
}();

/// The weights as tables, for a loop over stages.
template <class Method, class R>
struct rosenbrock_table {
    static constexpr int stages = Method::stages;
    R argument[stages + 1][stages]{}, coupling[stages + 1][stages]{}, stage_node[stages]{}, time_weight[stages]{};

    constexpr rosenbrock_table() : rosenbrock_table(std::make_integer_sequence<int, stages>{}) {}

private:
    template <int... i>
    constexpr explicit rosenbrock_table(std::integer_sequence<int, i...>)
        : stage_node{node<Method, i, R>...}, time_weight{rosenbrock_time_weight<Method, i, R>...} {
        (set(argument[i], argument_weights<Method, i, R>), ...);
        (set(coupling[i], kept_rosenbrock_weights<Method, rosenbrock_row::coupling, i, R>), ...);
        set(argument[stages], argument_weights<Method, stages, R>);
    }
    template <class Weights>
    static constexpr void set(R (&row)[stages], const Weights& weights) {
        for (int j = 0; j < stages; ++j) row[j] = weights[static_cast<std::size_t>(j)];
    }
};
template <class Method, class R>
MYRIAD_CONSTANT_MEMORY rosenbrock_table<Method, R> rosenbrock_table_of{};

/// `rosenbrock_step` by a loop over stages.
template <class Method, class Model, class R>
MYRIAD_FUNCTION void rosenbrock_step_in_a_loop(const R& t, const R& h, const R& t1, const vec<R, n_state<Model>>& y,
                                               const inputs<Model, R>& p,
                                               trial_step<Method, R, n_state<Model>>& trial) {
    constexpr int n = n_state<Model>;
    using loop = unrolled_loop<n>;
    const R per_h = detail::reciprocal_of_step(h);
    stage_factors<Model, R> lu;
    trial.singular = !detail::factorise_stage_matrix<Method, Model>(t, per_h, y, p, lu);
    vec<R, n> slope_t;
    if constexpr (depends_on_time<Model>) slope_t = detail::time_derivative<Model>(t, y, p);

    vec<R, n> slope = trial.k[0];
    MYRIAD_ROLLED
    for (int i = 0; i <= Method::stages; ++i) {
        vec<R, n> right;
        static_for<0, (n + summed_at_once - 1) / summed_at_once>([&](auto part) MYRIAD_LAMBDA {
            constexpr int begin = decltype(part)::value * summed_at_once;
            constexpr int count = n - begin < summed_at_once ? n - begin : summed_at_once;
            R increment[count]{}, moved[count]{};
            MYRIAD_ROLLED
            for (int j = 0; j < i; ++j) {
                const R weight = rosenbrock_table_of<Method, R>.argument[i][j];
                const R coupling = rosenbrock_table_of<Method, R>.coupling[i][j];
                static_for<0, count>([&](auto c) MYRIAD_LAMBDA {
                    const R u = trial.u[j][begin + c];
                    increment[c] = fma(weight, u, increment[c]);
                    moved[c] = fma(coupling, u, moved[c]);
                });
            }
            static_for<0, count>([&](auto c) MYRIAD_LAMBDA {
                trial.y[begin + c] = y[begin + c] + increment[c];
                right[begin + c] = moved[c];
            });
        });
        if (i == Method::stages) break;
        const bool at_end = Method::first_same_as_last && i == Method::stages - 1;
        if (i > 0) {
            const R stage_t = at_end ? t1 : fma(rosenbrock_table_of<Method, R>.stage_node[i], h, t);
            slope = detail::evaluate_rhs<Model>(stage_t, trial.y, p);
            if constexpr (Method::first_same_as_last)
                if (at_end) trial.k[1] = slope;
        }
        if constexpr (has_mass_matrix<Model>) {
            vec<R, n> moved{};
            static_for<0, n_mass_entry<Model>>([&](auto m) MYRIAD_LAMBDA {
                constexpr int entry = decltype(m)::value, row = mass_row<Model, entry>;
                moved[row] = fma(mass_value<Model, entry, R>, right[mass_column<Model, entry>], moved[row]);
            });
            right = moved;
        }
        loop::all([&](auto c) MYRIAD_LAMBDA {
            right[c] = fma(per_h, right[c], slope[c]);
            if constexpr (depends_on_time<Model>)
                right[c] = fma(h * rosenbrock_table_of<Method, R>.time_weight[i], slope_t[c], right[c]);
        });
        solve_factorised(lu, right);
        loop::all([&](auto c) MYRIAD_LAMBDA { trial.u[i][c] = right[c]; });
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
