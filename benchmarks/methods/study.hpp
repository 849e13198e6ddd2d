// SPDX-License-Identifier: MIT
// A study: a problem with its tolerances, the reference for comparison, and the errors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <myriad/myriad.hpp>

#include "benchmarks/gpu_ensembles/reference.hpp"
#include "models.hpp"

namespace methods {

template <class Model>
struct study {
    std::string name;
    std::string work;             ///< description of the work
    std::int64_t on_cpu, on_gpu;  ///< default numbers of instances
    std::vector<double> tolerances;
    const char* reference;  ///< name of the method of the reference
    double reference_tolerance;
    std::vector<double>
        scale;  ///< per component: both the error test and the reported errors are relative to max(scale, |y|)
    gpu_ensembles::problem<Model> (*at)(double tolerance);
    /// Describes what is wrong with results at that tolerance, of a run from a new ensemble; empty if nothing is.
    std::string (*complaint)(const myriad::ensemble<Model>&, double tolerance);
};

study<keller_miksis> keller_miksis_study();
study<relief_valve> relief_valve_study();
/// The same with event functions checked eight times within each step.
study<relief_valve> closely_watched_valve_study();
study<robertson> robertson_study();

/// Points per step at which event functions are checked where none may be missed.
inline constexpr std::int64_t often = 8;

/// `count` instances spread over the `size` of the study, integrated by Method on the CPU at the given tolerance.
template <class Method, class Model>
myriad::ensemble<Model> integrated(const study<Model>& of, std::int64_t size, std::int64_t count, double tolerance) {
    auto what = of.at(tolerance);
    auto few = gpu_ensembles::spread_instances(what, size, count);
    what.options.sub_samples = often;  // the reference must not step over an event
    myriad::solve<Method>(myriad::device::cpu(1), few, what.options);
    return few;
}

struct errors {
    double median, largest;
    std::int64_t astray;  ///< instances with an error above a thousand tolerances: those that missed an event
};

/// Errors of results against those of the spread instances of a reference, each in its worst component. Instances that
/// failed in the reference are left out; one that failed only here, or ended differently, has an infinite error.
template <class Model>
errors compare(const study<Model>& of, const myriad::ensemble<Model>& results, const myriad::ensemble<Model>& reference,
               double tolerance) {
    std::vector<double> worst;
    for (std::int64_t k = 0; k < reference.size(); ++k) {
        if (myriad::is_failure(reference.status(k))) continue;
        const std::int64_t i = gpu_ensembles::compared_instance(k, results.size(), reference.size());
        double error = results.status(i) == reference.status(k) ? 0 : std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < of.scale.size(); ++c) {
            const double value = reference.state(static_cast<int>(c))[k];
            error = std::max(error, std::fabs(results.state(static_cast<int>(c))[i] - value) /
                                        std::max(of.scale[c], std::fabs(value)));
        }
        worst.push_back(error);
    }
    if (worst.empty()) return {std::nan(""), std::nan(""), 0};
    const double largest = *std::max_element(worst.begin(), worst.end());
    const auto astray = std::count_if(worst.begin(), worst.end(), [&](double e) { return !(e <= 1000 * tolerance); });
    return {gpu_ensembles::median(std::move(worst)), largest, astray};
}

}  // namespace methods
