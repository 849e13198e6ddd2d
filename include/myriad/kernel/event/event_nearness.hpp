// SPDX-License-Identifier: MIT
// How near to zero event functions count as on their surface, at their event, or past it.
//
// Event location is compiled twice. Nearly always, tolerances were given, and functions are farther from zero than
// these: that is the plain kind. In the rest, rounding decides.
#pragma once

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/event/step_ends.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// For functions whose rounding errors do not matter, as the tolerances that were given are larger.
template <class Model, class R>
struct plain_nearness {
    static constexpr bool is_plain = true;

    const kernel_arguments<Model, R>& args;

    MYRIAD_FUNCTION R band(int j) const { return args.event[j].tolerance; }
    MYRIAD_FUNCTION vec<R, n_event<Model>> roundings_at_start(const step_ends<Model, R>&,
                                                              event_place<Model, R>*) const {
        return {};
    }
};

/// For any functions. It lies in memory, as few steps need it.
template <class R, extent events>
struct event_nearness {
    static constexpr bool is_plain = false;

    vec<R, events> roundings, bands, allowances;

    MYRIAD_FUNCTION R rounding(int j) const { return roundings[j]; }    ///< the rounding error at the end of the trial
    MYRIAD_FUNCTION R band(int j) const { return bands[j]; }            ///< an event is located within this
    MYRIAD_FUNCTION R allowance(int j) const { return allowances[j]; }  ///< past zero by no more is no crossing
    MYRIAD_FUNCTION R past(int j) const { return max(allowances[j], roundings[j]); }  ///< the same at the trial's end
    template <class Model>
    MYRIAD_FUNCTION vec<R, events> roundings_at_start(const step_ends<Model, R>& step,
                                                      event_place<Model, R>* place) const {
        return detail::event_roundings<Model>(step.t, step.y, step.p, place);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
