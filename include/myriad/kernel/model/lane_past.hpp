// SPDX-License-Identifier: MIT
// What a lane keeps of its past besides the ring: how many steps there are, which of them may be seen, and the step
// that each delayed value saw last.
#pragma once

#include <cstdint>
#include <limits>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/delay_loop.hpp"
#include "myriad/kernel/model/past_layout.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {
template <class Model, class S>
struct inputs;
}

namespace myriad::detail::inline MYRIAD_TARGET {

/// Whether lags depend on parameters and shared values alone: `lag(j, p)`. The jumps of the past then arrive at times
/// that are known.
template <class Model, class S>
concept has_constant_lags = has_delays<Model> && requires(const inputs<Model, S>& p) {
    Model::template lag<S>(0, p);
};

/// The same, where it is only known when the model runs.
template <class Model, class R>
MYRIAD_FUNCTION bool lags_are_constant() {
    if constexpr (gives_tables_of_past<Model>) {
        return Model::lags_are_constant();
    } else {
        return has_constant_lags<Model, R>;
    }
}

/// Why a lookup of a trial step is not to be believed.
struct past_trouble {
    static constexpr std::uint8_t none = 0;
    static constexpr std::uint8_t not_yet = 1;  // a time that the steps have not reached
    static constexpr std::uint8_t lost = 2;     // one that the ring no longer has
    static constexpr std::uint8_t invalid = 4;  // the lag is negative or not a number
};

/// The step that a delayed value saw last, so that the next lookup in it reads little or nothing of the ring.
template <class R>
struct seen_step {
    std::int32_t number;         // -1: what was before the beginning
    R start, end, per_length;    // its times; none lies between them once it is forgotten, nor in a trial
    R linear, quadratic, cubic;  // of the cubic polynomial
    R value;                     // at its start; before the beginning everywhere

    MYRIAD_FUNCTION void forget() {
        start = infinity_of<R>;
        end = -infinity_of<R>;
    }
    MYRIAD_FUNCTION bool has(R time) const { return (time >= start) & (time < end); }
};

/// Of a thread of a team: where the states of its units are among those kept, -1 for others, and those that its delayed
/// values are of.
template <class Model, bool of_team = team_size<Model> != 1>
struct places_of_thread {};
template <class Model>
struct places_of_thread<Model, true> {
    std::int32_t own[n_state<Model>], delayed[n_delayed<Model>];

    MYRIAD_FUNCTION void find() {
        using part = as_part<Model>;
        const auto& places = kept_places_of_states<whole_of<Model>>.place;
        component_loop_of_part<Model>::template range<0, n_state<Model>>(
            [&](auto c) MYRIAD_LAMBDA { own[c] = part::is_own_state(c) ? places[part::whole_state(c)] : -1; });
        detail::for_each_delayed<Model>([&](auto j) MYRIAD_LAMBDA { delayed[j] = places[part::state_of_delayed(j)]; });
    }
};

/// The past of one lane. Steps are numbered from the beginning; step k is in slot k modulo their number.
template <class Model, class R>
struct lane_past : places_of_thread<Model> {
    static constexpr auto values = n_delayed<Model>, lags = n_lag<Model>;
    static constexpr std::int32_t none = std::numeric_limits<std::int32_t>::max();

    std::int64_t instance;
    std::int32_t steps;              // stored so far
    bool begins;                     // the next begins anew: what it begins with is not the end of the one before
    bool resumes;                    // it may: a phase has begun, or a hook has changed something
    bool has_trial;                  // the one after them holds the trial that is iterated
    vec<std::int32_t, lags> from;    // of each lag: the first step that may be seen now; -1: what was before
    vec<std::int32_t, lags> before;  // and the first that must not be seen yet, a jump; or none
    mutable vec<seen_step<R>, values> seen;
    mutable R recalled;  // the time of the functions that saw all values last, if lags are constant; or NaN
    mutable std::uint8_t trouble;

    /// What may be seen has changed, of all delayed values or of those with lag g.
    MYRIAD_FUNCTION void forget() const {
        recalled = nan_of<R>;
        detail::for_each_delayed<Model>([&](auto j) MYRIAD_LAMBDA { seen[j].forget(); });
    }
    template <class G>
    MYRIAD_FUNCTION void forget_lag(G g) const {
        recalled = nan_of<R>;
        detail::for_each_delayed<Model>([&](auto j) MYRIAD_LAMBDA {
            if (number_of_lag<Model>(j) == g) seen[j].forget();
        });
    }
    /// The ring has lost the steps before this one.
    MYRIAD_FUNCTION void forget_before(std::int32_t oldest) const {
        detail::for_each_delayed<Model>([&](auto j) MYRIAD_LAMBDA {
            if (seen[j].number >= 0 && seen[j].number < oldest) seen[j].forget();
        });
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
