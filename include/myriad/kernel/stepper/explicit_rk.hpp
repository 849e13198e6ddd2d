// SPDX-License-Identifier: MIT
// One trial step of an explicit Runge-Kutta method, unrolled from its tableau: stages, new state, error estimate.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/methods/weights.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/model/rhs_weight.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// `evaluate_rhs` out of line.
template <class Model, class S>
MYRIAD_CALLED_FUNCTION vec<S, n_state<Model>> call_rhs(MYRIAD_CALL_ARGUMENT(S) t,
                                                       MYRIAD_CALL_ARGUMENT(vec<S, n_state<Model>>) y,
                                                       MYRIAD_CALL_ARGUMENT(inputs<Model, S>) p) {
    return Model::template rhs<S>(t, y, p);
}

/// Evaluates the model's right-hand side: of a heavy one a kernel has one copy, which all stages call. Where the model
/// has delays, `past_is_set` says that `p` has their values at that time and state.
template <class Model, bool past_is_set = false, class S>
MYRIAD_FUNCTION vec<S, n_state<Model>> evaluate_rhs(const S& t, const vec<S, n_state<Model>>& y,
                                                    const inputs<Model, S>& p) {
    if constexpr (has_delays<Model> && !past_is_set) detail::recall<Model>(t, y, p);
    if constexpr (calls_rhs<Model, S>) {
        return detail::call_rhs<Model, S>(t, y, p);
    } else {
        return Model::template rhs<S>(t, y, p);
    }
}

/// Refuses a method with an incomplete tableau.
template <class Method>
constexpr bool check_tableau() {
    constexpr auto t = Method::tableau();
    constexpr auto given = [](const auto& weights) {
        for (const double w : weights)
            if (w != 0) return true;
        return false;
    };
    static_assert(given(t.b), "the method's tableau has no weights b: tableau() must set those of the solution");
    constexpr bool every_stage = [t, given] {
        for (std::size_t i = 1; i < t.a.size(); ++i)
            if (!given(t.a[i])) return false;
        return true;
    }();
    static_assert(
        every_stage,
        "the method's tableau has a stage without weights: tableau() must set a[1] to the row of the last stage");
    static_assert(
        Method::embedded_order <= 0 || given(t.e),
        "the method has an embedded_order, but no error weights e, with which it would accept every step: "
        "tableau() must set e to b less the embedded solution's weights, or embedded_order be 0, for fixed steps");
    return true;
}

/// The result of a trial step: the slopes of its stages (the first is the slope at its start) and the new state.
template <class Method, class S, extent n>
struct trial_step {
    static_assert(check_tableau<Method>());
    vec<vec<S, n>, Method::stages> k;
    vec<S, n> y;

    MYRIAD_FUNCTION vec<S, n>& slope_start() { return k[0]; }
    MYRIAD_FUNCTION const vec<S, n>& slope_start() const { return k[0]; }
    /// For methods whose last stage is the first of the next step.
    MYRIAD_FUNCTION const vec<S, n>& slope_end() const { return k[Method::stages - 1]; }
};

/// The order with which a method's error estimate decreases, less one: that of the embedded solution, unless given.
template <class Method>
inline constexpr int estimate_order = [] {
    if constexpr (requires { Method::estimate_order; }) {
        return Method::estimate_order;
    } else {
        return Method::embedded_order;
    }
}();

// A GPU instruction can hold a constant whose lower half is zero; to load any other takes two more instructions, or one
// from constant memory.
template <class R>
constexpr bool is_short(R x) {
    if constexpr (sizeof(R) == sizeof(double)) return (__builtin_bit_cast(std::uint64_t, x) & 0xffffffff) == 0;
    return true;
}
template <class Method, int row, int j, class R>
inline constexpr bool is_short_weight = is_short(relative_weight<Method, row, j, R>);
template <class Method, int row, class R>
inline constexpr bool is_short_first = is_short(first_weight<Method, row, R>);
template <class Method, int row, int j, class R>
MYRIAD_CONSTANT_MEMORY R kept_weight = relative_weight<Method, row, j, R>;
template <class Method, int row, class R>
MYRIAD_CONSTANT_MEMORY R kept_first = first_weight<Method, row, R>;

template <class Method, int stage, class R>
inline constexpr bool is_short_node = is_short(node<Method, stage, R>);
template <class Method, int stage, class R>
MYRIAD_CONSTANT_MEMORY R kept_node = node<Method, stage, R>;

/// The same constants as operands.
template <class Method, int row, int j, class R>
MYRIAD_FUNCTION R weight_operand() {
    if constexpr (is_short_weight<Method, row, j, R>) {
        return relative_weight<Method, row, j, R>;
    } else {
        return kept_weight<Method, row, j, R>;
    }
}
template <class Method, int row, class R>
MYRIAD_FUNCTION R first_operand() {
    if constexpr (is_short_first<Method, row, R>) {
        return first_weight<Method, row, R>;
    } else {
        return kept_first<Method, row, R>;
    }
}

template <class Method, int stage, class R>
MYRIAD_FUNCTION R node_operand() {
    if constexpr (is_short_node<Method, stage, R>) {
        return node<Method, stage, R>;
    } else {
        return kept_node<Method, stage, R>;
    }
}

/// sum += weight * k with the relative weight of stage j; zero and one take no multiplication.
template <class Method, int row, int j, class S>
MYRIAD_FUNCTION void add_weighted(S& sum, const S& k) {
    using R = real_of<S>;
    if constexpr (relative_weight<Method, row, j, R> == R(1)) {
        sum = sum + k;
    } else if constexpr (relative_weight<Method, row, j, R> != R(0)) {
        sum = fma(S(detail::weight_operand<Method, row, j, R>()), k, sum);
    }
}

/// sum_j w_j k_j / w_first for one component. Dividing the weights by the first non-zero one (at compile time) saves
/// one operation per component compared with h * sum: the caller multiplies once by h * w_first.
template <class Method, int row, class S, extent n>
MYRIAD_FUNCTION S scaled_sum(const vec<vec<S, n>, Method::stages>& k, int component) {
    constexpr int first = first_stage<Method, row>;
    constexpr int end = row < Method::stages ? row : Method::stages;
    S sum = k[first][component];
    static_for<first + 1, end>(
        [&](auto j) MYRIAD_LAMBDA { detail::add_weighted<Method, row, decltype(j)::value>(sum, k[j][component]); });
    return sum;
}

/// y + h * sum_j w_j k_j with the weights of `row`: the argument of a stage, or the new state.
template <class Method, int row, class S, extent n>
MYRIAD_FUNCTION vec<S, n> combine(const vec<S, n>& y, const S& h, const vec<vec<S, n>, Method::stages>& k) {
    const S scale = h * S(detail::first_operand<Method, row, real_of<S>>());
    vec<S, n> out;
    MYRIAD_UNROLL_UP_TO(64, 16)
    for (int c = 0; c < MYRIAD_LENGTH(n); ++c) out[c] = fma(scale, detail::scaled_sum<Method, row>(k, c), y[c]);
    return out;
}

/// The error estimate h * sum_j e_j k_j of a component: the product of a factor common to all components and a sum.
template <class Method, int row = row_of<Method>::error, class S>
MYRIAD_FUNCTION S error_factor(const S& h) {
    return h * S(detail::first_operand<Method, row, real_of<S>>());
}
template <class Method, int row = row_of<Method>::error, class S, extent n>
MYRIAD_FUNCTION S error_sum(const trial_step<Method, S, n>& trial, int component) {
    return detail::scaled_sum<Method, row>(trial.k, component);
}

/// Whether g++ copies such vectors through memory, by string instructions.
template <class S, extent n>
inline constexpr bool is_large_in_packs = lanes_of<S> > 1 && sizeof(vec<S, n>) > 1024;

/// to = from, component by component in large packs.
template <class S, extent n>
MYRIAD_FUNCTION void copy_components(vec<S, n>& to, const vec<S, n>& from) {
    if constexpr (is_large_in_packs<S, n>) {
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) to[c] = from[c];
    } else {
        to = from;
    }
}
/// to = make(); in large packs the result is constructed in place, without a copy. xsimd's headers declare placement
/// new, so that code for GPUs, which has no packs, needs no header for it.
template <class S, extent n, class Make>
MYRIAD_FUNCTION void put_result(vec<S, n>& to, Make&& make) {
    if constexpr (is_large_in_packs<S, n>) {
        ::new (static_cast<void*>(&to)) vec<S, n>(make());
    } else {
        to = make();
    }
}

/// Whether a stage's slope enters neither the new state nor an error estimate.
template <class Method, int stage>
inline constexpr bool is_unseen_stage = [] {
    constexpr int last_row = has_coarse_estimate<Method> ? row_of<Method>::coarse_error : row_of<Method>::error;
    for (int row = row_of<Method>::solution; row <= last_row; ++row)
        if (weight_in<Method>(row, stage) != 0) return false;
    return true;
}();
/// Makes a stage's slope NaN if the slope of an unseen stage before it is not finite. Its argument is NaN already, but
/// a model may return a finite slope for it, as select(x > 1, NaN, 1) does. Others keep every bit: -0 adds nothing.
template <class Method, int stage, class S, extent n>
MYRIAD_FUNCTION void see_stage_before(vec<vec<S, n>, Method::stages>& k) {
    if constexpr (is_unseen_stage<Method, stage - 1>) {
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c)
            k[stage][c] = fma(S(-real_of<S>(0)), abs(k[stage - 1][c]), k[stage][c]);
    }
}

/// Steps from (t, y) over h to t1; `trial.k[0]`, the slope at the start, is given. A last stage that is the first of
/// the next step is evaluated at t1, which may differ from t + h by rounding. The new state is summed stage by stage,
/// so that slopes no later stage needs free their registers. Where the trial step lies `in_memory`, nvcc must not carry
/// slopes to later stages in registers, which it would spill.
template <class Method, class Model, bool in_memory = false, class S>
MYRIAD_FUNCTION void explicit_rk_step(const S& t, const S& h, const S& t1, const vec<S, n_state<Model>>& y,
                                      const inputs<Model, S>& p, trial_step<Method, S, n_state<Model>>& trial) {
    using R = real_of<S>;
    constexpr auto n = n_state<Model>;
    constexpr int last = row_of<Method>::solution;
    vec<S, n> sum;
    const auto add_stage = [&](auto j) MYRIAD_LAMBDA {
        constexpr int stage = decltype(j)::value, first = first_stage<Method, last>;
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
            if constexpr (stage == first) {
                sum[c] = trial.k[stage][c];
            } else if constexpr (stage > first) {
                detail::add_weighted<Method, last, stage>(sum[c], trial.k[stage][c]);
            }
        }
    };
    if constexpr (!Method::first_same_as_last) add_stage(constant_index<0>{});
    static_for<1, Method::stages>([&](auto i) MYRIAD_LAMBDA {
        constexpr int stage = decltype(i)::value;
        constexpr bool at_end = Method::first_same_as_last && stage == last - 1;
        // Of constant lags, as stages at one time see the same.
        constexpr bool past_is_set = [] {
            if constexpr (has_delays<Model> && stage > 1)
                return has_constant_lags<Model, S> && node<Method, stage, R> == node<Method, stage - 1, R>;
            return false;
        }();
        const auto argument = [&]() MYRIAD_LAMBDA { return detail::combine<Method, stage>(y, h, trial.k); };
        // auto, as g++ 12 crashes by the type of a vector of run-time length here
        const auto put_slopes = [&](const S& at, const auto& of) MYRIAD_LAMBDA {
            detail::put_result(trial.k[stage],
                               [&]() MYRIAD_LAMBDA { return detail::evaluate_rhs<Model, past_is_set>(at, of, p); });
        };
        if constexpr (at_end) {
            detail::put_result(trial.y, argument);
            put_slopes(t1, trial.y);
        } else if constexpr (has_delays<Model> && node<Method, stage, R> == R(1)) {
            put_slopes(t1, argument());  // the slope at the end sees the same values of the past
        } else {
            put_slopes(fma(S(detail::node_operand<Method, stage, R>()), h, t), argument());
        }
        detail::see_stage_before<Method, stage>(trial.k);
        if constexpr (in_memory) MYRIAD_MEMORY_BARRIER;
        if constexpr (!Method::first_same_as_last) add_stage(i);
    });
    if constexpr (!Method::first_same_as_last) {
        const S scale = h * S(detail::first_operand<Method, last, R>());
        MYRIAD_UNROLL_UP_TO(64, 16)
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) trial.y[c] = fma(scale, sum[c], y[c]);
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
