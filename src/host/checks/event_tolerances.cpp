// SPDX-License-Identifier: MIT
// Refuses event tolerances that rounding cannot meet.
#include "myriad/host/checks/event_tolerances.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "myriad/host/core/error.hpp"

namespace myriad::host::inline MYRIAD_ABI {

template <class R>
void check_event_tolerances(const ensemble_data<R>& e, const options& o, std::int64_t count,
                            const single_instances<R>& of) {
    if (of.call.event_resolution == nullptr) return;
    struct doubtful {
        std::int64_t instances = 0, worst = 0;
        double least = 0;
    };
    const auto events = static_cast<std::size_t>(e.shape->n_event);
    const auto tolerance_of = [&](std::size_t j) {
        return o.events.empty() ? event_options{}.tolerance : o.events[j].tolerance;
    };
    bool any = false;
    for (std::size_t j = 0; j < events; ++j) any = any || tolerance_of(j) != 0;  // 0: as close as rounding lets it
    if (!any) return;
    std::vector<doubtful> too_fine(events);
    std::vector<R> finest(events);
    std::int64_t looked_at = 0;
    const std::int64_t stride = std::max<std::int64_t>(count / 1024, 1);
    for (std::int64_t i = 0; i < count; i += stride) {
        if (e.ended.data()[i] != 0) continue;
        ++looked_at;
        of.call.event_resolution(of.arguments, i, finest.data());
        for (std::size_t j = 0; j < events; ++j) {
            const double least = static_cast<double>(finest[j]);
            if (tolerance_of(j) == 0 || tolerance_of(j) >= least) continue;
            ++too_fine[j].instances;
            if (least > too_fine[j].least) too_fine[j] = {too_fine[j].instances, i, least};
        }
    }
    for (std::size_t j = 0; j < events; ++j)
        require(2 * too_fine[j].instances <= looked_at, "the ", named_option("events.tolerance", "tolerance"), " of ",
                message_part(part_kind::event, message("event ", j), {}, j), " is ", tolerance_of(j),
                ", but rounding changes its function by ", too_fine[j].least, " in instance ", too_fine[j].worst,
                ", and by more than the tolerance in most instances", cure,
                "raise the tolerance, leave it out for as close as "
                "t and the state resolve, scale or shift the function or t",
                std::numeric_limits<R>::digits < 53 ? statement_of(", or ", cures::use_doubles) : statement());
}

template void check_event_tolerances(const ensemble_data<double>&, const options&, std::int64_t,
                                     const single_instances<double>&);
template void check_event_tolerances(const ensemble_data<float>&, const options&, std::int64_t,
                                     const single_instances<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
