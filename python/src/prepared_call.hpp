// SPDX-License-Identifier: MIT
// Turns an ensemble of a model that is known by its shape, and options, into the arguments of a kernel.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "device_library.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/solve/described_options.hpp"
#include "run.hpp"

namespace myriad::python {

inline host::method_traits traits_of(const model_facts& kernel) {
    return {kernel.embedded_order > 0, kernel.embedded_order, kernel.scales_tolerances};
}
inline host::step_sizes steps_of(const host::method_traits& method) {
    return method.adaptive ? host::step_sizes::kept : host::step_sizes::fixed;
}
/// Whether something can end a phase before t_end.
inline bool may_end_early(const model_facts& kernel, const options& o) {
    return kernel.writes_time_domain || kernel.hooks_may_stop || host::events_may_stop(o);
}
/// What a call takes for `size` instances, besides what they and their samples have already.
template <class R>
void add_memory_of_call(host::memory_need& need, const host::model_shape& shape, std::int64_t size,
                        const host::ensemble_data<R>* there, bool has_samples, const options& o,
                        const model_facts& kernel) {
    if (!o.record.empty()) need.add("records", host::record_data<R>::bytes_for(o.record, o.phases, size));
    if (!o.samples.empty() && !has_samples) need.add("samples", host::sample_data<R>::bytes_for(o.samples, size));
    need.add("sample times", static_cast<double>(sizeof(R) * o.samples.times_of_instances.size()));
    const host::method_traits method = traits_of(kernel);
    host::ensemble_data<R>::add_memory_of_call(need, shape, size, there, o, steps_of(method), method.scales_tolerances);
}

/// A call's arguments, and the memory they point to besides the ensemble's.
template <class R>
class prepared_call {
public:
    prepared_call(ensemble<R>& e, const options& o, const model_facts& kernel)
        : records(affordable(e, o, kernel).record.empty()
                      ? host::record_data<R>()
                      : host::record_data<R>(*e.shape, o.record, o.phases, e.data.size)),
          shape_(e.shape), sample_times_(o.samples.times.begin(), o.samples.times.end()) {
        const named_shape& shape = *e.shape;
        arguments.shape = &shape;
        const auto states = static_cast<std::size_t>(shape.n_state);
        relative_tolerance_.resize(states);
        absolute_tolerance_.resize(states);
        events_.resize(static_cast<std::size_t>(shape.n_event));
        rising_.resize(static_cast<std::size_t>(shape.n_event / 32 + 1));
        falling_.resize(rising_.size());
        arguments.relative_tolerance = relative_tolerance_.data();
        arguments.absolute_tolerance = absolute_tolerance_.data();
        arguments.event = events_.data();
        arguments.rising = rising_.data();
        arguments.falling = falling_.data();
        const host::method_traits method = traits_of(kernel);
        host::describe_options<R>(arguments, shape.n_state, shape.n_event, o, method);
        if (method.scales_tolerances) e.data.tolerance_scales();
        arguments.size = e.data.size;
        e.data.describe(arguments, o.counting, steps_of(method));
        arguments.common_t_begin = e.data.common_begin;
        arguments.common_t_end = e.data.common_end;
        arguments.shared = {e.data.shared.data(), e.data.shared_integer.data()};
        describe_records(shape);
        describe_samples(e, o.samples);
    }
    prepared_call(const prepared_call&) = delete;
    prepared_call& operator=(const prepared_call&) = delete;

    shaped_arguments<R> arguments{};
    host::record_data<R> records;

private:
    /// The options, if there is enough memory for them; otherwise throws `error`.
    static const options& affordable(const ensemble<R>& e, const options& o, const model_facts& kernel) {
        host::memory_need need;
        add_memory_of_call<R>(need, *e.shape, e.data.size, &e.data, e.samples.capacity > 0, o, kernel);
        need.check(message("this call for ", std::int64_t{e.data.size}, " instances"),
                   "ask for fewer phases, components or samples at a time, or integrate the sweep in smaller parts");
        return o;
    }
    void describe_records(const named_shape& shape) {
        const auto columns = [](std::vector<std::int16_t>& from, int count) {
            if (from.empty()) from.assign(static_cast<std::size_t>(count), -1);
            return from.data();
        };
        auto& r = arguments.record;
        r.values = records.values.data();
        r.integers = records.integers.data();
        r.from_phase = static_cast<std::int32_t>(records.from_phase);
        r.phases = static_cast<std::int32_t>(std::int64_t{records.phases});
        r.time_column = records.time;
        r.state_column = columns(records.state, shape.n_state);
        r.accessory_column = columns(records.accessory, shape.n_accessory);
        r.integer_accessory_column = columns(records.integer_accessory, shape.n_integer_accessory);
    }
    void describe_samples(ensemble<R>& e, const sample_options& o) {
        auto& s = arguments.sample;
        no_columns_.assign(static_cast<std::size_t>(e.shape->n_state), -1);
        s.column = no_columns_.data();
        if (o.empty()) return;
        if (e.samples.capacity == 0) e.samples = host::sample_data<R>(e.shape->n_state, o, e.data.size);
        s.time = e.samples.time.data();
        s.values = e.samples.values.data();
        s.stored = e.samples.stored.data();
        s.capacity = static_cast<std::int32_t>(e.samples.capacity);
        s.column = e.samples.column.data();
        s.times = sample_times_.empty() ? nullptr : sample_times_.data();
        const auto& own = o.times_of_instances;
        const auto size = static_cast<std::size_t>(e.data.size);
        const std::size_t count = !own.empty() ? own.size() / size : sample_times_.size();
        s.count = static_cast<std::int32_t>(count > 0 ? count : static_cast<std::size_t>(o.evenly));
        if (!own.empty()) {
            own_times_ = host::component_array<R>(static_cast<int>(count), e.data.size, R(0));
            for (std::size_t i = 0; i < size; ++i)
                for (std::size_t k = 0; k < count; ++k)
                    own_times_.data()[k * size + i] = static_cast<R>(own[i * count + k]);
            s.own_times = own_times_.data();
        }
        s.every = static_cast<std::int32_t>(o.every);
        s.from_phase = static_cast<std::int32_t>(o.from_phase);
        s.minimum_spacing = static_cast<R>(o.minimum_spacing);
    }

    std::shared_ptr<const named_shape> shape_;
    std::vector<R> relative_tolerance_, absolute_tolerance_, sample_times_;
    std::vector<detail::event_arguments<R>> events_;
    std::vector<std::uint32_t> rising_, falling_;
    std::vector<std::int16_t> no_columns_;
    host::component_array<R> own_times_;
};

}  // namespace myriad::python
