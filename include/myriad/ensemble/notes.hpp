// SPDX-License-Identifier: MIT
// What a report remarks beside the figures: tolerances that had to be raised, event tolerances that hide crossings, and
// signs of stiffness.
#pragma once

#include <cstdint>

#include "myriad/ensemble/report.hpp"
#include "myriad/ensemble/stiffness.hpp"
#include "myriad/event/resolution.hpp"
#include "myriad/integrator/options.hpp"

namespace myriad::host {

/// Remarks if a relative tolerance was below what the precision can reach.
template <class Model, class R>
void note_tolerances(report<Model, R>& r, const options& o) {
    for (std::size_t c = 0; c < o.relative_tolerance.size(); ++c) {
        if (static_cast<R>(o.relative_tolerance[c]) >= least_relative_tolerance<R>) continue;
        r.notes.push_back(message("relative_tolerance ", o.relative_tolerance[c], " is below what the precision can reach: ",
                                  least_relative_tolerance<R>, " was used"));
        return;
    }
}

/// Remarks if an event function was within its tolerance wherever it was looked at, before the call and after it, while
/// no event was located: one that never leaves its tolerance has no side to change. Not refused beforehand, as a
/// function may well begin on its surface.
template <class Model, class R>
void note_event_tolerances(report<Model, R>& r, ensemble<Model, R>& e, const options& o,
                           const functions_within_tolerance<Model>& before, std::int64_t count) {
    if (r.accepted_steps == 0 || r.located_steps > 0) return;  // nothing done, or not counted
    const auto after = find_functions_within(e, o, count, [&](std::int64_t i) { return e.t()[i]; });
    for (int j = 0; j < n_event<Model>; ++j) {
        if (!before.everywhere(j) || !after.everywhere(j)) continue;
        r.notes.push_back(message("the function of event ", j, " is within its tolerance, ", event_tolerance(o, j),
                                  ", at the start and at the end in all ", after.looked_at,
                                  " instances looked at, and no crossing was located: a function is seen to cross zero only from "
                                  "beyond its tolerance; if this one crosses, give a smaller tolerance"));
    }
}

/// Remarks if an explicit method's steps were limited by stability in half or more of the instances looked at. Runs of less
/// than 200 steps per instance are not worth a remark.
template <class Method, class Model, class R>
void note_stiffness(report<Model, R>& r, ensemble<Model, R>& e, const options& o) {
    if constexpr (Method::embedded_order > 0 && !solves_linear_systems<Method>) {
        constexpr std::int64_t worthwhile = 200;
        if (o.advice == advice::off) return;
        if (r.accepted_steps + r.rejected_steps < worthwhile * e.size()) return;
        const stiffness found = find_stiffness<Method>(e, o.maximum_step);
        if (2 * found.limited < found.looked_at || found.limited == 0) return;
        r.notes.push_back(message("stability, not accuracy, limits the step in ", found.limited, " of ", found.looked_at,
                                  " instances looked at (step times fastest rate is up to ", found.share,
                                  " of the method's limit): if the equations are stiff all along, rodas_5p takes "
                                  "far fewer steps"));
    }
}

}  // namespace myriad::host
