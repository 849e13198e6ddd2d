// SPDX-License-Identifier: MIT
// Runs a problem with Myriad: fills an ensemble of its model, integrates, and extracts the results.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <myriad/myriad.hpp>

#include "methods.hpp"
#include "oracle.hpp"
#include "problem.hpp"

namespace validation {

template <class Model, class Method, class R>
outcome integrate(const problem& p, const myriad::options& options, const myriad::device& where) {
    const auto size = static_cast<std::int64_t>(p.instances.size());
    myriad::ensemble<Model, R> e(size);
    for (std::int64_t i = 0; i < size; ++i) {
        const instance& from = p.instances[static_cast<std::size_t>(i)];
        for (int c = 0; c < myriad::detail::n_state<Model>; ++c)
            e.state(c)[i] = static_cast<R>(from.state[static_cast<std::size_t>(c)]);
        for (int c = 0; c < myriad::detail::n_parameter<Model>; ++c)
            e.parameter(c)[i] = static_cast<R>(from.parameter[static_cast<std::size_t>(c)]);
        e.t_begin()[i] = 0;
        e.t_end()[i] = static_cast<R>(from.t_end);
    }
    for (int c = 0; c < myriad::detail::n_shared<Model>; ++c)
        e.shared(c) = static_cast<R>(p.shared[static_cast<std::size_t>(c)]);
    const auto report = myriad::solve<Method>(where, e, options);

    outcome out;
    out.seconds = report.kernel_seconds > 0 ? report.kernel_seconds : report.seconds;
    for (std::int64_t i = 0; i < size; ++i) {
        solution s;
        for (int c = 0; c < myriad::detail::n_state<Model>; ++c) s.end.push_back(e.state(c)[i]);
        for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c) s.accessory.push_back(e.accessory(c)[i]);
        for (int c = 0; c < myriad::detail::n_integer_accessory<Model>; ++c)
            s.count.push_back(e.integer_accessory(c)[i]);
        if (!options.samples.empty()) {
            for (Eigen::Index k = 0; k < e.samples().stored()[i]; ++k) {
                std::vector<double> sample;
                for (const int c : options.samples.states) sample.push_back(e.samples().state(c)(i, k));
                s.samples.push_back(sample);
            }
        }
        out.instances.push_back(s);
        out.status.push_back(e.status(i));
        out.next_step.push_back(e.next_step()[i]);
        if (!e.counted()) continue;
        out.accepted.push_back(static_cast<double>(e.accepted_steps()[i]));
        out.rejected.push_back(static_cast<double>(e.rejected_steps()[i]));
        out.evaluations.push_back(static_cast<double>(e.rhs_evaluations()[i]));
    }
    return out;
}

template <class Model, class Method, class R = double>
method_entry entry(const char* name) {
    method_entry m;
    m.name = name;
    m.precision = std::is_same_v<R, double> ? "double" : "float";
    m.eps = std::is_same_v<R, double> ? eps_double : eps_float;
    m.order = Method::order;
    m.implicit = myriad::detail::solves_linear_systems<Method>;
    m.embedded_order = myriad::detail::estimate_order<Method>;
    if constexpr (requires { Method::interpolant_order; }) m.interpolant_order = Method::interpolant_order;
    m.run = &integrate<Model, Method, R>;
    return m;
}

#define VALIDATION_ENTRY(M) entry<Model, myriad::dense<myriad::M>>(#M),
template <class Model>
std::vector<method_entry> methods_for() {
    return {VALIDATED_METHODS(VALIDATION_ENTRY)};
}
template <class Model>
std::vector<method_entry> stiff_methods_for() {
    return {VALIDATED_STIFF_METHODS(VALIDATION_ENTRY)};
}
#undef VALIDATION_ENTRY

/// Adds the methods in single precision.
template <class Model>
void add_float_methods(problem& p) {
#define VALIDATION_ENTRY(M) p.methods.push_back(entry<Model, myriad::dense<myriad::M>, float>(#M));
    VALIDATED_FLOAT_METHODS(VALIDATION_ENTRY)
#undef VALIDATION_ENTRY
}

/// The parts of a problem that follow from its model.
template <class Model>
void complete(problem& p) {
    p.methods = p.stiff ? stiff_methods_for<Model>() : methods_for<Model>();
    // Captures a copy of the problem's data only, which must not contain these functions.
    p.by_cvode = nullptr;
    const problem data = p;
    p.by_cvode = [data](const instance& i, const accuracy& how) { return solve_by_cvode<Model>(data, i, how); };
    p.conditions = [data](const instance& i) { return conditions_of<Model>(data, i); };
}

/// `count` values from first to last, both included.
inline std::vector<double> spread(double first, double last, int count) {
    std::vector<double> values;
    for (int k = 0; k < count; ++k) values.push_back(k + 1 == count ? last : first + (last - first) * k / (count - 1));
    return values;
}

}  // namespace validation
