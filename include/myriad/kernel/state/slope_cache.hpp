// SPDX-License-Identifier: MIT
// Known values of the slope f(t, y) at the ends of a step: at the start where it is the last of the step before, at the
// end where samples or summaries need it, for the next step.
#pragma once

#include "myriad/kernel/methods/dense.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/model/summaries.hpp"
#include "myriad/kernel/scalar/lanes.hpp"
#include "myriad/kernel/stepper/component_loop.hpp"
#include "myriad/kernel/stepper/dense_output.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The slopes of a pack. Functions that may evaluate the right-hand side take the time and data of the committed state,
/// and count evaluations beyond the stages of the trial steps.
template <class Model, class Method, class S>
class slope_cache {
public:
    using R = real_of<S>;
    using mask = mask_of<S>;
    using count = count_of<S>;
    static constexpr auto n = n_state<Model>;
    using state = vec<S, n>;
    using data = lane_data<Model, S>;

    /// Interpolants of samples and summaries may use the slope at the end of a step, which is then the first of the
    /// next.
    static constexpr bool knows_end =
        (samples_trajectory<Method> || has_summaries<Model> || has_delays<Model>)&&interpolates_with_slope_end<Method>;
    /// Slopes are kept if the last of a step is the first of the next. Else every trial evaluates its own, a repeated
    /// one too: in a pack or a warp another lane needs it anyway.
    static constexpr bool keeps_start = Method::first_same_as_last || knows_end;
    /// Within a phase too, the slope at the start may have to be evaluated again.
    static constexpr bool loses_start = !Method::first_same_as_last || has_after_step<Model> || has_events<Model> ||
                                        has_known_stops<Model> || sees_summaries<Model>;
    /// Evaluations of the right-hand side per trial step.
    static constexpr int evaluations_per_trial = keeps_start ? Method::stages - 1 : Method::stages;

    /// Discards the slope of lane i: its phase begins.
    MYRIAD_FUNCTION void reset(int i) { set_lane(start_known_, i, false); }
    /// Discards slopes after hooks changed inputs of the right-hand side.
    MYRIAD_FUNCTION void invalidate(const mask& lanes) { start_known_ = start_known_ & !lanes; }

    /// At the start of phases: enough for steps without hooks and events.
    MYRIAD_FUNCTION void begin(const mask& begun, const S& t, const data& at, count& evaluations) {
        if constexpr (keeps_start && !loses_start) renew(begun, t, at, evaluations);
    }
    /// Before a trial step.
    MYRIAD_FUNCTION void prepare(const S& t, const data& at, count& evaluations) {
        if constexpr (!keeps_start || !loses_start) return;
        if constexpr (!Method::first_same_as_last && !has_delays<Model>) {
            // In every lane, as the slope is the trial's first stage: where it was known, the result has the same bits.
            // With delays it may not have, as it may have been evaluated before the step that it looks up was written.
            const mask needed = !start_known_;
            if (!any(needed)) return;
            start_ = detail::evaluate_rhs<Model>(t, at.y, at);
            evaluations = count_where(needed, evaluations);
            start_known_ = mask(true);
        } else {
            renew(mask(true), t, at, evaluations);
        }
    }
    /// The slope at the committed state, needed in these lanes before the first trial.
    MYRIAD_FUNCTION state start(const mask& lanes, const S& t, const data& at, count& evaluations) {
        if constexpr (keeps_start) {
            renew(lanes, t, at, evaluations);
            return start_;
        } else {
            evaluations = count_where(lanes, evaluations);
            return detail::evaluate_rhs<Model>(t, at.y, at);
        }
    }
    /// The first stage of a trial step.
    MYRIAD_FUNCTION state first_stage(const S& t, const data& at) const {
        if constexpr (keeps_start) {
            return start_;
        } else {
            return detail::evaluate_rhs<Model>(t, at.y, at);
        }
    }
    /// The slope at the committed state of lane i, for inspection. It is not stored: a pack's functions may round
    /// differently from the code for one lane.
    MYRIAD_FUNCTION vec<R, n> of_lane(int i, const S& t, const data& at, count& evaluations) const {
        if constexpr (keeps_start) {
            if (get_lane(start_known_, i)) return get_lanes<R>(start_, i);
        }
        add_to_count(evaluations, i);
        if constexpr (is_pack<S>) {
            const lane_data<Model, R> p = detail::extract_lane(at, i);
            return detail::evaluate_rhs<Model>(get_lane(t, i), p.y, static_cast<const inputs<Model, R>&>(p));
        } else {
            return detail::evaluate_rhs<Model>(t, at.y, at);
        }
    }

    /// A new trial: the slope at its end is unknown.
    MYRIAD_FUNCTION void invalidate_end() {
        if constexpr (knows_end) end_known_ = mask(false);
    }
    /// The slope at the end of the trial: as far as it is known; or after evaluating it in the lanes that need it.
    MYRIAD_FUNCTION const state& end() const { return end_; }
    MYRIAD_FUNCTION const state& end(const mask& lanes, const S& t1, const state& y1, const data& at,
                                     count& evaluations) {
        mask needed = lanes;
        if constexpr (knows_end) needed = needed & !end_known_;
        if (any(needed)) {
            const state fresh = detail::evaluate_rhs<Model>(t1, y1, at);
            detail::each_component<Method, n>([&](int c)
                                                  MYRIAD_LAMBDA { end_[c] = select(needed, fresh[c], end_[c]); });
            evaluations = count_where(needed, evaluations);
            if constexpr (knows_end) end_known_ = end_known_ | needed;
        }
        return end_;
    }

    /// Commits the end of an accepted trial.
    MYRIAD_FUNCTION void accept(const mask& accepted, const trial_step<Method, S, n>& trial) {
        if constexpr (!keeps_start) return;
        if constexpr (Method::first_same_as_last) {
            detail::each_component<Method, n>(
                [&](int c) MYRIAD_LAMBDA { start_[c] = select(accepted, trial.slope_end()[c], start_[c]); });
        } else {
            start_known_ = start_known_ & !accepted;
            if constexpr (knows_end) {
                const mask known = accepted & end_known_;
                detail::each_component<Method, n>([&](int c)
                                                      MYRIAD_LAMBDA { start_[c] = select(known, end_[c], start_[c]); });
                start_known_ = start_known_ | known;
            }
        }
    }

private:
    /// Evaluates the slope at the committed state, in the lanes where it is not known.
    MYRIAD_FUNCTION void renew(const mask& lanes, const S& t, const data& at, count& evaluations) {
        const mask needed = lanes & !start_known_;
        if (!any(needed)) return;
        const state fresh = detail::evaluate_rhs<Model>(t, at.y, at);
        detail::each_component<Method, n>([&](int c)
                                              MYRIAD_LAMBDA { start_[c] = select(needed, fresh[c], start_[c]); });
        evaluations = count_where(needed, evaluations);
        start_known_ = start_known_ | needed;
    }

    state start_, end_;
    mask start_known_, end_known_;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
