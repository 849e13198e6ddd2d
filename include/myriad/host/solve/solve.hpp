// SPDX-License-Identifier: MIT
// The one-shot call: checks everything once, passes the ensemble to the device's backend, and reports.
#pragma once

#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/backend/cpu_kernel.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/checks/jacobian_check.hpp"
#include "myriad/host/checks/make_consistent.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/option_checks.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/functions_of.hpp"
#include "myriad/host/report/matrix_note.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/solve/solve_call.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/facts_of.hpp"
#include "myriad/kernel/stepper/matrix_facts_of.hpp"

namespace myriad {
namespace host::inline MYRIAD_ABI {

/// The checks of a model's own Jacobian and of its pattern.
template <class Model, class Method, class R>
void check_jacobians(const argument_head<R>& a, std::int64_t count) {
    // As the concept of Rosenbrock methods, whose header has kernels.
    if constexpr (requires { Method::tableau().coupling; }) check_jacobian_pattern<Model>(a, count);
#if !defined(NDEBUG)
    check_jacobian<Model>(a, count);
#endif
}

/// A model and a method as calls see them, without a kernel. Throws `error` if this file was compiled with flags that
/// change its arithmetic.
template <class Model, class Method, class R>
called_model<R> called() {
    static_assert(detail::check_linkage<Model, Method>());
    require(detail::computes_as_written(), "this file of the program ", detail::not_as_written);
    called_model<R> made{&shape_of<Model>, &components_of<Model>, detail::facts_of<Model, Method, R>,
                         detail::functions_of<Model, Method, R>()};
    made.functions.check_jacobian = &check_jacobians<Model, Method, R>;
    return made;
}
/// The same with the kernels for those devices.
template <class Model, class Method, class R>
called_model<R> called_for(const std::vector<device>& where, const options& o) {
    called_model<R> made = called<Model, Method, R>();
    for (const device& d : where) {
        if (d.which() == device::kind::cpu) {
            made.on_cpu = choose_cpu_kernel<Model, Method, R>();
        } else if (const auto make = if_defined(&cuda::make_engine<Model, Method, R>)) {
            made.on_gpus.push_back({reinterpret_cast<engine_key>(make), make, engine_options_for(d, o)});
        }
    }
    return made;
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
    return solve<Method>(std::vector{where}, instances, options);
}
/// The same on several GPUs, each of which takes the next part of the instances whenever it has done one. The results
/// are those of one of them, whatever the parts.
template <class Method, class Model, class R>
report<Model, R> solve(const std::vector<device>& where, ensemble<Model, R>& instances, const options& options = {}) {
    const detail::default_arithmetic here;
    const auto model = host::called_for<Model, Method, R>(where, options);
    report<Model, R> result;
    host::solve_call<R> call(where, options, model, host::ensemble_access::data(instances),
                             host::ensemble_access::samples(instances), result.records.data());
    call.integrate(result);
    call.add_notes(result);
    host::note_matrix<R>(result, detail::matrix_facts_of<Model, Method, R>);
    return result;
}

}  // namespace myriad
