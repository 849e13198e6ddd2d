// SPDX-License-Identifier: MIT
// The checks of an ensemble's data, for both real types.
#include "myriad/host/checks/data_check.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "myriad/host/core/error.hpp"
#include "myriad/host/report/status_names.hpp"
#include "myriad/host/threads/parallel.hpp"

namespace myriad::host::inline MYRIAD_ABI {

bool events_may_stop(const options& o) {
    return std::any_of(o.events.begin(), o.events.end(), [](const event_options& e) { return e.stop_after > 0; });
}

void phases_left::require_for(std::int64_t before, std::int64_t phases) const {
    require(why_none.empty(), why_none);
    require(phases <= count - before, "the call has ", phases, phases == 1 ? " phase" : " phases",
            before > 0 ? message(" after ", before, " since the upload") : std::string(), ", but ", why_no_more);
}

namespace {

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

}  // namespace

template <class R>
phases_left find_phases_left(const ensemble_data<R>& e, const options& o, std::int64_t count, bool endless) {
    phases_left left;
    const double length = o.phase_length;
    if (e.shape->writes_time_domain || (o.phase_time == phase_time::restart && length == 0)) return left;
    const bool until_the_end = !endless;
    std::int64_t there = 0, on_the_way = 0;
    if (e.untouched && e.has_common_domain()) count = 1;  // all are the same
    for (std::int64_t i = 0; i < count; ++i) {
        const bool has_begun = e.phase.data()[i] > 0;
        const R t_begin = e.t_begin_of(i), t = has_begun ? e.t.data()[i] : t_begin, t_end = e.t_end_of(i);
        if (e.ended.data()[i] != 0 || !std::isfinite(t_begin) || std::isnan(t_end))
            continue;  // left to the check of the inputs
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
            require(length >= least, named_option("phase_length"), " is ", length,
                    ", of which rounding leaves next to nothing in instance ", i, ", where |t| gets to ", far, cure,
                    "give phases of ", least, " or more, or shift t");
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

template phases_left find_phases_left(const ensemble_data<double>&, const options&, std::int64_t, bool);
template phases_left find_phases_left(const ensemble_data<float>&, const options&, std::int64_t, bool);

namespace {

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

}  // namespace

template <class R>
bool data_check<R>::passes(std::int64_t first, std::int64_t count) const {
    const ensemble_data<R>& e = data_;
    const model_shape& shape = *e.shape;
    constexpr R largest = std::numeric_limits<R>::max();
    const R latest = endless_ ? std::numeric_limits<R>::infinity() : largest;
    bool fine = true;
    for (int c = 0; c < shape.n_shared; ++c) fine = fine && std::isfinite(e.shared.data()[c]);
    const bool common_domain = e.has_common_domain();
    if (common_domain) fine = fine && std::abs(e.t_begin_of(0)) <= largest && std::abs(e.t_end_of(0)) <= latest;
    const R* const t_begin = e.t_begin.data();
    const R* const t_end = e.t_end.data();
    const R* const scale = e.tolerance_scale.data();
    // One parallel loop for all arrays, because of the overhead of starting and ending one.
    return fine && all_parts(count, [&](std::int64_t begin, std::int64_t end) {
               const auto within = [&](const R* values, R limit) {
                   return values == nullptr || all_within(values + first + begin, end - begin, limit);
               };
               for (int c = 0; c < shape.n_state; ++c)
                   if (!within(e.state.component(c), largest)) return false;
               for (int c = 0; c < shape.n_parameter; ++c)
                   if (!within(e.parameter.component(c), largest)) return false;
               if (!within(t_begin, largest) || !within(t_end, latest) || !within(scale, largest)) return false;
               bool positive = true;
               if (scale != nullptr)
                   for (std::int64_t i = first + begin; i < first + end; ++i) positive &= scale[i] > 0;
               return positive;
           });
}

template <class R>
void data_check<R>::run() {
    if (passes(0, count_)) return;
    const model_shape& shape = *data_.shape;
    for (int c = 0; c < shape.n_shared; ++c)
        require(std::isfinite(data_.shared.data()[c]), shape.shared(shape, c), " is ", data_.shared.data()[c],
                std::isnan(data_.shared.data()[c]) ? " (never set, or set to NaN)" : "", cure,
                message_part(cures::set_value, "set it with ensemble.shared(...) before solving"));
    for (int c = 0; c < shape.n_state; ++c) check(shape.state(shape, c), data_.state.component(c));
    for (int c = 0; c < shape.n_parameter; ++c) check(shape.parameter(shape, c), data_.parameter.component(c));
    if (data_.scales_tolerances()) check_positive_scales();
    if (data_.has_common_domain()) {
        const std::vector<R> begin(static_cast<std::size_t>(count_), data_.t_begin_of(0)),
            end(static_cast<std::size_t>(count_), data_.t_end_of(0));
        check({"t_begin"}, begin.data());
        check({"t_end"}, end.data(), endless_ ? limit::endless : limit::end);
    } else {
        check({"t_begin"}, data_.t_begin.data());
        check({"t_end"}, data_.t_end.data(), endless_ ? limit::endless : limit::end);
    }
}

template <class R>
void data_check<R>::check_positive_scales() {
    check({"tolerance_scale"}, data_.tolerance_scale.data());
    for (std::int64_t i = 0; i < count_; ++i) {
        if (data_.ended.data()[i] != 0 || data_.tolerance_scale.data()[i] > 0) continue;
        require(options_.invalid_instances == invalid_instances::mark, "tolerance_scale is ",
                data_.tolerance_scale.data()[i], " in instance ", i, " (must be positive)", cure,
                "give 1 for the tolerances of the options");
        data_.mark_invalid(i);
    }
}

template <class R>
void data_check<R>::check(const component_label& label, const R* values, limit most) {
    std::int64_t bad = 0, first = -1;
    for (std::int64_t i = 0; i < count_; ++i) {
        if (std::isfinite(values[i]) || (most == limit::endless && std::isinf(values[i])) || data_.ended.data()[i] != 0)
            continue;
        if (options_.invalid_instances == invalid_instances::mark) {
            data_.mark_invalid(i);
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
        const std::string advice =
            message("set it with ensemble.", label.what, '(', component, ") = ... before solving");
        refuse({label, " is NaN in all ", bad, " instances: it was never set, or set to NaN", cure_begins{"; "},
                message_part(cures::set_value, advice)});
    }
    const bool endless = std::isinf(values[first]) && most == limit::end;
    const statement advice =
        endless ? statement_of(
                      "an infinite time needs a phase_length, an event with stop_after, or a hook that "
                      "returns whether to end the phase")
                : statement_of("correct the inputs, or ", cures::mark_invalid, " to run the others");
    refuse({label, " is not finite in ", bad, " of ", count_, " instances, first in instance ", first, " (",
            values[first], ')', cure, advice});
}

namespace {

/// Times that differ by no more than this count as the same instant, as they do in kernels.
template <class R>
R same_instant(R time) {
    return R(16) * std::numeric_limits<R>::epsilon() * std::abs(time);
}

/// Sample times and the ends of a domain as texts, with so many digits that those which differ look different.
std::array<std::string, 4> told_apart(const std::array<double, 4>& times) {
    for (int digits = 9;; ++digits) {
        std::array<std::string, 4> texts;
        for (std::size_t k = 0; k < 4; ++k) {
            std::ostringstream text;
            text.precision(digits);
            text << times[k];
            texts[k] = text.str();
        }
        const bool alike =
            (texts[0] == texts[2] && times[0] != times[2]) || (texts[1] == texts[3] && times[1] != times[3]);
        if (!alike || digits >= std::numeric_limits<double>::max_digits10) return texts;
    }
}

}  // namespace

template <class R>
void check_sample_times(const ensemble_data<R>& e, const options& o, std::int64_t count) {
    const sample_options& samples = o.samples;
    if (samples.empty() || samples.every != 0) return;
    std::vector<R> times(samples.times.begin(), samples.times.end());  // in the kernel's precision
    const std::vector<double>& own = samples.times_of_instances;
    const auto size = static_cast<std::size_t>(std::int64_t{e.size}), per_instance = own.size() / size;
    if (!own.empty()) {
        require(own.size() % size == 0, named_option("samples.times_of_instances"), " has ", own.size(), " times for ",
                size, " instances", cure, "give as many for each, those of instance 0 first");
        require(samples.capacity >= static_cast<std::int64_t>(per_instance) * (o.phases - samples.from_phase),
                named_option("samples.capacity"), " is ", samples.capacity, ", but the chosen times give ",
                static_cast<std::int64_t>(per_instance) * (o.phases - samples.from_phase),
                " samples per instance in this call", cure, "raise the capacity");
    }
    if (own.empty()) {
        const bool common = e.has_common_domain();
        const R common_begin = e.t_begin_of(0), common_end = e.t_end_of(0);
        const R* const begin = common ? &common_begin : e.t_begin.data();
        const R* const end = common ? &common_end : e.t_end.data();
        const R from = times.empty() ? R(0) : times.front(), to = times.empty() ? R(0) : times.back();
        const bool evenly = times.empty();
        if (evenly && o.phase_length > 0) return;  // then phases are divided evenly, not the domain
        const bool fine = all_parts(common ? 1 : count, [=](std::int64_t first, std::int64_t last) {
            bool all = true;
            for (std::int64_t i = first; i < last; ++i) {
                const R at_begin = same_instant(begin[i]), at_end = same_instant(end[i]);
                const bool forwards = (begin[i] - at_begin <= from) & (from <= to) & (to <= end[i] + at_end);
                const bool backwards = (begin[i] + at_begin >= from) & (from >= to) & (to >= end[i] - at_end);
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
                        " are not in order at number ", k, " (", times[k], " after ", times[k - 1], ")", cure,
                        "give each time once, in the order in which the integration reaches them");
        }
        const auto begin = static_cast<double>(e.t_begin_of(i)), end = static_cast<double>(e.t_end_of(i));
        if (e.ended.data()[i] != 0 || std::isnan(begin) || std::isnan(end)) continue;
        if (o.invalid_instances == invalid_instances::mark && !std::isfinite(end - begin)) continue;
        if (times.empty()) {
            require(std::isfinite(end - begin), named_option("samples.evenly"), " divides the domain, but instance ", i,
                    " is integrated from ", begin, " to ", end, cure, "give ", named_option("samples.times"),
                    ", or a finite t_end");
            continue;
        }
        const auto from = static_cast<double>(times.front()), to = static_cast<double>(times.back());
        const double at_begin = same_instant(static_cast<R>(begin)), at_end = same_instant(static_cast<R>(end));
        const bool inside = end >= begin ? begin - at_begin <= from && from <= to && to <= end + at_end
                                         : begin + at_begin >= from && from >= to && to >= end - at_end;
        if (inside) continue;
        const auto texts = told_apart({from, to, begin, end});
        refuse({named_option(own.empty() ? "samples.times" : "samples.times_of_instances"), " go from ", texts[0],
                " to ", texts[1], ", but instance ", i, " is integrated from ", texts[2], " to ", texts[3], cure,
                "give times within the domain, in the order in which the integration reaches them"});
    }
}

template <class R>
std::int64_t count_given_anew(const ensemble_data<R>& e, std::int64_t count) {
    return std::count_if(e.ended_before.begin(), e.ended_before.end(),
                         [&](const auto& i) { return i.index < count && e.given_anew(i); });
}
template <class R>
void check_ended(const ensemble_data<R>& instances, const options& o, std::int64_t count) {
    if (o.invalid_instances == invalid_instances::mark) return;
    const std::int64_t anew = count_given_anew(instances, count);
    if (anew == 0) return;
    for (const auto& e : instances.ended_before)
        require(!instances.given_anew(e), "instance ", e.index, " ended in an earlier call (",
                name_of(instances.status_of(e.index)),
                ") and takes no further part, but its state or parameters were set anew since",
                anew == 1 ? std::string() : message(", as were those of ", anew - 1, anew == 2 ? " other" : " others"),
                cure, "call restart() to start all instances again, or ", cures::mark_invalid,
                " to leave those that have ended as they are");
}

template <class R>
void check_scales(const ensemble_data<R>& e, bool method_scales) {
    require(method_scales || !e.scales_tolerances(),
            "tolerance_scale is set, but the method has the same tolerances for all instances", cure,
            cures::scale_tolerances);
}

template class data_check<double>;
template class data_check<float>;
template void check_sample_times(const ensemble_data<double>&, const options&, std::int64_t);
template std::int64_t count_given_anew(const ensemble_data<double>&, std::int64_t);
template void check_ended(const ensemble_data<double>&, const options&, std::int64_t);
template void check_scales(const ensemble_data<double>&, bool);
template void check_sample_times(const ensemble_data<float>&, const options&, std::int64_t);
template std::int64_t count_given_anew(const ensemble_data<float>&, std::int64_t);
template void check_ended(const ensemble_data<float>&, const options&, std::int64_t);
template void check_scales(const ensemble_data<float>&, bool);

}  // namespace myriad::host::inline MYRIAD_ABI
