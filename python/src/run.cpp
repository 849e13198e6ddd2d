// SPDX-License-Identifier: MIT
// `solve` for models that are known only at run time, for both real types.
#include "run.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <dlfcn.h>

#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/options/option_checks.hpp"
#include "myriad/host/solve/described_options.hpp"
#include "myriad/host/solve/integrate_all.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "threads.hpp"

namespace myriad::python {

library::library(const std::string& path) {
    void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    require(handle != nullptr, "the compiled model could not be loaded: ", handle != nullptr ? "" : dlerror());
    const auto function = reinterpret_cast<kernel_library_function>(dlsym(handle, kernel_library_symbol));
    require(function != nullptr, path, " holds no compiled model");
    facts_ = *function();
    require(facts_.interface_version == interface_version, path, " was compiled for another version of Myriad");
    const auto set = static_cast<openmp::instruction_set>(facts_.instruction_set);
    require(host::cpu_has(set), "the model was compiled for ", host::name_of(set), ", which this CPU lacks");
}

library::library(const std::string& method, int shared, int shared_integers, bool may_stop,
                 std::shared_ptr<const interpreted> model)
    : facts_(interpreter(method)), model_(std::move(model)) {
    facts_.n_shared = shared;
    facts_.n_shared_integer = shared_integers;
    facts_.hooks_may_stop = may_stop;
    const auto set = static_cast<openmp::instruction_set>(facts_.instruction_set);
    require(host::cpu_has(set), "this CPU lacks the instructions of ", host::name_of(set),
            ", for which models are interpreted: install a C++ compiler");
}

namespace {

template <std::vector<std::string> component_names::*which>
host::component_label label(const host::model_shape& shape, int c, std::string_view what) {
    return {what, c, (static_cast<const named_shape&>(shape).names.*which)[static_cast<std::size_t>(c)]};
}

}  // namespace

named_shape::named_shape(const kernel_library& of, component_names its_names)
    : model_shape{
          of.n_state,
          of.n_parameter,
          of.n_shared,
          of.n_shared_integer,
          of.n_accessory,
          of.n_integer_accessory,
          of.n_event,
          of.writes_parameters,
          of.writes_time_domain,
          [](const model_shape& s, int c) { return label<&component_names::states>(s, c, "state"); },
          [](const model_shape& s, int c) { return label<&component_names::parameters>(s, c, "parameter"); },
          [](const model_shape& s, int c) { return label<&component_names::shared>(s, c, "shared parameter"); }},
      names(std::move(its_names)) {
    const auto check = [](const std::vector<std::string>& named, int count, const char* what) {
        require(static_cast<int>(named.size()) == count, "the model has ", count, " components of kind ", what,
                ", and ", named.size(), " names are given");
    };
    check(names.states, n_state, "state");
    check(names.parameters, n_parameter, "parameter");
    check(names.shared, n_shared, "shared");
    check(names.shared_integers, n_shared_integer, "shared integer");
    check(names.accessories, n_accessory, "accessory");
    check(names.integer_accessories, n_integer_accessory, "integer accessory");
    check(names.events, n_event, "event");
}

namespace {

template <class R>
double rounded(double value) {
    return static_cast<double>(static_cast<R>(value));
}

host::method_traits traits_of(const kernel_library& kernel) {
    return {kernel.embedded_order > 0, kernel.scales_tolerances, kernel.chooses_first_step};
}
host::step_sizes steps_of(const host::method_traits& method) {
    return method.adaptive ? host::step_sizes::kept : host::step_sizes::fixed;
}
/// What a call takes for `size` instances, besides what they and their samples have already.
template <class R>
void add_memory_of_call(host::memory_need& need, const host::model_shape& shape, std::int64_t size,
                        const host::ensemble_data<R>* there, bool has_samples, const options& o,
                        const kernel_library& kernel) {
    if (!o.record.empty()) need.add("records", host::record_data<R>::bytes_for(o.record, o.phases, size));
    if (!o.samples.empty() && !has_samples) need.add("samples", host::sample_data<R>::bytes_for(o.samples, size));
    need.add("sample times", static_cast<double>(sizeof(R) * o.samples.times_of_instances.size()));
    const host::method_traits method = traits_of(kernel);
    host::ensemble_data<R>::add_memory_of_call(need, shape, size, there, o, steps_of(method), method.scales_tolerances);
}

}  // namespace

template <class R>
void check_options(const named_shape& shape, const kernel_library& kernel, const options& o) {
    const host::model_components components{{shape.n_state, "state"},
                                            {shape.n_accessory, "accessory"},
                                            {shape.n_integer_accessory, "integer accessory"},
                                            {}};
    const host::option_limits limits{components,
                                     shape.n_event,
                                     shape.writes_time_domain,
                                     kernel.embedded_order > 0,
                                     kernel.samples_trajectory,
                                     std::numeric_limits<R>::digits,
                                     &rounded<R>};
    limits.check(o);
}
template void check_options<double>(const named_shape&, const kernel_library&, const options&);
template void check_options<float>(const named_shape&, const kernel_library&, const options&);

template <class R>
double bytes_per_instance(const named_shape& shape, const kernel_library& kernel, const options& o) {
    host::memory_need need = host::ensemble_data<R>::memory_of(shape, 1);
    add_memory_of_call<R>(need, shape, 1, nullptr, false, o, kernel);
    return need.bytes();
}
template double bytes_per_instance<double>(const named_shape&, const kernel_library&, const options&);
template double bytes_per_instance<float>(const named_shape&, const kernel_library&, const options&);

namespace {

/// A call's arguments, and the memory they point to besides the ensemble's.
template <class R>
class prepared_call {
public:
    prepared_call(ensemble<R>& e, const options& o, const kernel_library& kernel)
        : records(affordable(e, o, kernel).record.empty()
                      ? host::record_data<R>()
                      : host::record_data<R>(*e.shape, o.record, o.phases, e.data.size)),
          sample_times_(o.samples.times.begin(), o.samples.times.end()) {
        const named_shape& shape = *e.shape;
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

    any_arguments<R> arguments{};
    host::record_data<R> records;

private:
    /// The options, if there is enough memory for them; otherwise throws `error`.
    static const options& affordable(const ensemble<R>& e, const options& o, const kernel_library& kernel) {
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

    std::vector<R> relative_tolerance_, absolute_tolerance_, sample_times_;
    std::vector<detail::event_arguments<R>> events_;
    std::vector<std::uint32_t> rising_, falling_;
    std::vector<std::int16_t> no_columns_;
    host::component_array<R> own_times_;
};

/// The components of a kind that the model has; those that an interpreter has besides are called unused.
std::size_t used(const std::vector<std::string>& names) {
    return static_cast<std::size_t>(std::count_if(
        names.begin(), names.end(), [](const std::string& name) { return name.substr(0, 7) != "unused "; }));
}

/// The kernel of a library, for `run_kernel`.
template <class R>
detail::run_statistics run_library(const host::any_run& all, const detail::run_options& o,
                                   const host::part_of_run* part) {
    any_arguments<R> now = *static_cast<const any_arguments<R>*>(all.arguments);
    if (part != nullptr && part->is_first) {
        now.cost = part->cost;
        now.phases = 1;
    } else if (part != nullptr) {
        now.first_phase = 1;
        now.order = part->order;
    }
    detail::run_statistics used;
    const library& kernel = *static_cast<const library*>(all.kernel);
    current_tape = kernel.model();
    kernel.facts().run(&now, &o, o.threads > 0 ? o.threads : usual_threads(),
                       current_tape != nullptr ? &start_tape_team : &start_team, &used);
    return used;
}

}  // namespace

template <class R>
std::unique_ptr<report<R>> solve(const library& with, const device& where, ensemble<R>& instances, const options& o) {
    const detail::default_arithmetic here;
    auto& data = instances.data;
    const kernel_library& kernel = with.facts();
    require(kernel.real_bytes == sizeof(R), "the kernel and the ensemble differ in precision");
    const auto claim = data.take();
    check_options<R>(*instances.shape, kernel, o);
    host::check_ended(data, o, data.size);
    host::check_scales(data, kernel.scales_tolerances);
    host::check_sample_times(data, o, data.size);
    const bool endless = kernel.writes_time_domain || kernel.hooks_may_stop || host::events_may_stop(o);
    const host::phases_left left = host::find_phases_left(data, o, data.size, endless);
    left.require_for(0, o.phases);
    host::data_check<R> check(data, o, data.size, endless);
    check.run();
    data.expect_phases(o.phases);

    auto result = std::make_unique<report<R>>();
    prepared_call<R> call(instances, o, kernel);
    const host::any_run run{&with,     &call.arguments, &run_library<R>,
                            data.size, o.phases,        static_cast<openmp::instruction_set>(kernel.instruction_set)};
    try {
        host::integrate_all<R>(where, o, &run, nullptr, data, check, *result);
    } catch (const interruption&) {
        result->interrupted = true;
        result->device = where.name();
    }
    result->first_state.resize(std::min(result->first_state.size(), used(instances.shape->names.states)));
    result->first_parameter.resize(std::min(result->first_parameter.size(), used(instances.shape->names.parameters)));
    result->records = std::move(call.records);
    if (!left.note.empty()) result->notes.push_back(left.note);
    if (kernel.embedded_order > 0) host::note_raised_tolerances<R>(*result, o);
    return result;
}
template std::unique_ptr<report<double>> solve(const library&, const device&, ensemble<double>&, const options&);
template std::unique_ptr<report<float>> solve(const library&, const device&, ensemble<float>&, const options&);

}  // namespace myriad::python
