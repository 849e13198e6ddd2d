// SPDX-License-Identifier: MIT
// The one-shot call: checks everything once, passes the ensemble to the device's backend, and reports.
#pragma once

#include <utility>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/backend/cpu_kernel.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/checks/input_check.hpp"
#include "myriad/host/chunks/chunk_plan.hpp"
#include "myriad/host/chunks/chunked_solve.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/option_checks.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/notes.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/solve/integrate_all.hpp"
#include "myriad/host/solve/prepared_arguments.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/hooks.hpp"

namespace myriad {
namespace host::inline MYRIAD_ABI {

/// What integrates a model with one method on one device.
template <class Model, class R>
struct device_kernel {
    cpu_kernel<Model, R> cpu;
    engine_maker<Model, R> make_engine = nullptr;
};

/// The kernel of the model and method for that device. Throws `error` if the program has none.
template <class Model, class Method, class R>
device_kernel<Model, R> require_kernel(const device& where) {
    static_assert(detail::check_linkage<Model, Method>());
    const bool on_cpu = where.which() == device::kind::cpu;
    device_kernel<Model, R> found;
    if (on_cpu) {
        found.cpu = choose_cpu_kernel<Model, Method, R>();
    } else {
        found.make_engine = if_defined(&cuda::make_engine<Model, Method, R>);
    }
    check_kernel(where, on_cpu ? found.cpu.run != nullptr : found.make_engine != nullptr);
    return found;
}

/// The part of `solve` that does not depend on the method: a program compiles it once for each model.
template <class Model, class R>
void integrate_all(const device& where, const options& o, const device_kernel<Model, R>& kernel,
                   ensemble<Model, R>& instances, detail::kernel_arguments<Model, R>& arguments,
                   input_check<Model, R>& check, report<Model, R>& result) {
    const any_run on_cpu = forget_model(kernel.cpu, arguments);
    const cuda::engine_options how{where.number(), o.block_size, o.shared_placement, o.schedule};
    chunks_of on_gpu(reinterpret_cast<engine_key>(kernel.make_engine), kernel.make_engine, how, arguments);
    integrate_all<R>(where, o, &on_cpu, &on_gpu, ensemble_access::data(instances), check, result);
}

}  // namespace host::inline MYRIAD_ABI

/// Takes every instance of the ensemble through `options.phases` integration phases with the given method, in place,
/// and reports. A further call continues with the next phases; instances that failed or ended themselves stay as they
/// are until `ensemble::restart`, and if their states or parameters are set again without one, the call is refused. The
/// result of an instance depends only on its own data and the options. Throws `error`, and leaves all instances as they
/// are, if an input is invalid, if the device does not exist, if the program has no kernel for the model and method, or
/// if the ensemble is being integrated already. On the CPU it rethrows exceptions of the model's functions; the
/// ensemble's contents are then unspecified, and must be set again after `restart`. The report may be ignored, as in a
/// call for transients: how instances ended is kept in the ensemble.
template <class Method, class Model, class R>
report<Model, R> solve(const device& where, ensemble<Model, R>& instances, const options& options = {}) {
    const detail::default_arithmetic here;
    auto& data = host::ensemble_access::data(instances);
    const auto claim = data.take();
    host::check_options<Model, Method, R>(options);
    const auto kernel = host::require_kernel<Model, Method, R>(where);
    host::check_uses<Method>(instances, options, instances.size());
    const host::phases_left left = host::find_phases_left(instances, options, instances.size());
    left.require_for(0, options.phases);
    // On a GPU the data of large ensembles are checked chunk by chunk, while the GPU works on others.
    host::input_check<Model, R> check(instances, options, instances.size());
    if (where.which() == device::kind::cpu || instances.size() <= host::worth_chunks) check.run();
    data.expect_phases(options.phases);

    report<Model, R> result;
    host::prepared_arguments<Model, R> prepared(instances, options, host::traits_of<Method>);
    host::integrate_all(where, options, kernel, instances, prepared.get(), check, result);
    result.records = std::move(prepared.records());
    if (!left.note.empty()) result.notes.push_back(left.note);
    host::note_tolerances<Method>(result, options);
    host::note_matrix<Method>(result);
    host::note_stiffness<Method>(result, instances, options);
    host::note_exponents<Method>(result, instances, options);
    return result;
}

}  // namespace myriad
