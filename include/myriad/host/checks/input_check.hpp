// SPDX-License-Identifier: MIT
// The checks of an ensemble's data before an integration: everything set and finite, sample times within the time
// domains. Nothing is checked in the loop over steps. A first pass, at memory bandwidth, only finds whether everything
// is valid; if not, a second one finds out what to report.
#pragma once

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "myriad/host/checks/phase_check.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::host {

/// Whether `fine(first, last)` holds for all parts of [0, count).
template <class Fine>
bool all_parts(std::int64_t count, Fine&& fine) {
    std::atomic<bool> all_fine{true};
    in_parallel(count, 16'384, [&](std::int64_t first, std::int64_t last) {
        if (!fine(first, last)) all_fine = false;
    });
    return all_fine;
}

/// Whether no magnitude exceeds `limit`, the largest finite number or infinity; NaN does. In integers, since a sum of
/// booleans would keep the compiler from vectorising with 64-bit values: beyond the limit the addition carries into the
/// sign.
template <class R>
bool all_within(const R* values, std::int64_t count, R limit) {
    using bits = std::conditional_t<sizeof(R) == 8, std::uint64_t, std::uint32_t>;
    constexpr bits magnitude = static_cast<bits>(~bits(0)) >> 1;
    const bits to_sign = magnitude - std::bit_cast<bits>(limit);
    bits signs = 0;
    const auto look = [&](std::int64_t i) { signs |= (std::bit_cast<bits>(values[i]) & magnitude) + to_sign; };
    // Prefetches 4 KiB ahead, since one thread otherwise waits for memory most of the time.
    constexpr std::int64_t line = 64 / sizeof(R);
    constexpr std::uintptr_t ahead = 4096;
    std::int64_t done = 0;
    for (; done + line <= count; done += line) {
        // an integer address, as it may be past the end of the array
        __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(values + done) + ahead));
        for (std::int64_t i = done; i < done + line; ++i) look(i);
    }
    for (; done < count; ++done) look(done);
    return (signs & ~magnitude) == 0;
}

/// Checks the first `count` instances: throws `error`, naming the count and the first instance, or marks the instances
/// concerned, as the options say.
template <class Model, class R>
class input_check {
public:
    input_check(ensemble<Model, R>& e, const options& o, std::int64_t count)
        : ensemble_(e), options_(o), count_(count) {}

    /// The fast check: whether instances [first, first + count) are all valid, so that `run` has nothing to report.
    bool passes(std::int64_t first, std::int64_t count) const {
        const ensemble<Model, R>& e = ensemble_;
        constexpr R largest = std::numeric_limits<R>::max();
        const R latest = may_be_endless() ? std::numeric_limits<R>::infinity() : largest;
        bool fine = true;
        for (int c = 0; c < n_shared<Model>; ++c) fine = fine && std::isfinite(e.shared(c));
        const bool common_domain = e.has_common_domain();
        if (common_domain) fine = fine && std::abs(e.t_begin_of(0)) <= largest && std::abs(e.t_end_of(0)) <= latest;
        const R* const t_begin = common_domain ? nullptr : e.t_begin().data();
        const R* const t_end = common_domain ? nullptr : e.t_end().data();
        const R* const scale = ensemble_access::scales_tolerances(e) ? ensemble_.tolerance_scale().data() : nullptr;
        // One parallel loop for all arrays, because of the overhead of starting and ending one.
        return fine && all_parts(count, [&](std::int64_t begin, std::int64_t end) {
                   const auto within = [&](const R* values, R limit) {
                       return values == nullptr || all_within(values + first + begin, end - begin, limit);
                   };
                   for (int c = 0; c < n_state<Model>; ++c)
                       if (!within(e.state(c).data(), largest)) return false;
                   for (int c = 0; c < n_parameter<Model>; ++c)
                       if (!within(e.parameter(c).data(), largest)) return false;
                   if (!within(t_begin, largest) || !within(t_end, latest) || !within(scale, largest)) return false;
                   bool positive = true;
                   if (scale != nullptr)
                       for (std::int64_t i = first + begin; i < first + end; ++i) positive &= scale[i] > 0;
                   return positive;
               });
    }

    /// Checks all instances.
    void run() {
        if (passes(0, count_)) return;
        for (int c = 0; c < n_shared<Model>; ++c)
            require(std::isfinite(data_.shared(c)), shared_numbering<Model>::label(c), " is ", data_.shared(c),
                    std::isnan(data_.shared(c)) ? " (never set, or set to NaN)" : "",
                    ": set it with ensemble.shared(...) before solving");
        for (int c = 0; c < n_state<Model>; ++c) check(state_numbering<Model>::label(c), data_.state(c).data());
        for (int c = 0; c < n_parameter<Model>; ++c)
            check(parameter_numbering<Model>::label(c), data_.parameter(c).data());
        if (ensemble_access::scales_tolerances(ensemble_)) check_positive_scales();
        if (ensemble_.has_common_domain()) {
            const std::vector<R> begin(static_cast<std::size_t>(count_), ensemble_.t_begin_of(0)),
                end(static_cast<std::size_t>(count_), ensemble_.t_end_of(0));
            check({"t_begin"}, begin.data());
            check({"t_end"}, end.data(), may_be_endless() ? limit::endless : limit::end);
        } else {
            check({"t_begin"}, data_.t_begin().data());
            check({"t_end"}, data_.t_end().data(), may_be_endless() ? limit::endless : limit::end);
        }
    }

private:
    /// Whether values may be infinite: not those of states, nor a t_end that nothing else precedes, but all others.
    enum class limit { finite, end, endless };

    /// An infinite t_end is valid if something else can end a phase.
    bool may_be_endless() const { return options_.phase_length > 0 || may_end_early<Model, R>(options_); }

    void check_positive_scales() {
        check({"tolerance_scale"}, ensemble_.tolerance_scale().data());
        for (std::int64_t i = 0; i < count_; ++i) {
            if (ensemble_.ended(i) || ensemble_.tolerance_scale()[i] > 0) continue;
            require(options_.invalid_instances == invalid_instances::mark, "tolerance_scale is ",
                    ensemble_.tolerance_scale()[i], " in instance ", i,
                    " (must be positive): give 1 for the tolerances of the options");
            ensemble_access::mark_invalid(ensemble_, i);
        }
    }

    void check(const component_label& label, const R* values, limit most = limit::finite) {
        std::int64_t bad = 0, first = -1;
        for (std::int64_t i = 0; i < count_; ++i) {
            if (std::isfinite(values[i]) || (most == limit::endless && std::isinf(values[i])) || ensemble_.ended(i))
                continue;
            if (options_.invalid_instances == invalid_instances::mark) {
                ensemble_access::mark_invalid(ensemble_, i);
            } else {
                if (first < 0) first = i;
                ++bad;
            }
        }
        if (bad == 0) return;
        if (bad == count_ && std::isnan(values[first])) {
            const std::string component = label.number < 0           ? std::string()
                                          : label.enumerator.empty() ? message(label.number)
                                                                     : std::string(label.enumerator);
            throw error(message(label, " is NaN in all ", bad,
                                " instances: it was never set, or set to NaN; set it with "
                                "ensemble.",
                                label.what, '(', component, ") = ... before solving"));
        }
        const char* advice =
            std::isinf(values[first]) && most == limit::end
                ? ": an infinite time needs a phase_length, an event with stop_after, or a hook that returns "
                  "whether to end the phase"
                : ": correct the inputs, or set invalid_instances = invalid_instances::mark to run the others";
        throw error(message(label, " is not finite in ", bad, " of ", count_, " instances, first in instance ", first,
                            " (", values[first], ")", advice));
    }

    ensemble<Model, R>& ensemble_;
    const ensemble<Model, R>& data_ = ensemble_;
    const options& options_;
    std::int64_t count_;
};

/// Sample times must lie in every instance's domain, in the direction of integration, and a domain with evenly spaced
/// samples must be finite. NaN domains, or with `mark` non-finite ones, are left to the check of the inputs.
template <class Model, class R>
void check_sample_times(const ensemble<Model, R>& e, const options& o, std::int64_t count) {
    const sample_options& samples = o.samples;
    if (samples.empty() || samples.every != 0) return;
    std::vector<R> times(samples.times.begin(), samples.times.end());  // in the kernel's precision
    const std::vector<double>& own = samples.times_of_instances;
    const auto size = static_cast<std::size_t>(e.size()), per_instance = own.size() / size;
    if (!own.empty()) {
        require(own.size() % size == 0, "samples.times_of_instances has ", own.size(), " times for ", size,
                " instances: give as many for each, those of instance 0 first");
        require(samples.capacity >= static_cast<std::int64_t>(per_instance) * (o.phases - samples.from_phase),
                "samples.capacity is ", samples.capacity, ", but the chosen times give ",
                static_cast<std::int64_t>(per_instance) * (o.phases - samples.from_phase),
                " samples per instance in this call: raise the capacity");
    }
    if (own.empty()) {
        const bool common = e.has_common_domain();
        const R common_begin = e.t_begin_of(0), common_end = e.t_end_of(0);
        const R *const begin = common ? &common_begin : e.t_begin().data(), *const end =
                                                                                common ? &common_end : e.t_end().data();
        const R from = times.empty() ? R(0) : times.front(), to = times.empty() ? R(0) : times.back();
        const bool evenly = times.empty();
        if (evenly && o.phase_length > 0) return;  // then phases are divided evenly, not the domain
        const bool fine = all_parts(common ? 1 : count, [=](std::int64_t first, std::int64_t last) {
            bool all = true;
            for (std::int64_t i = first; i < last; ++i) {
                const bool forwards = (begin[i] <= from) & (from <= to) & (to <= end[i]);
                const bool backwards = (begin[i] >= from) & (from >= to) & (to >= end[i]);
                all &= evenly ? std::abs(end[i] - begin[i]) <= std::numeric_limits<R>::max() : forwards | backwards;
            }
            return all;
        });
        if (fine) return;
    }
    for (std::int64_t i = 0; i < count; ++i) {
        if (!own.empty()) {
            const auto first = own.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(i) * per_instance);
            times.assign(first, first + static_cast<std::ptrdiff_t>(per_instance));
            const bool falling = times.front() > times.back();
            for (std::size_t k = 1; k < times.size(); ++k)
                require(falling ? times[k] < times[k - 1] : times[k] > times[k - 1], "the sample times of instance ", i,
                        " are not in order at number ", k, " (", times[k], " after ", times[k - 1],
                        "): give each time once, in the order in which the integration reaches them");
        }
        const auto begin = static_cast<double>(e.t_begin_of(i)), end = static_cast<double>(e.t_end_of(i));
        if (e.ended(i) || std::isnan(begin) || std::isnan(end)) continue;
        if (o.invalid_instances == invalid_instances::mark && !std::isfinite(end - begin)) continue;
        if (times.empty()) {
            require(std::isfinite(end - begin), "samples.evenly divides the domain, but instance ", i,
                    " is integrated from ", begin, " to ", end, ": give samples.times, or a finite t_end");
            continue;
        }
        const auto from = static_cast<double>(times.front()), to = static_cast<double>(times.back());
        const bool inside =
            end >= begin ? begin <= from && from <= to && to <= end : begin >= from && from >= to && to >= end;
        require(inside, own.empty() ? "samples.times go from " : "samples.times_of_instances go from ", from, " to ",
                to, ", but instance ", i, " is integrated from ", begin, " to ", end,
                ": give times within the domain, in the order in which the integration reaches them");
    }
}

}  // namespace myriad::host
