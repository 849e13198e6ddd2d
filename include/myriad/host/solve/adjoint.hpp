// SPDX-License-Identifier: MIT
// The gradients of losses by an adjoint: integrates with all steps kept, and goes back through them. Host code only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "myriad/host/backend/cpu_adjoint.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/solve/recorded_steps.hpp"
#include "myriad/host/solve/solve.hpp"
#include "myriad/kernel/adjoint/adjoint_check.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"

namespace myriad {

/// The gradients of all instances: arrays with one row per instance. A row is NaN if the instance failed, or where a
/// derivative does not exist.
struct adjoint_gradients {
    Eigen::ArrayXXd by_state;      ///< the derivatives of each instance's loss by its initial states
    Eigen::ArrayXXd by_parameter;  ///< and by its parameters
    std::vector<status> statuses;  ///< how each instance ended
};

/// Derivatives of a loss, one number of each instance that depends on its states at some times, by all of the
/// instance's initial states and parameters, at a cost that hardly depends on how many these are.
///
/// `times` are within the time domain that all instances share, in the direction of integration; if it is empty, the
/// loss depends on the states at the end. For each instance that did not fail, in their order,
/// `loss(instance, y, by_y)` is called with the states in `y(state, time)`, and sets `by_y(state, time)`, which are
/// zero, to the derivatives of the loss by them. Both are arrays of Eigen.
///
/// The ensemble is left as it is; it must not have been integrated before. `options` are those of one phase without
/// samples and records. All steps are kept, for groups of instances that take some MB per thread. The result is the
/// derivative of the numerical solution, whose steps' lengths count as given (Hager, Numer. Math. 87, 2000, 247-282),
/// and so lacks what a jump of the equations contributes whose time depends on the state or on parameters. Else it is
/// about as accurate as the solution, and equal to rounding in any order of the instances. Runs on the CPU; the file of
/// the model has MYRIAD_INSTANTIATE and MYRIAD_INSTANTIATE_ADJOINT for `Method`, which is a `dense<...>`. Throws
/// `error` as `solve` does, and what `loss` throws.
template <class Method, class Model, class Loss>
adjoint_gradients adjoint(ensemble<Model, double>& instances, const std::vector<double>& times, Loss&& loss,
                          const options& options = {}) {
    static_assert(detail::check_adjoint<Model, Method>());
    constexpr int n = detail::n_state<Model>, n_wrt = detail::n_parameter<Model>;
    host::check_adjoint_call(host::ensemble_access::data(instances), times, options);
    if (options.invalid_instances == invalid_instances::refuse)
        host::called<Model, Method, double>()
            .values_of(host::ensemble_access::data(instances), options, instances.size())
            .run();
    const std::int64_t size = instances.size();
    const auto samples = static_cast<std::int64_t>(std::max<std::size_t>(times.size(), 1));
    adjoint_gradients found{Eigen::ArrayXXd(size, n), Eigen::ArrayXXd(size, n_wrt),
                            std::vector<status>(static_cast<std::size_t>(size))};
    host::recorded_steps records(n);
    for (std::int64_t first = 0; first < size;) {
        const std::int64_t count = std::min(records.most_instances(), size - first);
        ensemble<Model, double> group(count);
        host::copy_inputs(host::ensemble_access::data(instances), first, host::ensemble_access::data(group));
        const auto report = solve<Method>(device::cpu(), group, records.options_for(options));
        if (!records.keep(host::ensemble_access::data(group), host::ensemble_access::samples(group), report.threads))
            continue;  // an instance had more steps than were kept
        Eigen::ArrayXXd values(n * samples, count), weights = Eigen::ArrayXXd::Zero(n * samples, count),
                                                    gradient(n + n_wrt, count);
        const auto run = host::adjoint_for<Model, Method>();
        records.run(run, times, values.data(), nullptr, nullptr);
        for (std::int64_t i = 0; i < count; ++i) {
            found.statuses[static_cast<std::size_t>(first + i)] = group.status(i);
            if (group.status(i) != status::success) continue;
            const Eigen::Map<const Eigen::ArrayXXd> y(&values(0, i), n, samples);
            Eigen::Map<Eigen::ArrayXXd> by_y(&weights(0, i), n, samples);
            loss(first + i, y, by_y);
        }
        records.run(run, times, nullptr, weights.data(), gradient.data());
        for (std::int64_t i = 0; i < count; ++i)
            if (group.status(i) != status::success || !gradient.col(i).isFinite().all())
                gradient.col(i).setConstant(std::numeric_limits<double>::quiet_NaN());
        found.by_state.middleRows(first, count) = gradient.topRows(n).transpose();
        found.by_parameter.middleRows(first, count) = gradient.bottomRows(n_wrt).transpose();
        first += count;
    }
    return found;
}

}  // namespace myriad
