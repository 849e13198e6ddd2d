// SPDX-License-Identifier: MIT
// Runs of fixed steps without events, hooks and error estimates, and with no observer but the writer of the past.
#pragma once

#include "myriad/kernel/integrator/phase_watchdog.hpp"
#include "myriad/kernel/output/observers.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
inline constexpr bool runs_freely =
    !is_adaptive<Method> && !has_events<Model> && !has_after_step<Model> &&
    !observers<Model, Method, S>::template any_other_watches<history_writer<Model, Method, S>> &&
    !Method::first_same_as_last && (!has_delays<Model> || has_constant_lags<Model, S>);

template <class Model, class Method, class S>
struct free_run {
    using R = real_of<S>;
    using count = count_of<S>;
    using iteration_number = typename integration_state<Model, Method, S>::iteration_number;
    static constexpr auto n = n_state<Model>;
    static constexpr bool on_path = stochastic_method<Method>;
    struct nothing {};
    using cell_number = std::conditional_t<on_path, typename path_integers<S>::cell, nothing>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;

    /// Takes steps up to the first lane's last step, in registers and with one check per block. A value that is not
    /// finite stays so: a block that ends with one is undone and halved, and the ordinary step that follows finds the
    /// lane at fault. Returns `interrupted` if the source gives up.
    template <class Source>
    [[nodiscard]] MYRIAD_FUNCTION status take_steps(Source& source) {
        constexpr iteration_number longest_block = 128;
        R lane_step = R(0);
        for_each_lane(s.running(), [&](int i) MYRIAD_LAMBDA { lane_step = get_lane(s.steps.step, i); });
        const iteration_number run = steps_ahead();
        if (run < worthwhile) return status::success;
        // One step size for all lanes takes one register; lanes that differ in direction take ordinary steps.
        const S step = S(lane_step), base = s.steps.base;
        if (any(s.running() & (s.steps.step != step))) return status::success;
        status ending = status::success;
        const inputs<Model, S> p = s.data;
        vec<S, n> y = s.data.y;
        count done = s.steps.done;
        iteration_number taken = 0, block = longest_block;
        cell_number cell{};
        if constexpr (on_path) {
            if (!steps_are_cells()) return status::success;
            cell = s.steps.from.cell;
        }
        while (taken < run) {
            if constexpr (!is_pack<S>) {  // which has no other check before the end
                if (MYRIAD_UNLIKELY(taken % asks_every == 0) &&
                    phase_watchdog<Model, Method, S>{args, s}.gives_up(source, taken)) {
                    ending = status::interrupted;
                    break;
                }
            }
            block = block < run - taken ? block : run - taken;
            vec<S, n> now = y;
            cell_number ahead = cell;
            MYRIAD_UNROLL_BY(on_path ? 1 : 4)
            for (iteration_number i = 0; i < block; ++i) {
                trial_step<Method, S, n> trial;
                const S t = fma(S(done + count(static_cast<lane_of<count>>(i))), step, base);
                trial.slope_start() = detail::evaluate_rhs<Model>(t, now, p);
                if constexpr (on_path) {
                    const path_place<S> from = beginning_of(ahead), to = beginning_of(ahead + cell_number(1));
                    ahead = to.cell;
                    trial.noise = {from, to, s.steps.path, &args.noise};
                }
                detail::take_trial_step<Method, Model>(t, step, t + step, now, p, trial);
                now = trial.y;
            }
            if (MYRIAD_UNLIKELY(any(s.running() & !team_for<Model>::all(all_finite(now))))) {
                if (block == 1) break;
                block /= 2;
                continue;
            }
            y = now;
            cell = ahead;
            done = done + count(static_cast<lane_of<count>>(block));
            taken += block;
        }
        s.data.y = y;
        if constexpr (on_path) s.steps.from.cell = cell;
        fixed_stepping<Model, Method, S>{args, s}.count_steps(done - s.steps.done);
        s.iteration += taken;
        return ending;
    }

    /// The same for a model with delays, whose past is written at every step. Before a step that has a value that is
    /// not finite, or looks up what is not there, the run ends, and the ordinary step that follows deals with it.
    template <class Source>
    [[nodiscard]] MYRIAD_FUNCTION status take_steps_with_past(Source& source) {
        const iteration_number run = steps_ahead();
        if (run < worthwhile) return status::success;
        const mask_of<S> running = s.running(), none = mask_of<S>(false);
        s.slopes.prepare(s.now(), s.data, s.extra_evaluations);
        s.h = s.steps.step;
        iteration_number taken = 0;
        status ending = status::success;
        for (; taken < run; ++taken) {
            if constexpr (!is_pack<S>) {
                if (MYRIAD_UNLIKELY(taken % asks_every == 0) &&
                    phase_watchdog<Model, Method, S>{args, s}.gives_up(source, taken)) {
                    ending = status::interrupted;
                    break;
                }
            }
            const S t = s.now(), t1 = fixed_stepping<Model, Method, S>{args, s}.next_time();
            trial_step<Method, S, n> trial;
            detail::forget_trial(s.data);
            s.slopes.invalidate_end();
            trial.slope_start() = s.slopes.first_stage(t, s.data);
            detail::take_trial_step<Method, Model>(t, s.h, t1, s.data.y, s.data, trial);
            const mask_of<S> good = detail::past_is_known(s.data) & team_for<Model>::all(all_finite(trial.y));
            if (MYRIAD_UNLIKELY(any(running & !good))) break;
            typename history_writer<Model, Method, S>::memory nothing;
            history_writer<Model, Method, S>{args, s, nothing}.see({s, trial, t1, running, none});
            s.data.y = trial.y;
            s.slopes.accept(running, trial);
            fixed_stepping<Model, Method, S>{args, s}.count_steps(count(1));
        }
        s.data.t = s.now();
        s.iteration += taken;
        return ending;
    }

private:
    static constexpr iteration_number worthwhile = 4, asks_every = 1 << 14;

    /// Whether each step is a cell of the path, forwards, as it usually is. Steps that are not take most of their time
    /// for the bridge, or for many cells.
    MYRIAD_FUNCTION bool steps_are_cells() const requires on_path {
        using small = typename path_integers<S>::small;
        const mask_of<S> cells((s.steps.from.part == small(0)) & (s.steps.per_step.part == small(0)) &
                               (s.steps.per_step.cell == cell_number(1)));
        return !any(s.running() & !cells);
    }
    static MYRIAD_FUNCTION path_place<S> beginning_of(const cell_number& cell) requires on_path {
        return {cell, typename path_integers<S>::small(0)};
    }

    /// How many steps all lanes may take: not the last one of any, and not the last one before the check is due.
    MYRIAD_FUNCTION iteration_number steps_ahead() const {
        iteration_number run = phase_watchdog<Model, Method, S>{args, s}.iterations_left() - 1;
        for_each_lane(s.running(), [&](int i) MYRIAD_LAMBDA {
            const auto left = static_cast<iteration_number>(get_lane(s.steps.left, i)) - 1;
            run = left < run ? left : run;
        });
        return run;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
