// SPDX-License-Identifier: MIT
// Refuses phases that would have no length because time continues from phase to phase and has reached t_end. Host code
// only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/model/hooks.hpp"

namespace myriad::host {

/// Whether a hook's return value can end a phase.
template <class Model, class R>
constexpr bool hooks_may_stop() {
    using one_lane = lane<Model, R>;
    if constexpr (has_generic_after_step<Model, R>) {
        if (!std::is_void_v<decltype(Model::template after_step<R>(std::declval<one_lane&>()))>) return true;
    } else if constexpr (has_after_step<Model>) {
        if (!std::is_void_v<decltype(Model::after_step(std::declval<one_lane&>()))>) return true;
    }
    if constexpr (has_after_event<Model>) {
        if (!std::is_void_v<decltype(Model::after_event(0, std::declval<one_lane&>()))>) return true;
    }
    return false;
}

/// Whether something can end a phase before t_end.
template <class Model, class R>
bool may_end_early(const options& o) {
    if constexpr (writes_time_domain<Model> || hooks_may_stop<Model, R>()) return true;
    return std::any_of(o.events.begin(), o.events.end(), [](const event_options& e) { return e.stop_after > 0; });
}

/// How many phases that continue in time have a length, as far as that is known beforehand.
struct phases_left {
    std::int64_t count = std::numeric_limits<std::int64_t>::max();
    std::string why_none = {};  // set if time has reached t_end everywhere, and nothing could end a phase earlier
    std::string note = {};      // set if something could, so that this is not an error
    std::string why_no_more = {};

    /// Throws `error` if `phases` phases after those requested before would be too many.
    void require_for(std::int64_t before, std::int64_t phases) const {
        require(why_none.empty(), why_none);
        require(phases <= count - before, "the call has ", phases, phases == 1 ? " phase" : " phases",
                before > 0 ? message(" after ", before, " since the upload") : std::string(), ", but ", why_no_more);
    }
};

/// How many intervals of the given length, counted from t_begin, there are from t to t_end; slivers due to rounding do
/// not count.
template <class R>
double intervals_left(double length, R t, R t_begin, R t_end) {
    const double along = t_end < t ? -length : length;
    const auto position = [&](R at) { return (static_cast<double>(at) - static_cast<double>(t_begin)) / along; };
    const auto slack = [&](R at) {
        const auto largest = static_cast<double>(std::max(std::abs(at), std::abs(t_begin)));
        return std::isinf(largest)
                   ? 0
                   : 1e-6 + 16 * static_cast<double>(std::numeric_limits<R>::epsilon()) * largest / length;
    };
    return std::ceil(position(t_end) - slack(t_end)) - std::floor(position(t) + slack(t));
}

/// Examines the current times of the first `count` instances. Finds nothing if phases begin at t_begin, or if a hook
/// writes the times. An instance may have reached its t_end as long as another has not.
template <class Model, class R>
phases_left find_phases_left(const ensemble<Model, R>& e, const options& o, std::int64_t count) {
    phases_left left;
    const double length = o.phase_length;
    if (writes_time_domain<Model> || (o.phase_time == phase_time::restart && length == 0)) return left;
    const bool until_the_end = !may_end_early<Model, R>(o);
    std::int64_t there = 0, on_the_way = 0;
    if (ensemble_access::untouched(e) && e.has_common_domain()) count = 1;  // all are the same
    for (std::int64_t i = 0; i < count; ++i) {
        const bool has_begun = e.phases_done()[i] > 0;
        const R t_begin = e.t_begin_of(i), t = has_begun ? e.t()[i] : t_begin, t_end = e.t_end_of(i);
        if (e.ended(i) || !std::isfinite(t_begin) || std::isnan(t_end)) continue;  // left to the check of the inputs
        if (t == t_end && (has_begun || length > 0)) {
            if (there++ == 0)
                left.why_none = message(
                    "t has reached t_end, ", t_end, " in instance ", i,
                    ", in all instances that take part, so that "
                    "phases that continue from there would have no length: give a later t_end, or call restart() "
                    "to begin again at t_begin");
            continue;
        }
        ++on_the_way;
        if (length > 0) {
            const auto from = static_cast<double>(std::max(std::abs(t), std::abs(t_begin)));
            const double far = std::max(
                from, std::min(std::abs(static_cast<double>(t_end)), from + length * static_cast<double>(o.phases)));
            const double least = 64 * static_cast<double>(std::numeric_limits<R>::epsilon()) * far;
            require(length >= least, "phase_length is ", length,
                    ", of which rounding leaves next to nothing in instance ", i, ", where |t| gets to ", far,
                    ": give phases of ", least, " or more, or shift t");
        }
        if (!until_the_end) continue;
        const double fit = length == 0 ? 1 : intervals_left(length, t, t_begin, t_end);
        if (!(fit < static_cast<double>(left.count))) continue;
        left.count = static_cast<std::int64_t>(fit);
        left.why_no_more =
            length == 0
                ? message("with phase_time::carry_on the first of them ends at t_end, ", t_end, " in instance ", i,
                          ", and nothing ends it before, so that others would have no length: give phases a length by "
                          "options::phase_length and the end of them all as t_end, or let each begin at t_begin again "
                          "(phase_time::restart), or end them by an event (stop_after)")
                : message("instance ", i, " is at t = ", t, ", from where ", left.count, " of phase_length ", length,
                          " lead to its t_end, ", t_end,
                          ", and others would have no length: give fewer phases, or a later t_end, "
                          "which may be infinite");
    }
    if (on_the_way > 0 || there == 0) left.why_none.clear();
    if (!left.why_none.empty() && !until_the_end) {
        left.note =
            "t had reached t_end in all instances that take part, so that the phases of this call had no length";
        left.why_none.clear();
    }
    return left;
}

}  // namespace myriad::host
