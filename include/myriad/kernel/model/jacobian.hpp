// SPDX-License-Identifier: MIT
// Derivatives of a model's right-hand side: the time derivative, and the Jacobian, the model's own or by dual numbers.
#pragma once

#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/matrix_loop.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Derivative of the right-hand side in the direction given by the derivatives of t and y.
template <class Model, class Dual, class S>
MYRIAD_FUNCTION vec<S, n_state<Model>> directional_derivative(const Dual& t, const vec<Dual, n_state<Model>>& y,
                                                              const inputs<Model, S>& p) {
    const auto f = Model::template rhs<Dual>(t, y, p);
    vec<S, n_state<Model>> out;
    MYRIAD_UNROLL_UP_TO(128, 128)
    for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) out[c] = f[c].derivative;
    return out;
}

/// y as constants.
template <class Dual, class S, extent n>
MYRIAD_FUNCTION vec<Dual, n> constants(const vec<S, n>& y) {
    vec<Dual, n> out;
    MYRIAD_UNROLL_UP_TO(128, 128)
    for (int c = 0; c < MYRIAD_LENGTH(n); ++c) out[c] = Dual(y[c]);
    return out;
}

/// df/dt.
template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_state<Model>> time_derivative(const S& t, const vec<S, n_state<Model>>& y,
                                                       const inputs<Model, S>& p) {
    const dual<S> moving(t, S(real_of<S>(1)));
    const auto at = constants<dual<S>>(y);
    if constexpr (has_delays<Model>) {  // the past moves with t
        const auto f = Model::template rhs<dual<S>>(moving, at, detail::moving_past<Model>(moving, at, p));
        vec<S, n_state<Model>> out;
        for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) out[c] = f[c].derivative;
        return out;
    } else {
        return detail::directional_derivative<Model>(moving, at, p);
    }
}

/// df_i/dy_j in row i and column j, by one evaluation of the right-hand side with dual numbers per column. In an
/// unrolled loop (small systems), the compiler computes the values, common to all columns, once.
template <class Model, class S>
MYRIAD_FUNCTION void dual_jacobian(const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p,
                                   matrix<S, n_state<Model>>& jacobian) {
    constexpr auto n = n_state<Model>;
    matrix_loop<S, n>::all([&](auto j) MYRIAD_LAMBDA {
        auto seeded = constants<dual<S>>(y);
        seeded[j].derivative = S(real_of<S>(1));
        const auto column = detail::directional_derivative<Model>(dual<S>(t), seeded, p);
        matrix_loop<S, n>::all([&](auto i) MYRIAD_LAMBDA { jacobian[i][j] = column[i]; });
    });
}

/// Writes the derivatives by a group of columns to their places, with no operation for what does not depend on them.
/// For packs: nvcc gave up on a network of 48 states whose derivatives know what they depend on. Out of line, since a
/// compiler takes more than twice as long for all groups in one function.
template <class Model, int group, class S>
MYRIAD_LARGE_FUNCTION void write_group(const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p,
                                       S* found) {
    using number = dual<S, partial<S>>;
    constexpr auto& groups = jacobian_groups_of<Model>;
    auto seeded = constants<number>(y);
    static_for<0, n_state<Model>>([&](auto j) MYRIAD_LAMBDA {
        if constexpr (groups.group_of_column[decltype(j)::value] == group) seeded[j].derivative = S(real_of<S>(1));
    });
    const auto columns = detail::directional_derivative<Model>(number(t), seeded, p);
    static_for<groups.begin[group], groups.begin[group + 1]>([&](auto place) MYRIAD_LAMBDA {
        found[place] = columns[groups.row[groups.entry_of_group[decltype(place)::value]]];
    });
}

/// Calls `put(e, derivative)` for the entries e of the pattern, declared or found: the model's own derivatives if it
/// has them, else those by dual numbers, by one evaluation of rhs for each group of columns. `Loop` is a table_loop.
template <class Model, class Loop, class S, class Put>
MYRIAD_FUNCTION void for_each_jacobian_entry(const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p,
                                             Put&& put) {
    using R = real_of<S>;
    using groups = std::remove_cv_t<decltype(jacobian_groups_of<Model>)>;
    constexpr int entries = n_jacobian_entry<Model>;
    if constexpr (has_delays<Model>) detail::recall<Model>(t, y, p);
    if constexpr (gives_jacobian<Model> && has_jacobian_pattern<Model>) {
        const vec<S, entries> own = Model::template jacobian<S>(t, y, p);
        Loop::template range<0, entries>([&](auto e) MYRIAD_LAMBDA { put(e, own[e]); });
    } else if constexpr (gives_jacobian<Model>) {
        const matrix<S, n_state<Model>> own = Model::template jacobian<S>(t, y, p);
        Loop::template range<0, entries>([&](auto e) MYRIAD_LAMBDA {
            put(e, own[Loop::template at<jacobian_groups_of<Model>, &groups::row>(e)]
                      [Loop::template at<jacobian_groups_of<Model>, &groups::column>(e)]);
        });
    } else if constexpr (Loop::is_written_out && lanes_of<S> > 1) {
        S found[entries];  // group by group
        static_for<0, jacobian_groups_of<Model>.count>(
            [&](auto group) MYRIAD_LAMBDA { detail::write_group<Model, decltype(group)::value>(t, y, p, found); });
        static_for<0, entries>([&](auto place) MYRIAD_LAMBDA {
            put(Loop::template at<jacobian_groups_of<Model>, &groups::entry_of_group>(place), found[place]);
        });
    } else {
        Loop::template range<0, jacobian_groups_of<Model>.count>([&](auto group) MYRIAD_LAMBDA {
            auto seeded = constants<dual<S>>(y);
            Loop::template range<0, n_state<Model>>([&](auto j) MYRIAD_LAMBDA {
                const int its = Loop::template at<jacobian_groups_of<Model>, &groups::group_of_column>(j);
                seeded[j].derivative = S(its == group ? R(1) : R(0));
            });
            const auto columns = detail::directional_derivative<Model>(dual<S>(t), seeded, p);
            Loop::template between<jacobian_groups_of<Model>, &groups::begin>(group, [&](auto place) MYRIAD_LAMBDA {
                const auto e = Loop::template at<jacobian_groups_of<Model>, &groups::entry_of_group>(place);
                put(e, columns[Loop::template at<jacobian_groups_of<Model>, &groups::row>(e)]);
            });
        });
    }
}

/// The model's own Jacobian if it has one, else that by dual numbers. By the state as it is, not as it was.
template <class Model, class S>
MYRIAD_FUNCTION void evaluate_jacobian(const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p,
                                       matrix<S, n_state<Model>>& jacobian) {
    if constexpr (has_delays<Model>) detail::recall<Model>(t, y, p);
    if constexpr (gives_jacobian<Model> && has_jacobian_pattern<Model>) {
        const auto own = Model::template jacobian<S>(t, y, p);
        jacobian = {};
        for (int e = 0; e < n_declared_entry<Model>; ++e)
            jacobian[Model::jacobian_pattern[e].row][Model::jacobian_pattern[e].column] = own[e];
    } else if constexpr (gives_jacobian<Model>) {
        jacobian = Model::template jacobian<S>(t, y, p);
    } else {
        detail::dual_jacobian<Model>(t, y, p, jacobian);
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
