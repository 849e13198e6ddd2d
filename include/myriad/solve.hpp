// SPDX-License-Identifier: MIT
// The one-shot call: checks everything once, hands the ensemble to the device's backend, reports.
#pragma once

#include <algorithm>
#include <chrono>
#include <exception>
#include <type_traits>

#include "myriad/backend.hpp"
#include "myriad/device.hpp"
#include "myriad/ensemble/ensemble.hpp"
#include "myriad/ensemble/report.hpp"
#include "myriad/integrator/options.hpp"

namespace myriad {
namespace host {

/// The first value of a component that is not finite, as a message about it, or an empty one. `allow_infinite`: for t_end.
template <class Model, class R>
class input_check {
public:
    input_check(ensemble<Model, R>& e, const options& o) : ensemble_(e), options_(o) {}

    void run() {
        for (int c = 0; c < n_shared<Model>; ++c)
            require(std::isfinite(ensemble_.shared(c)), "shared parameter ", c, " is ", ensemble_.shared(c),
                    std::isnan(ensemble_.shared(c)) ? " (never set, or NaN)" : "",
                    ": set it with ensemble.shared(...) before solving");
        for (int c = 0; c < n_state<Model>; ++c) check("state", c, ensemble_.state(c).data(), false);
        for (int c = 0; c < n_parameter<Model>; ++c) check("parameter", c, ensemble_.parameter(c).data(), false);
        check("t_begin", no_component, ensemble_.t_begin().data(), false);
        check("t_end", endless, ensemble_.t_end().data(), may_be_endless());
    }

private:
    static constexpr int no_component = -1, endless = -2;

    /// An infinite t_end is fine where something else can end a phase.
    bool may_be_endless() const {
        if constexpr (has_after_step<Model> || has_after_event<Model> || writes_time_domain<Model>) return true;
        for (const event_options& e : options_.events)
            if (e.stop_after > 0) return true;
        return false;
    }

    void check(const char* what, int component, const R* values, bool allow_infinite) {
        std::int64_t bad = 0, first = -1;
        for (std::int64_t i = 0; i < ensemble_.size(); ++i) {
            if (std::isfinite(values[i]) || (allow_infinite && std::isinf(values[i])) || ensemble_.ended(i)) continue;
            if (options_.invalid_instances == invalid_instances::mark) {
                ensemble_.mark_invalid(i);
            } else {
                if (first < 0) first = i;
                ++bad;
            }
        }
        if (bad == 0) return;
        const std::string name = component < 0 ? std::string(what) : message(what, ' ', component);
        if (bad == ensemble_.size() && std::isnan(values[first]))
            throw error(message(name, " is NaN in all ", bad, " instances: it was never set; set it with ensemble.",
                                component < 0 ? message(what, "()") : message(what, "(", component, ")"),
                                " = ... before solving"));
        const char* advice = std::isinf(values[first]) && component == endless
                                 ? ": an infinite time needs an event with stop_after, or a hook, that ends the phase"
                                 : ": correct the inputs, or set invalid_instances = invalid_instances::mark to run the others";
        throw error(message(name, " is not finite in ", bad, " of ", ensemble_.size(), " instances, first in instance ",
                            first, " (", values[first], ")", advice));
    }

    ensemble<Model, R>& ensemble_;
    const options& options_;
};

/// The options as the kernel wants them.
template <class Model, class R>
kernel_arguments<Model, R> arguments_of(const options& o) {
    kernel_arguments<Model, R> a{};
    a.phases = static_cast<std::int32_t>(o.phases);
    a.carry_time = o.phase_time == phase_time::carry_on;
    a.carry_step = o.phase_step == phase_step::carry_on;
    a.max_steps = static_cast<std::int32_t>(o.max_steps);
    a.step = static_cast<R>(std::isnan(o.step) ? std::min(1e-2, o.maximum_step) : o.step);
    a.minimum_step = static_cast<R>(o.minimum_step);
    a.maximum_step = static_cast<R>(o.maximum_step);
    a.growth_limit = static_cast<R>(o.growth_limit);
    a.shrink_limit = static_cast<R>(o.shrink_limit);
    for (std::size_t c = 0; c < static_cast<std::size_t>(n_state<Model>); ++c) {
        a.relative_tolerance[c] = static_cast<R>(o.relative_tolerance[c]);
        a.absolute_tolerance[c] = static_cast<R>(o.absolute_tolerance[c]);
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(n_event<Model>); ++j) {
        const event_options e = o.events.empty() ? event_options{} : o.events[j];
        a.event[j] = {static_cast<R>(static_cast<int>(e.direction)), static_cast<R>(e.tolerance),
                      static_cast<std::int32_t>(e.stop_after)};
    }
    a.sub_samples = static_cast<std::int32_t>(o.sub_samples);
    a.accumulation_limit = static_cast<std::int32_t>(o.accumulation_limit);
    return a;
}

/// Sample times must lie in every instance's domain, in the direction in which it is passed, and a domain on which they
/// are spaced evenly must be finite. Domains that are not numbers are left to the check of the inputs.
template <class Model, class R>
void check_sample_times(const ensemble<Model, R>& e, const sample_options& samples) {
    if (samples.every != 0) return;
    const std::vector<double>& times = samples.times;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        const auto begin = static_cast<double>(e.t_begin()[i]), end = static_cast<double>(e.t_end()[i]);
        if (e.ended(i) || std::isnan(begin) || std::isnan(end)) continue;
        if (times.empty()) {
            require(std::isfinite(end - begin), "samples.evenly divides the domain, but instance ", i, " is integrated from ",
                    begin, " to ", end, ": give samples.times, or a finite t_end");
            continue;
        }
        const double from = times.front(), to = times.back();
        const bool inside = end >= begin ? begin <= from && from <= to && to <= end : begin >= from && from >= to && to >= end;
        require(inside, "samples.times go from ", from, " to ", to, ", but instance ", i, " is integrated from ", begin, " to ",
                end, ": give times within the domain, in the order in which the integration reaches them");
    }
}

/// Forwards progress from a backend, which must not see exceptions, to the user's function, which may throw.
struct progress_relay {
    const std::function<void(std::int64_t, std::int64_t)>& function;
    std::int64_t total;
    std::exception_ptr failure;

    static void call(void* context, std::int64_t begun) {
        auto& relay = *static_cast<progress_relay*>(context);
        if (relay.failure) return;
        try {
            relay.function(begun, relay.total);
        } catch (...) {
            relay.failure = std::current_exception();
        }
    }
};

template <class Model, class R>
void total_work(const ensemble<Model, R>& e, report<Model, R>& r, int sign) {
    if (!e.counted()) return;
    r.accepted_steps += sign * e.accepted_steps().sum();
    r.rejected_steps += sign * e.rejected_steps().sum();
    r.located_steps += sign * e.located_steps().sum();
    r.rhs_evaluations += sign * e.rhs_evaluations().sum();
}

template <class Model, class R>
void summarise(const ensemble<Model, R>& e, report<Model, R>& r) {
    r.instances = e.size();
    for (std::int64_t i = 0; i < e.size(); ++i) {
        const status s = e.statuses()[i];
        ++r.by_status[static_cast<std::size_t>(s)];
        if (r.first_failed >= 0 || !is_failure(s)) continue;
        r.first_failed = i;
        r.first_status = s;
        r.first_t = e.t()[i];
        r.first_t_begin = e.t_begin()[i];
        r.first_t_end = e.t_end()[i];
        for (int c = 0; c < n_state<Model>; ++c) r.first_state.push_back(e.state(c)[i]);
        for (int c = 0; c < n_parameter<Model>; ++c) r.first_parameter.push_back(e.parameter(c)[i]);
    }
}

}  // namespace host

/// Takes every instance of the ensemble through `options.phases` integration phases with the given method, in place, and
/// reports. A further call goes on from there with the next phases; instances that failed or ended themselves stay as
/// they are until `ensemble::restart`. The result of an instance depends on nothing but its own data and the options.
/// Throws `error` before any work if an input is invalid, or if the program has no kernel for the model and method.
template <class Method, class Model, class R>
report<Model, R> solve(const device& where, ensemble<Model, R>& instances, const options& options = {}) {
    check_options<Model, Method, R>(options, n_state<Model>, n_event<Model>, n_accessory<Model>,
                                    n_integer_accessory<Model>);
    auto* kernel = &openmp::run<Model, Method, R>;
    asm("" : "+r"(kernel));  // else g++ takes the address of any template for not null, a weak one too
    require(kernel != nullptr,
            "this model was not instantiated for this method and real type, or its source file was not linked: write "
            "MYRIAD_INSTANTIATE(model, method) (MYRIAD_INSTANTIATE_FLOAT for float) in the model's source file, and name "
            "that file in myriad_add_models");
    if (!options.samples.empty()) host::check_sample_times(instances, options.samples);
    host::input_check<Model, R>(instances, options).run();

    report<Model, R> result;
    result.records = phase_records<Model, R>(options.record, options.phases, instances.size());
    kernel_arguments<Model, R> arguments = host::arguments_of<Model, R>(options);
    if constexpr (Method::embedded_order > 0)
        arguments.step = std::clamp(arguments.step, arguments.minimum_step, arguments.maximum_step);
    instances.describe(arguments, options.counting);
    result.records.describe(arguments.record);
    std::vector<R> sample_times(options.samples.times.begin(), options.samples.times.end());
    if (!options.samples.empty()) {
        instances.describe_samples(arguments.sample, options.samples);
        arguments.sample.times = sample_times.empty() ? nullptr : sample_times.data();
        arguments.sample.count = static_cast<std::int32_t>(sample_times.empty() ? static_cast<std::size_t>(options.samples.evenly)
                                                                                : sample_times.size());
        arguments.sample.every = static_cast<std::int32_t>(options.samples.every);
        arguments.sample.from_phase = static_cast<std::int32_t>(options.samples.from_phase);
        arguments.sample.minimum_spacing = static_cast<R>(options.samples.minimum_spacing);
    }
    if (options.counting == counting::on) host::total_work(instances, result, -1);

    host::progress_relay relay{options.progress, instances.size(), nullptr};
    run_options how;
    how.threads = where.threads();
    if (options.progress) {
        how.progress = &host::progress_relay::call;
        how.context = &relay;
    }
    const auto begin = std::chrono::steady_clock::now();
    const run_statistics used = kernel(arguments, how);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (relay.failure) std::rethrow_exception(relay.failure);

    result.lane_turns = used.lane_turns;
    result.lanes = used.lanes;
    result.threads = used.threads;
    if (options.counting == counting::on) host::total_work(instances, result, +1);
    host::summarise(instances, result);
    return result;
}

}  // namespace myriad
