// SPDX-License-Identifier: MIT
// The arguments of a call, for both real types.
#include "myriad/host/solve/prepared_call.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/checks/path_check.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/options/option_checks.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

/// Steps of the past that a call keeps of each instance: as many as asked for, up to a power of two. Of fewer than
/// eight the step that is written and its ends would leave none to see.
std::int32_t history_slots(const options& o, const call_facts& facts) {
    const std::int64_t wanted = o.history_steps > 0 ? std::max<std::int64_t>(o.history_steps, 8)
                                : facts.adaptive()  ? 256
                                                    : 1024;
    return static_cast<std::int32_t>(std::bit_ceil(static_cast<std::uint64_t>(wanted)));
}

step_sizes steps_of(const call_facts& facts) { return facts.adaptive() ? step_sizes::kept : step_sizes::fixed; }

/// The options, if there is enough memory for them; otherwise throws `error`.
template <class R>
const options& affordable(const ensemble_data<R>& data, const sample_data<R>& samples, const options& o,
                          const call_facts& facts) {
    memory_need need;
    add_memory_of_call(need, *data.shape, data.size, &data, samples.capacity > 0, o, facts);
    need.check(message("this call for ", std::int64_t{data.size}, " instances"),
               statement_of("ask for fewer phases, components or samples at a time, or ", cures::smaller_parts));
    return o;
}

}  // namespace

template <class R>
void add_memory_of_call(memory_need& need, const model_shape& shape, std::int64_t size, const ensemble_data<R>* there,
                        bool has_samples, const options& o, const call_facts& facts) {
    if (!o.record.empty()) need.add("records", record_data<R>::bytes_for(o.record, o.phases, size));
    need.add("sample times", static_cast<double>(sizeof(R) * o.samples.times_of_instances.size()));
    ensemble_data<R>::add_memory_of_call(need, shape, size, there, o, steps_of(facts), facts.scales_tolerances);
    if (there == nullptr || there->history_slots == 0)
        need.add("the past of delays",
                 ensemble_data<R>::history_bytes(shape, size, history_slots(o, facts), facts.history_terms));
    if (!o.samples.empty() && !has_samples) need.add("samples", sample_data<R>::bytes_for(o.samples, size));
}

template <class R>
prepared_call<R>::prepared_call(ensemble_data<R>& data, sample_data<R>& samples, record_data<R>& records,
                                const options& o, const call_facts& facts, new_samples are)
    : data_(data) {
    records = record_data<R>(*data.shape, affordable(data, samples, o, facts).record, o.phases, data.size);
    arguments.model = data.shape;
    arrays_.resize((static_cast<std::size_t>(arguments.offsets().end) + sizeof(double) - 1) / sizeof(double));
    arguments.arrays = array<std::byte>(0);
    fill_options(o, facts);
    if (facts.scales_tolerances) data.tolerance_scales();  // allocates them
    arguments.size = data.size;
    arguments.first_index = data.first_index;
    data.fill_pointers(arguments, o.counting, steps_of(facts));
    require(data.shape->n_kept > 0 || o.history_steps == 0, named_option("history_steps"), " is ", o.history_steps,
            ", but the model has no delays, whose past would be kept", cure, "leave it out");
    data.keep_history(history_slots(o, facts), facts.history_terms);
    arguments.history = data.history_pointers();
    fill_domain();
    arguments.shared = {data.shared.data(), data.shared_integer.data()};
    fill_records(records);
    fill_samples(o.samples, samples, are);
}

template <class R>
void prepared_call<R>::fill_options(const options& o, const call_facts& facts) {
    auto& a = arguments;
    const argument_offsets<R> at = a.offsets();
    a.phases = static_cast<std::int32_t>(o.phases);
    a.phase_length = static_cast<R>(o.phase_length);
    a.phases_per_time = o.phase_length > 0 ? R(1) / a.phase_length : R(0);
    a.carry_time = o.phase_time == phase_time::carry_on || o.phase_length > 0;
    a.carry_step = o.phase_step == phase_step::carry_on;
    a.max_steps = static_cast<std::int32_t>(step_limit(o, facts.adaptive(), std::numeric_limits<R>::digits));
    a.step = static_cast<R>(std::isnan(o.step) ? 1e-2 : o.step);
    a.minimum_step = static_cast<R>(o.minimum_step);
    a.maximum_step = static_cast<R>(o.maximum_step);
    if (facts.adaptive()) a.step = std::clamp(a.step, a.minimum_step, a.maximum_step);
    if (a.model->has_diffusion) {
        const R cell = facts.adaptive()   ? static_cast<R>(cell_of_paths(data_, o, true))
                       : o.noise_step > 0 ? static_cast<R>(o.noise_step)
                                          : a.step;
        *array<path_constants<R>>(at.noise) = path_constants_of(cell, static_cast<std::uint64_t>(o.seed));
    }
    a.growth_limit = static_cast<float>(o.growth_limit);
    a.shrink_limit = static_cast<float>(o.shrink_limit);
    R* const relative = array<R>(at.relative_tolerance);
    R* const absolute = array<R>(at.absolute_tolerance);
    for (std::size_t c = 0; c < static_cast<std::size_t>(a.model->n_state); ++c) {
        relative[c] = std::max(static_cast<R>(o.relative_tolerance[c]), least_relative_tolerance<R>);
        // not subnormal: a GPU takes its reciprocal
        absolute[c] = std::max(static_cast<R>(o.absolute_tolerance[c]), std::numeric_limits<R>::min());
    }
    // What an error of the smallest tolerance per step allows, and a little less, as in MATLAB's ode45.
    if (facts.adaptive() && std::isnan(o.step)) {
        const R least = *std::min_element(relative, relative + a.model->n_state);
        a.first_change = R(2) * std::pow(least, R(1) / static_cast<R>(facts.embedded_order + 1));
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(a.model->n_event); ++j) {
        const event_options e = o.events.empty() ? event_options{} : o.events[j];
        const R tolerance = static_cast<R>(e.tolerance);
        array<event_arguments<R>>(at.event)[j] = {tolerance,
                                                  tolerance > R(0) ? tolerance : std::numeric_limits<R>::infinity(),
                                                  static_cast<std::int32_t>(e.stop_after)};
        const auto asks_for = [&](direction d) { return e.direction == d || e.direction == direction::either; };
        const auto bit = std::uint32_t{1} << (j % 32);
        if (asks_for(direction::rising)) array<std::uint32_t>(at.rising)[j / 32] |= bit;
        if (asks_for(direction::falling)) array<std::uint32_t>(at.falling)[j / 32] |= bit;
    }
    a.sub_samples = static_cast<std::int32_t>(o.sub_samples);
    a.accumulation_limit = static_cast<std::int32_t>(o.accumulation_limit);
}

namespace {

/// Writes the columns of so many components, which are -1 where there are none.
void put_columns(std::int16_t* to, const std::vector<std::int16_t>& columns, int count) {
    for (int c = 0; c < count; ++c) to[c] = columns.empty() ? std::int16_t{-1} : columns[static_cast<std::size_t>(c)];
}

}  // namespace

template <class R>
void prepared_call<R>::fill_records(record_data<R>& from) {
    const model_numbers& m = *arguments.model;
    const argument_offsets<R> at = arguments.offsets();
    arguments.record = {from.values.data(), from.integers.data(), static_cast<std::int32_t>(from.from_phase),
                        static_cast<std::int32_t>(std::int64_t{from.phases}), from.time};
    arguments.record_columns = from.values.components();
    arguments.integer_record_columns = from.integers.components();
#define MYRIAD_PUT_COLUMNS(kind, ...) put_columns(array<std::int16_t>(at.kind##_column), from.kind, m.n_##kind);
    MYRIAD_RECORDED_KINDS(MYRIAD_PUT_COLUMNS)
#undef MYRIAD_PUT_COLUMNS
}

template <class R>
void prepared_call<R>::fill_samples(const sample_options& o, sample_data<R>& samples, new_samples are) {
    std::int16_t* const columns = array<std::int16_t>(arguments.offsets().sample_column);
    put_columns(columns, {}, arguments.model->n_state);
    if (o.empty()) return;
    if (samples.capacity == 0) {
        samples = sample_data<R>(arguments.model->n_state, o, data_.size);
        if (are == new_samples::cleared) samples.clear();
    }
    if (data_.pinned()) samples.pin(data_.pinned_for);
    require(o.capacity == samples.capacity && o.states == samples.chosen, named_option("samples"),
            " has other states or another capacity (", o.capacity, ") than the existing samples (",
            std::int64_t{samples.capacity}, ")", cure, "use the same in all calls, or a new ensemble");
    put_columns(columns, samples.column, arguments.model->n_state);
    arguments.sample_columns = samples.values.components();
    auto& s = arguments.sample;
    s.time = samples.time.data();
    s.values = samples.values.data();
    s.stored = samples.stored.data();
    s.capacity = static_cast<std::int32_t>(std::int64_t{samples.capacity});
    sample_times_.assign(o.times.begin(), o.times.end());
    s.times = sample_times_.empty() ? nullptr : sample_times_.data();
    const auto& own = o.times_of_instances;
    const auto size = static_cast<std::size_t>(std::int64_t{data_.size});
    const std::size_t count = !own.empty() ? own.size() / size : sample_times_.size();
    s.count = static_cast<std::int32_t>(count > 0 ? count : static_cast<std::size_t>(o.evenly));
    if (!own.empty()) {
        own_times_ = component_array<R>(static_cast<int>(count), data_.size, R(0));
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t k = 0; k < count; ++k)
                own_times_.data()[k * size + i] = static_cast<R>(own[i * count + k]);
        s.own_times = own_times_.data();
    }
    s.every = static_cast<std::int32_t>(o.every);
    s.from_phase = static_cast<std::int32_t>(o.from_phase);
    s.minimum_spacing = static_cast<R>(o.minimum_spacing);
}

template <class R>
void prepared_call<R>::fill_domain() {
    data_.fill_domain(arguments);
    arguments.common_t_begin = data_.common_begin;
    arguments.common_t_end = data_.common_end;
}

template void add_memory_of_call(memory_need&, const model_shape&, std::int64_t, const ensemble_data<double>*, bool,
                                 const options&, const call_facts&);
template void add_memory_of_call(memory_need&, const model_shape&, std::int64_t, const ensemble_data<float>*, bool,
                                 const options&, const call_facts&);
template class prepared_call<double>;
template class prepared_call<float>;

}  // namespace myriad::host::inline MYRIAD_ABI
