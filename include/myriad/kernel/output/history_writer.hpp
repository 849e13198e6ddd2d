// SPDX-License-Identifier: MIT
// Keeps the past of models with delays: writes each committed step into the ring, as the polynomial of the method's
// interpolant. Only in kernels of such models.
#pragma once

#include "myriad/kernel/model/past.hpp"
#include "myriad/kernel/state/inside_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The coefficients of a method's own interpolant for one state, in powers of the part of the step from 0 to 1.
template <class Method, class S, extent n>
MYRIAD_FUNCTION vec<S, history_terms<Method>> interpolant_coefficients(const step_data<Method, S, n>& step, int c) {
    using R = real_of<S>;
    constexpr int degree = Method::interpolant_degree;
    vec<S, degree + 1> of;
    of[0] = step.y[c];
    if constexpr (rosenbrock_method<Method>) {
        // as rosenbrock_interpolation: y + theta ((y1 - y) + (1 - theta) bend(theta))
        constexpr int terms = dense_terms<Method>;
        static_assert(degree == terms + 1);
        for (int power = 1; power <= degree; ++power) of[power] = S(R(0));
        of[1] = step.trial.y[c] - step.y[c];
        static_for<0, terms>([&](auto term) MYRIAD_LAMBDA {
            constexpr int m = decltype(term)::value;
            const S bend = detail::sum_stages<Method, rosenbrock_row::dense, m, Method::stages>(step.trial.u, c);
            of[m + 1] = of[m + 1] + bend;
            of[m + 2] = of[m + 2] - bend;
        });
    } else {
        static_for<0, degree>([&](auto power) MYRIAD_LAMBDA {
            constexpr int m = decltype(power)::value;
            S sum = S(R(0));
            static_for<0, interpolant_stages<Method>>([&](auto i) MYRIAD_LAMBDA {
                constexpr int stage = decltype(i)::value;
                constexpr R weight = interpolant_weight<Method, stage, m, R>;
                if constexpr (weight != R(0)) sum = fma(S(weight), step.template slope<stage>()[c], sum);
            });
            of[m + 1] = step.h * sum;
        });
    }
    return of;
}

/// Looks whether the step that is about to be written in lane i begins where the one before it ended, in value and
/// slope. If not, a step of length zero lies between them, as both share what is kept there.
template <class Model, class Method, class S, extent n>
MYRIAD_FUNCTION void resume(past_view<Model, S>& past, const step_data<Method, S, n>& step, int i) {
    using R = real_of<S>;
    lane_past<Model, R>& lane = past.lane[i];
    if (!MYRIAD_UNLIKELY(lane.resumes)) return;
    lane.resumes = false;
    bool same = true;
    past.for_each_kept([&](auto place, int c) MYRIAD_LAMBDA {
        const auto close = [](R a, R b) MYRIAD_LAMBDA { return abs(a - b) <= R(64) * epsilon_of<R> * abs(b); };
        const R* const here = past.terms_of(past.step_of(i, lane.steps), place);
        same = same && close(here[0], get_lane(step.y[c], i)) &&
               close(here[past.stride], get_lane(step.trial.slope_start()[c], i));
    });
    if (team_for<Model>::all(same) || lane.begins) return;
    const R time = past.start_of(i, lane.steps);
    ++lane.steps;
    past.start_of(i, lane.steps) = time;
    lane.begins = true;
}

/// Writes steps, which see what has `accepted`, into the slot behind the last of each lane, and what is known of the
/// next one: where it begins.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void write_step(past_view<Model, S>& past, const accepted_step<Model, Method, S>& seen) {
    const auto step = seen.inside(seen.accepted);
    if constexpr (history_terms<Method> == 2)
        for_each_lane(seen.accepted, [&](int i) MYRIAD_LAMBDA { detail::resume<Model, Method, S>(past, step, i); });
    const auto next_of = [&](int i) MYRIAD_LAMBDA { return past.step_of(i, past.lane[i].steps + 1); };
    for_each_lane(seen.accepted, [&](int i) MYRIAD_LAMBDA { *next_of(i) = get_lane(seen.t1, i); });
    past.for_each_kept([&](auto place, int c) MYRIAD_LAMBDA {
        if constexpr (history_terms<Method> == 2) {
            for_each_lane(seen.accepted, [&](int i) MYRIAD_LAMBDA {
                if (past.lane[i].begins) {
                    auto* const here = past.terms_of(past.step_of(i, past.lane[i].steps), place);
                    here[0] = get_lane(step.y[c], i);
                    here[past.stride] = get_lane(step.trial.slope_start()[c], i);
                }
                auto* const there = past.terms_of(next_of(i), place);
                there[0] = get_lane(step.trial.y[c], i);
                there[past.stride] = get_lane(step.slope_end[c], i);
            });
        } else {
            const auto of = detail::interpolant_coefficients<Method>(step, c);
            for_each_lane(seen.accepted, [&](int i) MYRIAD_LAMBDA {
                auto* const here = past.terms_of(past.step_of(i, past.lane[i].steps), place);
                MYRIAD_UNROLL
                for (int power = 0; power < history_terms<Method>; ++power)
                    here[power * past.stride] = get_lane(of[power], i);
            });
        }
    });
    team_for<Model>::synchronise();  // all see what the others have written
}

/// An observer: see observers.hpp.
template <class Model, class Method, class S>
struct history_writer {
    using R = real_of<S>;
    using step_type = accepted_step<Model, Method, S>;
    static constexpr bool watches = has_delays<Model>;
    static constexpr bool changes_inputs = false;
    struct memory {};

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    memory& o;

    /// `breaking_points` begins, as stop times depend on it.
    MYRIAD_FUNCTION void begin(int) {}

    MYRIAD_FUNCTION void see(const step_type& seen) {
        if constexpr (watches) {
            if (!any(seen.accepted)) return;
            past_view<Model, S>& past = s.data.past;
            detail::write_step<Model, Method, S>(past, seen);
            for_each_lane(seen.accepted, [&](int i) MYRIAD_LAMBDA {
                ++past.lane[i].steps;
                past.lane[i].forget_before(past.oldest(i));
                past.lane[i].begins = false;
                past.lane[i].has_trial = false;
            });
            past.reached = select(seen.accepted, seen.t1, past.reached);
        }
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
