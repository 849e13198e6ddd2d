// SPDX-License-Identifier: MIT
// The implementation `myriad` of every case: fills an ensemble, times a user's one call, extracts the results.
#pragma once

#include <cstdint>
#include <limits>

#include <myriad/myriad.hpp>

#include "sweep.hpp"

namespace cpu_peers {

/// `run`, or null if its kernel was not compiled.
template <class Method, class Model>
implementation_function if_compiled(implementation_function run) {
    return myriad::host::choose_cpu_kernel<Model, Method, double>().run != nullptr ? run : nullptr;
}

/// Integrates the sweep with the given options; `prepare(ensemble)` sets everything except states and parameters.
template <class Method, class Model, class Prepare>
outcome run_myriad(const sweep& work, const myriad::options& options, Prepare&& prepare) {
    using column = Eigen::Map<Eigen::ArrayXd>;
    using const_column = Eigen::Map<const Eigen::ArrayXd>;
    myriad::ensemble<Model> instances(work.instances);
    for (int c = 0; c < myriad::detail::n_state<Model>; ++c)
        instances.state(c) = column(work.states + c * work.instances, work.instances);
    for (int c = 0; c < myriad::detail::n_parameter<Model>; ++c)
        instances.parameter(c) = const_column(work.parameters + c * work.instances, work.instances);
    for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c) instances.accessory(c) = 0.0;
    prepare(instances);

    const myriad::device device = myriad::device::cpu(work.threads);
    myriad::report<Model, double> report;
    outcome result = timed([&] { report = myriad::solve<Method>(device, instances, options); });
    result.lanes = report.lanes;
    result.idle_share = report.idle_share();

    for (int c = 0; c < myriad::detail::n_state<Model>; ++c)
        column(work.states + c * work.instances, work.instances) = instances.state(c);
    for (std::int64_t i = 0; i < work.instances; ++i) {
        work.accepted[i] = instances.accepted_steps()[i];
        const myriad::status how = instances.status(i);
        work.endings[i] = how == myriad::status::event_accumulation ? ending::accumulated
                          : myriad::is_failure(how)                 ? ending::failed
                                                                    : ending::completed;
    }
    return result;
}

}  // namespace cpu_peers
