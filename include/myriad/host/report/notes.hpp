// SPDX-License-Identifier: MIT
// The notes of a report: tolerances that had to be raised, signs of stiffness, and phases too long for the smallest
// Lyapunov exponent.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "myriad/host/checks/event_resolution.hpp"
#include "myriad/host/ensemble/inputs_of.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/report/stiffness.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/tangent.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Adds a note if a relative tolerance was below what the precision can reach and the method uses it.
template <class Method, class Model, class R>
void note_tolerances(report<Model, R>& r, const options& o) {
    if (Method::embedded_order > 0) note_raised_tolerances<R>(r, o);
}

/// Adds a note if stability, not accuracy, limited an explicit method's steps in half or more of the instances
/// examined. Runs of fewer than 200 steps per instance are not worth it.
template <class Method, class Model, class R>
void note_stiffness(report<Model, R>& r, ensemble<Model, R>& e, const options& o) {
    // Stiff methods do not support tangents, so there is nothing to advise.
    if constexpr (Method::embedded_order > 0 && !solves_linear_systems<Method> && n_tangent<Model> == 0) {
        constexpr std::int64_t worthwhile = 200;
        if (o.advice == advice::off) return;
        if (r.accepted_steps + r.rejected_steps < worthwhile * e.size()) return;
        const stiffness found = find_stiffness(e, o, real_stability_limit<Method>());
        add_note(r.notes, found);
    }
}

/// The error of a step relative to the tangents, which have length one at the start of a phase: their tolerance, or, if
/// they take no part in the error test, that of the model's states; with fixed steps, rounding.
template <class Method, class Model, class R>
double tangent_error(const options& o) {
    double error = static_cast<double>(epsilon_of<R>);
    if constexpr (Method::embedded_order > 0) {
        const auto original = static_cast<std::size_t>(Model::n_original),
                   all = static_cast<std::size_t>(n_state<Model>);
        for (std::size_t c = original; c < all; ++c)
            error = std::max(error, std::max(o.relative_tolerance[c], o.absolute_tolerance[c]));
        if (error < 1) return error;
        error = static_cast<double>(epsilon_of<R>);
        for (std::size_t c = 0; c < original; ++c) error = std::max(error, o.relative_tolerance[c]);
    }
    return error;
}

/// Adds a note if the growth of tangents within a phase differs so much that the steps' errors, amplified along the
/// fastest, may be visible in the slowest: from a thousand or so instances. In measurements (docs/numerics.md)
/// exponents were right where the product is below the limit, and above it off by ten to a hundred times the product,
/// if at all: the product uses mean growth, and local growth may exceed it.
template <class Method, class Model, class R>
void note_exponents(report<Model, R>& r, ensemble<Model, R>& e, const options& o) {
    if constexpr (n_tangent<Model> != 0) {
        constexpr double limit = 1e-4;
        if (Model::n_vectors < 2 || o.advice == advice::off) return;
        const double error = tangent_error<Method, Model, R>(o);
        std::int64_t looked_at = 0, doubtful = 0;
        double worst = 0;
        for_sampled_instances(e, e.size(), [&](std::int64_t i) {
            const std::int64_t phases =
                e.phases_done()[i] - e.shared_integer(static_cast<int>(Model::transient_phases));
            if (phases < 1) return;
            double fastest = -std::numeric_limits<double>::infinity(), slowest = -fastest;
            for (int k = 0; k < Model::n_vectors; ++k) {
                const double growth =
                    static_cast<double>(e.accessory(Model::growth(k))[i]) / static_cast<double>(phases);
                fastest = std::max(fastest, growth);
                slowest = std::min(slowest, growth);
            }
            const double product = error * std::exp(fastest - slowest);
            ++looked_at;
            if (!(product > limit)) return;
            ++doubtful;
            worst = std::max(worst, product);
        });
        if (doubtful == 0) return;
        r.notes.push_back(
            message("phases may be too long for the smallest exponent in ", doubtful, " of ", looked_at,
                    " instances looked at: the tangents grow apart so far in one that the error of a step, ", error,
                    ", becomes up to ", worst, " of the slowest (should be below ", limit,
                    "): take shorter phases or smaller tolerances, and see whether it changes"));
    }
}

}  // namespace myriad::host::inline MYRIAD_ABI
