// SPDX-License-Identifier: MIT
// `solve` for models that are known only at run time, for both real types.
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "compile/loaded_library.hpp"
#include "myriad/host/checks/consistency.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/report/matrix_note.hpp"
#include "myriad/host/report/stability.hpp"
#include "myriad/host/report/stiffness.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/kernel/methods/method_list.hpp"
#include "myriad/methods.hpp"
#include "resident.hpp"
#include "tape_instances.hpp"
#include "threads.hpp"

namespace myriad::python {

library::library(const std::string& path, std::string_view made_from) {
    compiling::loaded_library loaded(path, made_from);
    const auto function = reinterpret_cast<kernel_library_function>(loaded.find(kernel_library_symbol));
    require(function != nullptr, "the file of a compiled model holds none");
    cpu_ = *function();
    require(cpu_.facts.interface_version == interface_version, "the model was compiled for another version of Myriad");
    const auto set = static_cast<openmp::instruction_set>(cpu_.instruction_set);
    require(host::cpu_has(set), "the model was compiled for ", host::name_of(set), ", which this CPU lacks");
    loaded.keep();
}

namespace {

template <class Method>
constexpr auto limit_of() -> double (*)() {
    if constexpr (host::may_be_unstable<Method>) return &host::real_stability_limit<Method>;
    return nullptr;
}

/// The longest stable step of a method, where a stiff one may be advised.
auto limit_of_method(const std::string& method) -> double (*)() {
#define MYRIAD_TAKE_LIMIT(name) \
    if (method == #name) return limit_of<name>();
    MYRIAD_METHODS(MYRIAD_TAKE_LIMIT)
#undef MYRIAD_TAKE_LIMIT
    return nullptr;
}

}  // namespace

library::library(const std::string& method, int shared, int shared_integers, bool may_stop,
                 std::shared_ptr<const interpreted> model)
    : cpu_(interpreter(method, model->get(), shared, shared_integers)), model_(std::move(model)),
      stability_limit_(limit_of_method(method)) {
    cpu_.facts.call.hooks_may_stop = may_stop;
    const auto set = static_cast<openmp::instruction_set>(cpu_.instruction_set);
    require(host::cpu_has(set), "this CPU lacks the instructions of ", host::name_of(set),
            ", for which models are interpreted", host::cure, "install a C++ compiler");
}

library::library(std::string image, int device) {
    auto program = std::make_unique<device_program>(std::move(image));
    cpu_.facts = program->on(device).facts.facts;
    gpu_ = program.release();
}

void library::give_model(std::shared_ptr<const interpreted> model, const std::string& method,
                         std::vector<double> mass_matrix) {
    if (!host::cpu_has(instructions_of_interpreter())) return;
    model_ = std::move(model);
    mass_matrix_ = std::move(mass_matrix);
    stability_limit_ = limit_of_method(method);
}

component_names names_from(const names_of_kinds& all) {
    component_names made;
#define MYRIAD_TAKE_NAMES(kind, plural, ...) made.plural = all.at(#kind);
    MYRIAD_COMPONENT_KINDS(MYRIAD_TAKE_NAMES)
#undef MYRIAD_TAKE_NAMES
    return made;
}

named_shape::named_shape(const detail::model_numbers& of, component_names its_names)
    : model_shape{of,
#define MYRIAD_LABEL(kind, plural, words, type)                                                              \
    [](const model_shape& shape, int c) -> host::component_label {                                           \
        return {words, c, static_cast<const named_shape&>(shape).names.plural[static_cast<std::size_t>(c)]}; \
    },
                  MYRIAD_VALUE_KINDS(MYRIAD_LABEL)
#undef MYRIAD_LABEL
      },
      names(std::move(its_names)), components{
#define MYRIAD_LIST_KIND(kind, plural, words, type) {n_##kind, words},
                                       MYRIAD_COMPONENT_KINDS(MYRIAD_LIST_KIND)
#undef MYRIAD_LIST_KIND
                                   } {
#define MYRIAD_CHECK_NAMES(kind, plural, words, type)                                                              \
    require(static_cast<int>(names.plural.size()) == n_##kind, "the model has ", n_##kind, " components of kind ", \
            words, ", and ", names.plural.size(), " names are given");
    MYRIAD_COMPONENT_KINDS(MYRIAD_CHECK_NAMES)
#undef MYRIAD_CHECK_NAMES
}

namespace {

/// Refuses what the interpreter has no memory for: about so many vectors are under way in a step, and a dense matrix.
template <class R>
void check_memory_of_interpreter(const library& kernel, const named_shape& shape, int threads, std::int64_t size) {
    constexpr double vectors = 100, few = 10;
    const detail::model_numbers& n = kernel.facts().model;
    const tape_lengths& length = kernel.model()->length;
    const double lanes =
        length.stop > 0 || length.trigger > 0 || length.delayed > 0 ? 1 : tape_batches * 32.0 / sizeof(R);
    const double parts = std::min(static_cast<double>(threads), std::ceil(static_cast<double>(size) / lanes));
    const double reals = vectors * n.n_state + few * (n.n_parameter + n.n_accessory + n.n_integer_accessory) +
                         2 * static_cast<double>(kernel.facts().matrix.factor_entries);
    host::memory_need need;
    need.add("vectors and matrices of its threads", parts * lanes * reals * sizeof(R));
    need.check(message("the interpreter of a model with ", shape.n_state, " states"),
               "use fewer threads, as with device=\"cpu:1\", or interpreted=False");
}

}  // namespace

template <class R>
host::called_model<R> called_for(const library& kernel, const named_shape& shape, const device& where,
                                 const options& o) {
    require(kernel.facts().real_bytes == sizeof(R), "the kernel and the ensemble differ in precision");
    host::called_model<R> made{&shape, &shape.components, kernel.facts().call, {}};
    const bool is_for_gpu = kernel.gpu() != nullptr;
    if (is_for_gpu != (where.which() == device::kind::cuda)) return made;
    if (!is_for_gpu) made.functions = *static_cast<const detail::instance_functions<R>*>(kernel.cpu().functions);
    if (kernel.model() != nullptr) {
        const auto of_tape = functions_of_tape<R>(*kernel.model(), kernel.stability_limit());
        made.functions.rhs = of_tape.rhs;
        made.functions.stability_limit = of_tape.stability_limit;
        made.functions.event_resolution = of_tape.event_resolution;
        if (kernel.mass_matrix() != nullptr) {
            made.functions.mass_matrix = kernel.mass_matrix();
            made.functions.linearise = of_tape.linearise;
        }
    }
    made.enter_thread = [&kernel] { current_tape = kernel.model(); };  // what the functions interpret
    if (is_for_gpu) {
        made.on_gpus.push_back(engines_of<R>(*kernel.gpu(), where, o));
        return made;
    }
    made.on_cpu = {[&kernel, &shape](const detail::any_arguments<R>& all, const detail::run_options& how) {
                       const int threads = how.threads > 0 ? how.threads : usual_threads();
                       if (kernel.model() != nullptr)
                           check_memory_of_interpreter<R>(kernel, shape, threads, how.count > 0 ? how.count : all.size);
                       detail::run_statistics used;
                       current_tape = kernel.model();
                       kernel.cpu().run(&all, &how, threads, current_tape != nullptr ? &start_tape_team : &start_team,
                                        &used);
                       return used;
                   },
                   static_cast<openmp::instruction_set>(kernel.cpu().instruction_set)};
    return made;
}
template host::called_model<double> called_for(const library&, const named_shape&, const device&, const options&);
template host::called_model<float> called_for(const library&, const named_shape&, const device&, const options&);

template <class R>
void make_consistent(const library& kernel, ensemble<R>& instances) {
    const detail::default_arithmetic here;
    const auto which = kernel.gpu() != nullptr ? device::parse("cuda") : device::parse("cpu");
    const host::called_model<R> model = called_for<R>(kernel, *instances.shape, which, {});
    require(model.functions.linearise != nullptr,
            "make_consistent is for models with a mass matrix; where one has an `initialise`, its states are made "
            "consistent after that: leave it out");
    if (model.enter_thread) model.enter_thread();
    host::project_initial_states(instances.data, model.functions);
}
template void make_consistent(const library&, ensemble<double>&);
template void make_consistent(const library&, ensemble<float>&);

template <class R>
std::unique_ptr<report<R>> solve(const std::vector<placed_kernel>& on, ensemble<R>& instances, const options& o,
                                 results_are results) {
    const detail::default_arithmetic here;
    require(!on.empty(), "no device is given");
    const bool on_gpu = on.front().where.which() == device::kind::cuda;
    host::called_model<R> model = called_for<R>(*on.front().kernel, *instances.shape, on.front().where, o);
    if (!instances.on_device.empty()) {  // inputs are not here
        model.functions.event_resolution = nullptr;
        model.functions.linearise = nullptr;
    }
    std::vector<device> where{on.front().where};
    for (const placed_kernel& k : std::span(on).subspan(1)) {
        where.push_back(k.where);
        if (on_gpu && k.kernel->gpu() != nullptr) model.on_gpus.push_back(engines_of<R>(*k.kernel->gpu(), k.where, o));
    }
    require(on_gpu || instances.on_device.empty(), "the sweep has arrays on a GPU, and the device is the CPU",
            host::cure, "copy them, or give device=\"cuda\"");
    require(on.size() == 1 || instances.on_device.empty(),
            "the sweep has arrays on a GPU, and several devices are given", host::cure,
            "copy them to the host, or name one device");
    auto result = std::make_unique<report<R>>();
    auto& data = instances.data;
    // Samples that stay on the GPU are set here when they are copied: their memory, which may be large, is not touched.
    const bool may_stay =
        on_gpu && on.size() == 1 && (results == results_are::anywhere || !instances.on_device.empty());
    host::solve_call<R> call(where, o, model, data, instances.samples, result->records,
                             may_stay ? host::new_samples::unset : host::new_samples::cleared);
    const auto gpu = may_stay ? std::make_shared<resident<R>>(*on.front().kernel, model, call, instances, o) : nullptr;
    try {
        call.integrate(*result, gpu.get());
    } catch (const interruption&) {
        result->interrupted = true;
    }
    if (gpu != nullptr && gpu->has_results()) instances.gpu = result->gpu = gpu;
    const detail::tangent_places& tangents = model.facts.tangents;
    if (instances.gpu != nullptr && !result->interrupted &&
        host::examines_stiffness<R>(*result, data.size, o, model.functions))
        instances.gpu->bring_every(host::examined_stride(data.size));
    if (tangents.n_vectors > 0 && instances.gpu != nullptr && !result->interrupted) {
        const auto bring = [&](const auto* values) {
            instances.gpu->bring(values, static_cast<std::size_t>(data.size) * sizeof *values);
        };
        bring(data.ended.data());
        bring(data.phase.data());
        for (int k = 0; k < tangents.n_vectors; ++k) bring(data.accessory.component(tangents.first_growth + k));
    }
    call.add_notes(*result, result->interrupted);
    host::note_matrix<R>(*result, on.front().kernel->facts().matrix);
    return result;
}
template std::unique_ptr<report<double>> solve(const std::vector<placed_kernel>&, ensemble<double>&, const options&,
                                               results_are);
template std::unique_ptr<report<float>> solve(const std::vector<placed_kernel>&, ensemble<float>&, const options&,
                                              results_are);

}  // namespace myriad::python
