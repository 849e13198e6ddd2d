// SPDX-License-Identifier: MIT
// The checks of options that every call makes once.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "myriad/core/error.hpp"
#include "myriad/integrator/options.hpp"
#include "myriad/model/concepts.hpp"
#include "myriad/stepper/methods/dense.hpp"

namespace myriad {
namespace host {

inline void check_positive(const char* name, double value, const char* advice) {
    require(value > 0 && std::isfinite(value), name, " is ", value, " (must be positive and finite): ", advice);
}
inline void check_count(const char* name, std::int64_t value, std::int64_t least, std::int64_t most) {
    require(value >= least && value <= most, name, " is ", value, " (must be from ", least, " to ", most, ")");
}
inline void check_tolerance(const char* name, const per_component& t, std::size_t components) {
    require(t.size() == 1 || t.size() == components, name, " has ", t.size(), " values, but the model has ", components,
            " state components: give one value for all, or one for each");
    for (std::size_t i = 0; i < t.size(); ++i)
        check_positive(name, t[i], "give the error you accept per step, such as 1e-9");
}
inline void check_components(const std::string& what, const std::vector<int>& chosen, int count) {
    std::vector<bool> seen(static_cast<std::size_t>(count), false);
    for (const int c : chosen) {
        require(c >= 0 && c < count, what, " names component ", c, ", but the model has ", count,
                " (numbered from 0): use the model's enumerators");
        require(!seen[static_cast<std::size_t>(c)], what, " names component ", c, " twice: name each component once");
        seen[static_cast<std::size_t>(c)] = true;
    }
}

inline void check_samples(const sample_options& s, const options& o, int n_state) {
    check_components("samples.states", s.states, n_state);
    const int ways = (s.evenly != 0) + !s.times.empty() + !s.times_of_instances.empty() + (s.every != 0);
    require(ways == 1, "samples names ", ways, " of evenly, times, times_of_instances and every: choose exactly one");
    require(s.capacity > 0 && s.capacity < 2'000'000'000, "samples.capacity is ", s.capacity,
            " (must be positive): give the number of samples to keep per instance");
    require(s.from_phase >= 0 && s.from_phase < o.phases, "samples.from_phase is ", s.from_phase, ", but the call has ",
            o.phases, " phases (counted from 0): nothing would be sampled");
    require(s.minimum_spacing >= 0 && std::isfinite(s.minimum_spacing), "samples.minimum_spacing is ",
            s.minimum_spacing, " (must not be negative)");
    if (s.every != 0) {
        check_count("samples.every", s.every, 1, 2'000'000'000);
        return;
    }
    if (s.evenly != 0) check_count("samples.evenly", s.evenly, 2, 2'000'000'000);
    bool rising = true, falling = true;
    for (std::size_t k = 0; k < s.times.size(); ++k) {
        require(std::isfinite(s.times[k]), "samples.times[", k, "] is ", s.times[k], " (must be finite)");
        if (k == 0) continue;
        rising = rising && s.times[k] > s.times[k - 1];
        falling = falling && s.times[k] < s.times[k - 1];
        require(rising || falling, "samples.times are not in order at number ", k, " (", s.times[k], " after ",
                s.times[k - 1], "): give each time once, in the order in which the integration reaches them");
    }
    if (!s.times_of_instances.empty()) return;  // checked where the ensemble's size is known
    const std::int64_t wanted =
        (s.evenly != 0 ? s.evenly : static_cast<std::int64_t>(s.times.size())) * (o.phases - s.from_phase);
    require(s.capacity >= wanted, "samples.capacity is ", s.capacity, ", but the chosen times give ", wanted,
            " samples per instance in this call: raise the capacity");
}

/// Sample options without states would be ignored, which nobody wants who wrote them.
inline void check_no_samples(const sample_options& s) {
    const char* given = nullptr;
    if (s.capacity != 0) given = "capacity";
    if (s.evenly != 0) given = "evenly";
    if (!s.times.empty()) given = "times";
    if (!s.times_of_instances.empty()) given = "times_of_instances";
    if (s.every != 0) given = "every";
    if (!(s.minimum_spacing == 0)) given = "minimum_spacing";
    if (s.from_phase != 0) given = "from_phase";
    require(given == nullptr, "samples.", given,
            " is given, but samples.states names no state, so that nothing would be "
            "sampled: name the states to sample, or leave out all of samples");
}

/// What of a model, a method and a real type the options must fit.
struct option_limits {
    int n_state, n_event, n_accessory, n_integer_accessory;
    bool adaptive, samples_trajectory;
    int digits;                 ///< of the real type's mantissa
    double (*rounded)(double);  ///< a number as the real type has it

    /// Refuses numbers that turn into zero or infinity in the ensemble's real type.
    void check_kept(const char* name, double value) const {
        require(value == 0 || rounded(value) != 0, name, " is ", value,
                ", which is zero in single precision: give a larger value or use an ensemble of doubles");
        require(std::isinf(value) || std::isfinite(rounded(value)), name, " is ", value,
                ", which is infinite in single precision: give a smaller value or use an ensemble of doubles");
    }
    /// Throws `error`. One function for all models and methods, which a program would else compile for each.
    void check(const options& o) const;
};

inline void option_limits::check(const options& o) const {
    check_count("phases", o.phases, 1, 1'000'000'000);
    check_tolerance("relative_tolerance", o.relative_tolerance, static_cast<std::size_t>(n_state));
    check_tolerance("absolute_tolerance", o.absolute_tolerance, static_cast<std::size_t>(n_state));
    if (adaptive) {
        require(std::isnan(o.step) || (o.step > 0 && std::isfinite(o.step)), "step is ", o.step,
                " (must be positive and finite): give the length of the first step to try");
    } else {
        require(!std::isnan(o.step), "step is not set, but the method takes fixed steps: give options::step");
        check_positive("step", o.step, "give the length of the fixed step; the direction follows from t_end");
    }
    if (!std::isnan(o.step)) check_kept("step", o.step);
    for (std::size_t c = 0; c < o.relative_tolerance.size(); ++c)
        check_kept("relative_tolerance", o.relative_tolerance[c]);
    for (std::size_t c = 0; c < o.absolute_tolerance.size(); ++c)
        check_kept("absolute_tolerance", o.absolute_tolerance[c]);
    require(o.minimum_step >= 0 && std::isfinite(o.minimum_step), "minimum_step is ", o.minimum_step,
            " (must not be negative): give 0 for the resolution of t");
    check_kept("minimum_step", o.minimum_step);
    require(o.maximum_step > 0, "maximum_step is ", o.maximum_step, " (must be positive)");
    check_kept("maximum_step", o.maximum_step);
    require(o.minimum_step <= o.maximum_step, "minimum_step ", o.minimum_step, " is above maximum_step ",
            o.maximum_step, ": no step size is left; exchange them");
    require(o.growth_limit >= 1 && std::isfinite(o.growth_limit), "growth_limit is ", o.growth_limit,
            " (must be at least 1): give the largest factor from one step to the next, such as 5");
    require(o.shrink_limit > 0 && o.shrink_limit < 1, "shrink_limit is ", o.shrink_limit,
            " (must be between 0 and 1): give the smallest factor from one step to the next, such as 0.1");
    require(static_cast<float>(o.shrink_limit) < 1, "shrink_limit is ", o.shrink_limit,
            ", which is 1 in single precision, that of step-size control: give a smaller value, such as 0.1");
    // Fixed steps are counted in the state's own kind of number, exact up to its mantissa.
    check_count("max_steps", o.max_steps, 1, digits > 31 ? 2'000'000'000 : 16'000'000);
    require(o.events.empty() || o.events.size() == static_cast<std::size_t>(n_event), "events has ",
            o.events.size(), " entries, but the model has ", n_event,
            " event functions: give one entry for each, or none for defaults");
    for (const event_options& e : o.events) {
        check_positive("event tolerance", e.tolerance,
                       "give the |g| at which an event counts as located, such as 1e-6");
        check_kept("event tolerance", e.tolerance);
        check_count("stop_after", e.stop_after, 0, 2'000'000'000);
        const int d = static_cast<int>(e.direction);
        require(d >= -1 && d <= 1, "event direction is ", d, " (must be falling, either or rising)");
    }
    check_count("sub_samples", o.sub_samples, 1, 10'000);
    require(o.schedule <= schedule::by_cost, "schedule is ", static_cast<int>(o.schedule),
            ", which is none: choose automatic, in_order, dynamic or by_cost");
    check_count("accumulation_limit", o.accumulation_limit, 1, 1'000'000'000);
    require(o.block_size >= 0 && o.block_size <= 1024 && o.block_size % 32 == 0, "block_size is ", o.block_size,
            " (must be a multiple of 32 up to 1024, or 0 to choose by itself)");
    require(o.chunk_size >= 0, "chunk_size is ", o.chunk_size,
            " (must not be negative): give 0 for what the memory allows");
    if (!o.samples.empty()) {
        require(samples_trajectory,
                "samples are asked for, but the method has no dense output: use dense<Method>, in solve and in "
                "MYRIAD_INSTANTIATE");
        check_samples(o.samples, o, n_state);
        const std::vector<double>& times = o.samples.times;
        for (std::size_t k = 1; k < times.size(); ++k)
            require(rounded(times[k]) != rounded(times[k - 1]), "samples.times[", k, "] is ", times[k],
                    ", which is the same as the time before it in single precision: give times further apart or use an "
                    "ensemble of doubles");
    } else {
        check_no_samples(o.samples);
    }
    if (!o.record.empty()) {
        require(o.record.from_phase >= 0 && o.record.from_phase < o.phases, "record.from_phase is ",
                o.record.from_phase, ", but the call has ", o.phases,
                " phases (counted from 0): nothing would be recorded");
        check_components("record.states", o.record.states, n_state);
        check_components("record.accessories", o.record.accessories, n_accessory);
        check_components("record.integer_accessories", o.record.integer_accessories, n_integer_accessory);
    }
}

}  // namespace host

/// Checks everything about the options that does not need the ensemble's data; throws `error`.
template <class Model, class Method, class R>
void check_options(const options& o) {
    require(computes_as_written(), "this file of the program ", not_as_written);
    constexpr host::option_limits limits{n_state<Model>,
                                         n_event<Model>,
                                         n_accessory<Model>,
                                         n_integer_accessory<Model>,
                                         Method::embedded_order > 0,
                                         samples_trajectory<Method>,
                                         std::numeric_limits<R>::digits,
                                         [](double value) { return static_cast<double>(static_cast<R>(value)); }};
    limits.check(o);
}

}  // namespace myriad
