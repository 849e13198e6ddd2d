// SPDX-License-Identifier: MIT
// The checks of an ensemble's data before an integration: everything set and finite, sample times within the time
// domains, phases with a length. Nothing is checked in the loop over steps. A first pass, at memory bandwidth, only
// finds whether everything is valid; if not, a second one finds out what to report. Compiled in the library, for any
// model.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Whether an event ends a phase.
bool events_may_stop(const options& o);

/// How many phases that continue in time have a length, as far as that is known beforehand.
struct phases_left {
    std::int64_t count = std::numeric_limits<std::int64_t>::max();
    std::string why_none = {};  // set if time has reached t_end everywhere, and nothing could end a phase earlier
    std::string note = {};      // set if something could, so that this is not an error
    std::string why_no_more = {};

    /// Throws `error` if `phases` phases after those requested before would be too many.
    void require_for(std::int64_t before, std::int64_t phases) const;
};

/// Examines the current times of the first `count` instances. Finds nothing if phases begin at t_begin, or if a hook
/// writes the times. An instance may have reached its t_end as long as another has not. `endless`: something can end a
/// phase before t_end.
template <class R>
phases_left find_phases_left(const ensemble_data<R>& e, const options& o, std::int64_t count, bool endless);

/// Checks the first `count` instances: throws `error`, naming the count and the first instance, or marks the instances
/// concerned, as the options say. `endless`: something can end a phase before t_end.
template <class R>
class data_check {
public:
    data_check(ensemble_data<R>& e, const options& o, std::int64_t count, bool endless)
        : data_(e), options_(o), count_(count), endless_(o.phase_length > 0 || endless) {}

    /// The fast check: whether instances [first, first + count) are all valid, so that `run` has nothing to report.
    bool passes(std::int64_t first, std::int64_t count) const;
    /// Checks all instances.
    void run();

private:
    /// Whether values may be infinite. All may, but for states, and for a t_end that nothing else precedes.
    enum class limit { finite, end, endless };

    void check_positive_scales();
    void check(const component_label& label, const R* values, limit most = limit::finite);

    ensemble_data<R>& data_;
    const options& options_;
    std::int64_t count_;
    bool endless_;  // an infinite t_end is valid, as something else can end a phase
};
extern template class data_check<double>;
extern template class data_check<float>;

/// Sample times must lie in every instance's domain, in the direction of integration, and a domain with evenly spaced
/// samples must be finite. NaN domains, or with `mark` non-finite ones, are left to the check of the inputs.
template <class R>
void check_sample_times(const ensemble_data<R>& e, const options& o, std::int64_t count);

/// How many of the first `count` instances ended in earlier calls and were given new states or parameters since.
template <class R>
std::int64_t count_given_anew(const ensemble_data<R>& e, std::int64_t count);

/// New values for an instance that takes no further part would be ignored: throws `error`, unless the options say to
/// skip such instances.
template <class R>
void check_ended(const ensemble_data<R>& e, const options& o, std::int64_t count);

/// Whether tolerances per instance are given to a method that has none: throws `error`.
template <class R>
void check_scales(const ensemble_data<R>& e, bool method_scales);

}  // namespace myriad::host::inline MYRIAD_ABI
