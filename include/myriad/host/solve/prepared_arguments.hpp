// SPDX-License-Identifier: MIT
// Turns an ensemble and options into checked kernel arguments; solve and solver both start here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "myriad/host/checks/consistency.hpp"
#include "myriad/host/checks/event_resolution.hpp"
#include "myriad/host/checks/event_tolerances.hpp"
#include "myriad/host/checks/input_check.hpp"
#include "myriad/host/checks/jacobian_check.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/ensemble/inputs_of.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/solve/described_options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The options in the form that a kernel of the method takes.
template <class Model, class R>
void describe_options(kernel_arguments<Model, R>& a, const options& o, const method_traits& method) {
    describe_options<R>(a, n_state<Model>, n_event<Model>, o, method);
}
template <class Model, class Method, class R>
void describe_options(kernel_arguments<Model, R>& a, const options& o) {
    describe_options(a, o, traits_of<Method>);
}

/// Adds the memory that a call allocates for `size` instances, except what `there`, if not null, has from earlier
/// calls.
template <class Model, class R>
void add_memory_of_call(memory_need& need, std::int64_t size, const ensemble<Model, R>* there, const options& o,
                        const method_traits& method) {
    if (!o.record.empty()) need.add("records", record_data<R>::bytes_for(o.record, o.phases, size));
    need.add("sample times", static_cast<double>(sizeof(R) * o.samples.times_of_instances.size()));
    ensemble_access::add_memory_of_call<ensemble<Model, R>>(
        need, size, there, o, method.adaptive ? step_sizes::kept : step_sizes::fixed, method.scales_tolerances);
}

/// The arguments for an ensemble, and the memory they point to: the records, and the sample times in the ensemble's
/// real type.
template <class Model, class R>
class prepared_arguments {
public:
    /// Throws `error` if an option is invalid, or if there is not enough memory.
    prepared_arguments(ensemble<Model, R>& instances, const options& o, const method_traits& method)
        : records_(affordable(instances, o, method).record, o.phases, instances.size()),
          sample_times_(o.samples.times.begin(), o.samples.times.end()) {
        describe_options(arguments_, o, method);
        if (method.scales_tolerances) instances.tolerance_scale();  // allocates them
        ensemble_access::describe(instances, arguments_, o.counting,
                                  method.adaptive ? step_sizes::kept : step_sizes::fixed);
        records_.describe(arguments_.record);
        if (o.samples.empty()) return;
        auto& sample = arguments_.sample;
        ensemble_access::describe_samples(instances, sample, o.samples);
        sample.times = sample_times_.empty() ? nullptr : sample_times_.data();
        const auto& own = o.samples.times_of_instances;
        const auto size = static_cast<std::size_t>(instances.size());
        const std::size_t count = !own.empty() ? own.size() / size : sample_times_.size();
        sample.count = static_cast<std::int32_t>(count > 0 ? count : static_cast<std::size_t>(o.samples.evenly));
        if (!own.empty()) {
            own_times_ = component_array<R>(static_cast<int>(count), instances.size(), R(0));
            for (std::size_t i = 0; i < size; ++i)
                for (std::size_t k = 0; k < count; ++k)
                    own_times_.data()[k * size + i] = static_cast<R>(own[i * count + k]);
            sample.own_times = own_times_.data();
        }
        sample.every = static_cast<std::int32_t>(o.samples.every);
        sample.from_phase = static_cast<std::int32_t>(o.samples.from_phase);
        sample.minimum_spacing = static_cast<R>(o.samples.minimum_spacing);
    }
    prepared_arguments(const prepared_arguments&) = delete;
    prepared_arguments& operator=(const prepared_arguments&) = delete;

    kernel_arguments<Model, R>& get() { return arguments_; }
    /// Pins the memory that is not the ensemble's, for copies to and from a GPU.
    void pin(int device) {
        records_.pin(device);
        own_times_.pin(device);
    }
    phase_records<Model, R>& records() { return records_; }

private:
    /// The options, if there is enough memory for them; otherwise throws `error`.
    static const options& affordable(const ensemble<Model, R>& instances, const options& o,
                                     const method_traits& method) {
        memory_need need;
        add_memory_of_call(need, instances.size(), &instances, o, method);
        need.check(message("this call for ", instances.size(), " instances"),
                   marked_message("ask for fewer phases, components or samples at a time, or ",
                                  phrase("smaller_parts", "integrate the ensemble in smaller parts")));
        return o;
    }

    kernel_arguments<Model, R> arguments_{};
    phase_records<Model, R> records_;
    std::vector<R> sample_times_;
    component_array<R> own_times_;  // sample times of each instance
};

/// Throws `error` if an event tolerance is below what rounding can meet in most of the first `count` instances.
template <class Model, class R>
void check_event_tolerances(ensemble<Model, R>& instances, const options& o, std::int64_t count) {
    using resolution = event_resolution<Model, R>;
    if constexpr (resolution::is_known) {
        const auto evaluate = [](void* of, std::int64_t i, R* finest) {
            auto& e = *static_cast<ensemble<Model, R>*>(of);
            vec<R, n_state<Model>> start;
            for (int c = 0; c < n_state<Model>; ++c) start[c] = e.state(c)[i];
            resolution(e.t_begin_of(i), start, inputs_of(e, i)).write(finest);
        };
        check_event_tolerances<R>(ensemble_access::data(instances), o, count, {&instances, evaluate});
    }
}

/// Checks the options against the first `count` instances: sample times, event tolerances, and a model's own Jacobian
/// in builds with assertions. Throws `error`.
template <class Method, class Model, class R>
void check_uses(ensemble<Model, R>& instances, const options& o, std::int64_t count) {
    auto& data = ensemble_access::data(instances);
    check_ended(data, o, count);
    check_scales(data, scales_tolerances<Method>);
    check_sample_times(data, o, count);
    check_event_tolerances(instances, o, count);
    // As the concept of Rosenbrock methods, whose header has kernels.
    if constexpr (requires { Method::tableau().coupling; }) {
        check_jacobian_pattern(instances, count);
        check_consistency(instances, o, count);
    }
#if !defined(NDEBUG)
    check_jacobian(instances, count);
#endif
}

}  // namespace myriad::host::inline MYRIAD_ABI
