// SPDX-License-Identifier: MIT
// `solve` for models that are known only at run time, for both real types.
#include "run.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <dlfcn.h>

#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/checks/event_tolerances.hpp"
#include "myriad/host/options/option_checks.hpp"
#include "myriad/host/report/stiffness.hpp"
#include "myriad/host/report/tangent_note.hpp"
#include "myriad/host/solve/integrate_all.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "prepared_call.hpp"
#include "resident.hpp"
#include "several_gpus.hpp"
#include "threads.hpp"

namespace myriad::python {

library::library(const std::string& path) {
    void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    require(handle != nullptr, "the compiled model could not be loaded: ", handle != nullptr ? "" : dlerror());
    const auto function = reinterpret_cast<kernel_library_function>(dlsym(handle, kernel_library_symbol));
    require(function != nullptr, path, " holds no compiled model");
    cpu_ = *function();
    require(cpu_.model.interface_version == interface_version, path, " was compiled for another version of Myriad");
    const auto set = static_cast<openmp::instruction_set>(cpu_.instruction_set);
    require(host::cpu_has(set), "the model was compiled for ", host::name_of(set), ", which this CPU lacks");
}

library::library(const std::string& method, int shared, int shared_integers, bool may_stop,
                 std::shared_ptr<const interpreted> model)
    : cpu_(interpreter(method)), model_(std::move(model)) {
    cpu_.model.n_shared = shared;
    cpu_.model.n_shared_integer = shared_integers;
    cpu_.model.hooks_may_stop = may_stop;
    const auto set = static_cast<openmp::instruction_set>(cpu_.instruction_set);
    require(host::cpu_has(set), "this CPU lacks the instructions of ", host::name_of(set),
            ", for which models are interpreted: install a C++ compiler");
}

library::library(std::string image, int device) {
    auto program = std::make_unique<device_program>(std::move(image));
    cpu_.model = program->on(device).facts.model;
    gpu_ = program.release();
}

namespace {

template <std::vector<std::string> component_names::*which>
host::component_label label(const host::model_shape& shape, int c, std::string_view what) {
    return {what, c, (static_cast<const named_shape&>(shape).names.*which)[static_cast<std::size_t>(c)]};
}

}  // namespace

named_shape::named_shape(const model_facts& of, component_names its_names)
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

}  // namespace

template <class R>
void check_options(const named_shape& shape, const model_facts& kernel, const options& o) {
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
template void check_options<double>(const named_shape&, const model_facts&, const options&);
template void check_options<float>(const named_shape&, const model_facts&, const options&);

template <class R>
double bytes_per_instance(const named_shape& shape, const model_facts& kernel, const options& o) {
    host::memory_need need = host::ensemble_data<R>::memory_of(shape, 1);
    add_memory_of_call<R>(need, shape, 1, nullptr, false, o, kernel);
    return need.bytes();
}
template double bytes_per_instance<double>(const named_shape&, const model_facts&, const options&);
template double bytes_per_instance<float>(const named_shape&, const model_facts&, const options&);

namespace {

/// The components of a kind that the model has; those that an interpreter has besides are called unused.
std::size_t used(const std::vector<std::string>& names) {
    return static_cast<std::size_t>(std::count_if(
        names.begin(), names.end(), [](const std::string& name) { return name.substr(0, 7) != "unused "; }));
}

/// The kernel of a library, for `run_kernel`.
template <class R>
detail::run_statistics run_library(const host::any_run& all, const detail::run_options& o,
                                   const host::part_of_run* part) {
    any_arguments<R> now = *static_cast<const shaped_arguments<R>*>(all.arguments);
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
    kernel.cpu().run(&now, &o, o.threads > 0 ? o.threads : usual_threads(),
                     current_tape != nullptr ? &start_tape_team : &start_team, &used);
    return used;
}

/// The model's functions in a kernel, called for single instances.
template <class R>
struct single_instances {
    const kernel_library& kernel;
    const any_arguments<R>& arguments;

    single_instances(const library& of, const any_arguments<R>& all) : kernel(of.cpu()), arguments(all) {
        current_tape = of.model();
    }
    host::any_rhs<R> rhs() {
        return {this, [](void* of, std::int64_t i, R t, const R* y, R* slopes) {
                    const auto& all = *static_cast<const single_instances*>(of);
                    all.kernel.rhs(&all.arguments, i, &t, y, slopes);
                }};
    }
    host::any_event_resolution<R> event_resolution() {
        return {this, [](void* of, std::int64_t i, R* finest) {
                    const auto& all = *static_cast<const single_instances*>(of);
                    all.kernel.event_resolution(&all.arguments, i, finest);
                }};
    }
};

}  // namespace

template <class R>
void add_notes(report_of<R>& r, ensemble<R>& instances, shaped_arguments<R>& arguments, const library& kernel,
               const options& o) {
    const model_facts& facts = kernel.facts();
    auto& data = instances.data;
    if (facts.embedded_order > 0) host::note_raised_tolerances<R>(r, o);
    if (kernel.cpu().rhs != nullptr)
        host::note_stiffness<R>(r, data, o, kernel.cpu().stability_limit, single_instances<R>(kernel, arguments).rhs());
    if (facts.n_vectors == 0) return;
    if (instances.gpu != nullptr) {
        const auto bring = [&](const auto* values) {
            instances.gpu->bring(values, static_cast<std::size_t>(data.size) * sizeof *values);
        };
        bring(data.ended.data());
        bring(data.phase.data());
        for (int k = 0; k < facts.n_vectors; ++k) bring(data.accessory.component(facts.first_growth + k));
    }
    host::note_exponents<R>(
        r, data, o,
        {facts.n_original, facts.n_vectors, facts.first_growth, facts.transient_phases, facts.embedded_order > 0});
}
template void add_notes(report_of<double>&, ensemble<double>&, shaped_arguments<double>&, const library&,
                        const options&);
template void add_notes(report_of<float>&, ensemble<float>&, shaped_arguments<float>&, const library&, const options&);

template <class R>
std::unique_ptr<report<R>> solve(const std::vector<placed_kernel>& on, ensemble<R>& instances, const options& o,
                                 results_are results) {
    const detail::default_arithmetic here;
    require(!on.empty(), "no device is given");
    const library& with = *on.front().kernel;
    const device& where = on.front().where;
    auto& data = instances.data;
    const model_facts& kernel = with.facts();
    require(kernel.real_bytes == sizeof(R), "the kernel and the ensemble differ in precision");
    const bool on_gpu = where.which() == device::kind::cuda;
    for (const placed_kernel& k : on) {
        host::check_kernel(k.where, (k.kernel->gpu() != nullptr) == on_gpu && k.where.which() == where.which());
        require(k.kernel->facts().real_bytes == sizeof(R), "the kernels differ in precision");
    }
    require(on_gpu || on.size() == 1, "the CPU is named several times");
    require(on_gpu || instances.on_device.empty(),
            "the sweep has arrays on a GPU, and the device is the CPU: copy them, or give device=\"cuda\"");
    require(on.size() == 1 || instances.on_device.empty(),
            "the sweep has arrays on a GPU, and several devices are given: copy them to the host, or name one device");
    const auto claim = data.take();
    check_options<R>(*instances.shape, kernel, o);
    host::check_ended(data, o, data.size);
    host::check_scales(data, kernel.scales_tolerances);
    host::check_sample_times(data, o, data.size);
    const bool endless = may_end_early(kernel, o);
    const host::phases_left left = host::find_phases_left(data, o, data.size, endless);
    left.require_for(0, o.phases);
    host::data_check<R> check(data, o, data.size, endless);
    // On a GPU the data of large ensembles are checked chunk by chunk, while the GPU works on others.
    if (!on_gpu || data.size <= host::worth_chunks) check.run();
    data.expect_phases(o.phases);

    auto result = std::make_unique<report<R>>();
    auto call = std::make_shared<prepared_call<R>>(instances, o, kernel);
    if (with.cpu().event_resolution != nullptr)
        host::check_event_tolerances<R>(data, o, data.size,
                                        single_instances<R>(with, call->arguments).event_resolution());
    try {
        if (!on_gpu) {
            const host::any_run run{&with,           &call->arguments,
                                    &run_library<R>, data.size,
                                    o.phases,        static_cast<openmp::instruction_set>(with.cpu().instruction_set)};
            host::integrate_all<R>(where, o, &run, nullptr, data, check, *result);
        } else if (on.size() > 1) {
            integrate_on_several<R>(on, call->arguments, o, data, check, *result);
        } else if (auto gpu = std::make_shared<resident<R>>(with, where, o, call);
                   results == results_are::anywhere && gpu->fits(instances)) {
            instances.gpu = result->gpu = gpu;
            gpu->integrate(instances, o, check, *result);
        } else {
            require(instances.on_device.empty(),
                    "the sweep has arrays on the GPU, whose memory does not suffice to "
                    "integrate all of it at once: divide it into smaller parts");
            device_program& program = *with.gpu();
            host::chunks_of chunks(&program, engines_of<R>(program), engine_options_for(program, where.number(), o),
                                   call->arguments);
            host::integrate_all<R>(where, o, nullptr, &chunks, data, check, *result);
        }
    } catch (const interruption&) {
        result->interrupted = true;
        result->device = names_of(on);
    }
    result->first_state.resize(std::min(result->first_state.size(), used(instances.shape->names.states)));
    result->first_parameter.resize(std::min(result->first_parameter.size(), used(instances.shape->names.parameters)));
    if (!left.note.empty()) result->notes.push_back(left.note);
    if (!result->interrupted) add_notes<R>(*result, instances, call->arguments, with, o);
    result->records = std::move(call->records);
    return result;
}
template std::unique_ptr<report<double>> solve(const std::vector<placed_kernel>&, ensemble<double>&, const options&,
                                               results_are);
template std::unique_ptr<report<float>> solve(const std::vector<placed_kernel>&, ensemble<float>&, const options&,
                                              results_are);

}  // namespace myriad::python
