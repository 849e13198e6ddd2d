// SPDX-License-Identifier: MIT
// Trial steps of models with delays that see times within themselves, where a delay is shorter than the step: repeated
// with the interpolant of the trial before, until it does not change. Hairer, Norsett, Wanner, Solving ODE I, II.17.
#pragma once

#include "myriad/kernel/output/history_writer.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct trial_iteration {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto n = n_state<Model>;
    static constexpr int most = 12;
    /// Part of a tolerance by which a trial may differ from the one before.
    static constexpr double converged = 0.01;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    vec<S, n> before = {};
    int turns = 0;

    /// Whether a trial has to be taken again, in some lanes. The others' have the same bits then, as they see the same.
    MYRIAD_FUNCTION bool goes_on(const trial_step<Method, S, n>& trial, const S& t1) {
        mask open = s.running() & !detail::past_is_known(s.data);
        if (!MYRIAD_UNLIKELY(any(open))) return false;
        if (turns > 0) {
            mask same = mask(true);
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
                const S scale = fma(S(detail::relative_tolerance_of(args, c)), abs(trial.y[c]),
                                    S(detail::absolute_tolerance_of(args, c)));
                same = same & (abs(trial.y[c] - before[c]) <= S(R(converged)) * scale);
            }
            same = team_for<Model>::all(same);
            is_within(open & same);
            open = open & !detail::past_is_known(s.data);
        }
        if (!any(open) || turns == most) return false;
        ++turns;
        before = trial.y;
        show(trial, t1, open);
        s.extra_evaluations = count_where(open, s.extra_evaluations, Method::stages);
        return true;
    }
    /// Lets lookups see the trial's own interpolant, in some lanes.
    MYRIAD_FUNCTION void show(const trial_step<Method, S, n>& trial, const S& t1, const mask& lanes) const {
        s.slopes.invalidate_end();  // what is known may be that of the trial before
        const mask none = mask(false);
        detail::write_step<Model, Method, S>(s.data.past, accepted_step<Model, Method, S>{s, trial, t1, lanes, none});
        for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA {
            s.data.past.lane[i].has_trial = true;
            s.data.past.lane[i].recalled = nan_of<R>;
            s.data.past.lane[i].trouble = past_trouble::none;
        });
    }
    /// What was looked up within the trial is to be believed.
    MYRIAD_FUNCTION void is_within(const mask& lanes) const {
        for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA {
            s.data.past.lane[i].trouble &= static_cast<std::uint8_t>(~past_trouble::not_yet);
        });
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
