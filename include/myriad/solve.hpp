// SPDX-License-Identifier: MIT
// The one-shot call: checks everything once, hands the ensemble to the device's backend, reports.
#pragma once

#include <chrono>
#include <exception>
#include <memory>

#include "myriad/backend.hpp"
#include "myriad/chunk_plan.hpp"
#include "myriad/chunked_solve.hpp"
#include "myriad/core/floating_point.hpp"
#include "myriad/cpu_kernel.hpp"
#include "myriad/device.hpp"
#include "myriad/ensemble/ensemble.hpp"
#include "myriad/ensemble/notes.hpp"
#include "myriad/ensemble/report.hpp"
#include "myriad/idle_engines.hpp"
#include "myriad/integrator/arguments.hpp"
#include "myriad/integrator/option_checks.hpp"
#include "myriad/integrator/options.hpp"
#include "myriad/progress_relay.hpp"

namespace myriad {
namespace host {

/// What integrates a model with one method on one device.
template <class Model, class R>
struct device_kernel {
    cpu_kernel<Model, R> cpu;
    engine_maker<Model, R> make_engine = nullptr;
};

/// The kernel of the model and method for that device. Throws `error` if the program has none.
template <class Model, class Method, class R>
device_kernel<Model, R> require_kernel(const device& where) {
    static_assert(check_linkage<Model, Method>());
    const bool on_cpu = where.which() == device::kind::cpu;
    device_kernel<Model, R> found;
    if (on_cpu) {
        found.cpu = choose_cpu_kernel<Model, Method, R>();
    } else {
        found.make_engine = if_defined(&cuda::make_engine<Model, Method, R>);
    }
    require(on_cpu ? found.cpu.run != nullptr : found.make_engine != nullptr,
            "this model was not instantiated for this method and real type", on_cpu ? "" : " on CUDA devices",
            ", or with other numbers of components, or its source file was not linked: write MYRIAD_INSTANTIATE(model, method) (MYRIAD_INSTANTIATE_FLOAT for "
            "float) in the model's source file, and name that file in myriad_add_models for the program or an OBJECT "
            "library",
            on_cpu ? "" : ", with MYRIAD_ENABLE_CUDA on");
    require(on_cpu || may_use_gpus(),
            "this process was forked from one that has used a GPU, which it cannot use too: fork before that, use the CPU, or "
            "start a program anew (exec)");
    return found;
}

/// The part of `solve` that does not depend on the method: a program compiles it once for each model.
template <class Model, class R>
void integrate_all(const device& where, const options& o, const device_kernel<Model, R>& kernel, ensemble<Model, R>& instances,
                   kernel_arguments<Model, R>& arguments, input_check<Model, R>& check, report<Model, R>& result) {
    progress_relay relay{o.progress, instances.size(), nullptr};
    const auto begin = std::chrono::steady_clock::now();
    if (where.which() == device::kind::cpu) {
        const auto work = [&] {
            return o.counting == counting::on ? counted_work(instances, instances.size()) : work_count{};
        };
        const auto work_before = work();
        instances.touch();
        run_options how;
        how.threads = where.threads();
        how.schedule = o.schedule;
        how.progress = &progress_relay::call;
        how.context = &relay;
        const run_statistics used = run_kernel(kernel.cpu, arguments, how);
        result.lane_turns = used.lane_turns;
        result.lanes = used.lanes;
        result.threads = used.threads;
        result.instruction_set = used.instruction_set;
        set_work(result, work_before, work());
        summarise(instances, result, instances.size());
    } else {
        chunked_solve<Model, R>(where, o, kernel.make_engine, instances, arguments, check, relay, result).run();
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (relay.failure) std::rethrow_exception(relay.failure);
    result.device = where.name();
    note_tolerances(result, o);
}

}  // namespace host

/// Takes every instance of the ensemble through `options.phases` integration phases with the given method, in place, and
/// reports. A further call goes on from there with the next phases; instances that failed or ended themselves stay as
/// they are until `ensemble::restart`. The result of an instance depends on nothing but its own data and the options.
/// Throws `error`, and leaves all instances as they are, if an input is invalid, if the device is not there, if the program
/// has no kernel for the model and method, or if the ensemble is being integrated already. On the CPU it throws what a function
/// of the model throws; what the ensemble then holds is good for nothing but to be set anew, after `restart`.
/// The report may be left alone, as in a call for transients: how instances ended is kept in the ensemble.
template <class Method, class Model, class R>
report<Model, R> solve(const device& where, ensemble<Model, R>& instances, const options& options = {}) {
    const default_arithmetic here;
    const auto turn = instances.take();
    check_options<Model, Method, R>(options);
    const auto kernel = host::require_kernel<Model, Method, R>(where);
    const auto before = host::check_uses<Method>(instances, options, instances.size());
    // On a GPU the data of large ensembles are checked chunk by chunk, while it works on others.
    host::input_check<Model, R> check(instances, options, instances.size());
    if (where.which() == device::kind::cpu || instances.size() <= host::worth_chunks) check.run();
    instances.expect_phases(options.phases);

    report<Model, R> result;
    host::prepared_arguments<Model, R> prepared(instances, options, host::traits_of<Method>);
    host::integrate_all(where, options, kernel, instances, prepared.get(), check, result);
    result.records = std::move(prepared.records());
    host::note_event_tolerances(result, instances, options, before, instances.size());
    host::note_stiffness<Method>(result, instances, options);
    return result;
}

}  // namespace myriad
