// SPDX-License-Identifier: MIT
// Algebraic states after an action, or where a phase begins: Newton's method makes them satisfy their equations again.
// Only in kernels of models with a singular mass matrix.
#pragma once

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/model/jacobian.hpp"
#include "myriad/kernel/model/null_spaces.hpp"
#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/stepper/explicit_rk.hpp"
#include "myriad/kernel/stepper/lu.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A state that satisfies the algebraic equations to the tolerances, or none.
template <class R, extent n>
struct consistent_state {
    vec<R, n> y;
    bool found, changed;
    int evaluations;  // of the right-hand side
};

/// Newton's method for the algebraic equations v f(t, y + w x) = 0, with v and w as in `null_spaces`. `allowed` is what
/// the tolerances allow of each state.
template <class Model, class R>
struct algebraic_solver {
    static constexpr auto n = n_state<Model>, count = n_algebraic<Model>;
    using unknowns = vec<R, count>;

    R t;
    inputs<Model, R> p;
    vec<R, n> allowed;
    int evaluations = 0;

    /// A state that is consistent to the tolerances stays as it is. Else full steps are taken, or parts of them as far
    /// as the next correction by the same factors is smaller (the natural monotonicity test, Deuflhard, Newton Methods
    /// for Nonlinear Problems, 3.3), until it is a thousandth of what the tolerances allow, or rounding.
    MYRIAD_FUNCTION consistent_state<R, n> solve(vec<R, n> y) {
        unknowns residual = residual_at(y);
        for (int iteration = 0; iteration < 50; ++iteration) {
            lu_factors<R, count> lu;
            put_slopes(y, lu.a);
            if (!factorise(lu)) break;
            solve_factorised(lu, residual);
            const R size = size_of(residual, y, R(1e-3));
            if (iteration == 0 && size_of(residual, y, R(1)) <= R(1)) return {y, true, false, evaluations};
            R part = R(1), next_size;
            vec<R, n> next;
            unknowns next_residual, correction;
            for (;;) {
                next = moved(y, residual, -part);
                next_residual = residual_at(next);
                correction = next_residual;
                solve_factorised(lu, correction);
                next_size = size_of(correction, next, R(1e-3));
                if (next_size <= R(1) || next_size <= (R(1) - part / R(4)) * size) break;
                part = part / R(2);
                if (part < epsilon_of<R>) return {y, false, false, evaluations};
            }
            y = next;
            residual = next_residual;
            if (next_size <= R(1)) return {moved(y, correction, R(-1)), true, true, evaluations};
        }
        return {y, false, false, evaluations};
    }

private:
    MYRIAD_FUNCTION unknowns residual_at(const vec<R, n>& y) {
        const vec<R, n> f = detail::evaluate_rhs<Model>(t, y, p);
        ++evaluations;
        return combined(f);
    }
    /// v f for each equation. What a row does not contain has no part in it, also where it is not finite.
    static MYRIAD_FUNCTION unknowns combined(const vec<R, n>& f) {
        unknowns sums{};
        detail::for_each_null_space_entry<algebraic_equations<Model>, R>(
            [&](auto k, auto c, R value) MYRIAD_LAMBDA { sums[k] = fma(value, f[c], sums[k]); });
        return sums;
    }
    /// The derivatives of the equations in each direction.
    MYRIAD_FUNCTION void put_slopes(const vec<R, n>& y, matrix<R, count>& slopes) const {
        matrix_loop<R, count>::all([&](auto direction) MYRIAD_LAMBDA {
            auto seeded = constants<dual<R>>(y);
            detail::for_each_null_space_entry<algebraic_directions<Model>, R>([&](auto k, auto c, R value)
                                                                                  MYRIAD_LAMBDA {
                                                                                      if (k == direction)
                                                                                          seeded[c].derivative = value;
                                                                                  });
            const unknowns column = combined(detail::directional_derivative<Model>(dual<R>(t), seeded, p));
            matrix_loop<R, count>::all([&](auto k) MYRIAD_LAMBDA { slopes[k][direction] = column[k]; });
        });
    }
    static MYRIAD_FUNCTION vec<R, n> moved(vec<R, n> y, const unknowns& by, R factor) {
        detail::for_each_null_space_entry<algebraic_directions<Model>, R>(
            [&](auto k, auto c, R value) MYRIAD_LAMBDA { y[c] = fma(factor * value, by[k], y[c]); });
        return y;
    }
    /// The largest change of a state, relative to `part` of what is allowed or, if that is more, to its rounding. NaN
    /// if one is.
    MYRIAD_FUNCTION R size_of(const unknowns& by, const vec<R, n>& y, R part) const {
        const vec<R, n> change = moved(vec<R, n>{}, by, R(1));
        R largest = R(0);
        for (int c = 0; c < n; ++c) {
            const R ratio = abs(change[c]) / max(part * allowed[c], R(8) * epsilon_of<R> * abs(y[c]));
            largest = ratio <= largest ? largest : ratio;
        }
        return largest;
    }
};

/// The same out of line, as it is rarely called.
template <class Model, class R>
MYRIAD_RARE_FUNCTION consistent_state<R, n_state<Model>> solve_algebraic(algebraic_solver<Model, R> equations,
                                                                         vec<R, n_state<Model>> y) {
    return equations.solve(y);
}

/// Whether a lane's state was made consistent by changing it, and `singular_jacobian` where no such state is found.
struct state_correction {
    bool changed;
    status ending;
};

/// Makes the state of lane i consistent, where it is not to within the tolerances: M y stays as it is.
template <class Model, class Method, class S>
MYRIAD_FUNCTION state_correction make_state_consistent(const kernel_arguments<Model, real_of<S>>& args,
                                                       integration_state<Model, Method, S>& s, int i) {
    using R = real_of<S>;
    constexpr auto n = n_state<Model>;
    const vec<R, n> y = get_lanes<R>(s.data.y, i);
    algebraic_solver<Model, R> equations{get_lane(s.data.t, i), detail::inputs_of_lane(s.data, i), {}};
    for (int c = 0; c < n; ++c)
        equations.allowed[c] =
            max(detail::absolute_tolerance_of(args, c), detail::relative_tolerance_of(args, c) * abs(y[c]));
    const auto result = detail::solve_algebraic(equations, y);
    set_count(s.extra_evaluations, i, get_lane(s.extra_evaluations, i) + static_cast<real_of<S>>(result.evaluations));
    if (result.changed) set_lanes(s.data.y, i, result.y);
    return {result.changed, result.found ? status::success : status::singular_jacobian};
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
