// SPDX-License-Identifier: MIT
// Refuses event tolerances that rounding cannot meet. Host code; it calls the model's `events` on some states.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "myriad/host/core/error.hpp"
#include "myriad/host/ensemble/inputs_of.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/scalar/dual.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// What one instance says about the resolution of event functions, in their units.
template <class Model, class R>
struct event_resolution {
    /// Rounding of the constant that a function subtracts, as 1e6 in x - 1e6: closer to zero it has no values. The
    /// constant is g - p dg/dp, exact for functions linear in p = (t, y); of others the smaller of its values at p and
    /// at zero counts, and none where that is not finite.
    vec<R, n_event<Model>> of_constant;
    /// A thousandth of the rounding of g at the start. Time advances in steps of its own rounding, and g, which gets
    /// from here to zero, in steps proportional to them; a thousandth, since it may slow down on its way.
    vec<R, n_event<Model>> of_start;

    event_resolution(ensemble<Model, R>& e, std::int64_t i) {
        const auto p = inputs_of(e, i);
        const R t = e.t_begin_of(i);
        vec<dual<R>, n_state<Model>> y;
        vec<R, n_state<Model>> origin;
        for (int c = 0; c < n_state<Model>; ++c) {
            y[c] = dual<R>(e.state(c)[i], e.state(c)[i]);
            origin[c] = R(0);
        }
        const auto g = Model::template events<dual<R>>(dual<R>(t, t), y, p);  // derivative: p dg/dp
        const auto g0 = Model::template events<R>(R(0), origin, p);
        constexpr R half_ulp = std::numeric_limits<R>::epsilon() / 2;
        for (int j = 0; j < n_event<Model>; ++j) {
            const R here = std::abs(g[j].value - g[j].derivative), there = std::abs(g0[j]);
            of_constant[j] = std::isfinite(here) && std::isfinite(there) ? half_ulp * std::min(here, there) : R(0);
            of_start[j] = std::isfinite(g[j].value) ? half_ulp * R(1e-3) * std::abs(g[j].value) : R(0);
        }
    }
};

inline double event_tolerance(const options& o, int event) {
    return o.events.empty() ? event_options{}.tolerance : o.events[static_cast<std::size_t>(event)].tolerance;
}

/// Throws `error` if an event tolerance is below the resolution of its function in most instances; in single ones,
/// whose state may be huge, crossings are located as well as rounding lets them. Looks at a thousand or so of the first
/// `count` instances, spread over them. Not for models with `initialise`, before which `events` cannot be called.
template <class Model, class R>
void check_event_tolerances(ensemble<Model, R>& e, const options& o, std::int64_t count) {
    if constexpr (has_events<Model> && !has_initialise<Model>) {
        struct {
            std::int64_t instances = 0, worst = 0;
            double least = 0;
        } too_fine[n_event<Model>];
        std::int64_t looked_at = 0;
        const auto tolerance_of = [&](int j) { return event_tolerance(o, j); };
        for_sampled_instances(e, count, [&](std::int64_t i) {
            ++looked_at;
            const event_resolution<Model, R> finest(e, i);
            for (int j = 0; j < n_event<Model>; ++j) {
                const double least = static_cast<double>(std::max(finest.of_constant[j], finest.of_start[j]));
                if (tolerance_of(j) == 0 || tolerance_of(j) >= least) continue;  // 0: as close as rounding lets it
                ++too_fine[j].instances;
                if (least > too_fine[j].least) too_fine[j] = {too_fine[j].instances, i, least};
            }
        });
        for (int j = 0; j < n_event<Model>; ++j) {
            require(
                2 * too_fine[j].instances <= looked_at, "the ", named_option("events.tolerance", "tolerance"),
                " of event ", j, " is ", tolerance_of(j), ", but rounding changes its function by ", too_fine[j].least,
                " in instance ", too_fine[j].worst,
                ", and by more than the tolerance in most instances: raise the tolerance, leave it out for as close as "
                "t and the state resolve, scale or shift the function or t",
                std::numeric_limits<R>::digits < 53
                    ? marked_message(", or ", phrase("use_doubles", "use an ensemble of doubles"))
                    : marked_text());
        }
    }
}

}  // namespace myriad::host::inline MYRIAD_ABI
