// SPDX-License-Identifier: MIT
// Finds out, after an explicit method has run, whether stability rather than accuracy limited its steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "myriad/core/static_for.hpp"
#include "myriad/ensemble/inputs_of.hpp"
#include "myriad/stepper/step.hpp"

namespace myriad::host {

/// The stability function of an explicit method at a real z: what a step makes of y' = z y / h. Hairer, Wanner, Solving
/// ODE II, IV.2, eq. (2.9).
template <class Method>
double stability_function(double z) {
    constexpr auto t = Method::tableau();
    double slope[Method::stages], y = 1;
    for (int i = 0; i < Method::stages; ++i) {
        double argument = 1;
        for (int j = 0; j < i; ++j) argument += z * t.weight(i, j) * slope[j];
        slope[i] = argument;
        y += z * t.weight(Method::stages, i) * argument;
    }
    return y;
}

/// The largest x such that steps are stable for y' = -z y / h with all z up to x.
template <class Method>
double real_stability_limit() {
    double x = 0.01;
    while (x < 100 && std::abs(stability_function<Method>(-x)) <= 1) x += 0.01;
    return x;
}

/// The step that an instance would take next, signed: no longer than its domain.
template <class Model, class R>
double step_of(const ensemble<Model, R>& e, std::int64_t i) {
    const double h = static_cast<double>(e.next_step()[i]);
    const double domain = std::abs(static_cast<double>(e.t_end_of(i)) - static_cast<double>(e.t_begin_of(i)));
    return std::copysign(std::min(std::abs(h), domain), h);
}

/// What the fastest mode of an instance is to its next step, h lambda, if that mode decays without turning round more than it
/// decays; 0 if not.
template <class Model, class R>
double fastest_decay(ensemble<Model, R>& e, std::int64_t i) {
    constexpr int n = n_state<Model>;
    const auto p = inputs_of(e, i);
    const R t = e.t()[i];
    vec<R, n> y, v;
    for (int c = 0; c < n; ++c) {
        y[c] = e.state(c)[i];
        v[c] = R(1) / static_cast<R>(c + 1);  // no mode is likely to be orthogonal to it
    }
    const auto f = evaluate_rhs<Model>(t, y, p);
    const double root = std::sqrt(static_cast<double>(epsilon_of<R>));
    const auto length = [](const vec<R, n>& x) {
        double sum = 0;
        for (int c = 0; c < n; ++c) sum += static_cast<double>(x[c]) * static_cast<double>(x[c]);
        return std::sqrt(sum);
    };
    // Power iteration with differences for the Jacobian; a geometric mean, because complex pairs turn the vector.
    constexpr int settling = 12, iterations = 24;
    double logarithms = 0, along = 0;
    for (int k = 0; k < iterations; ++k) {
        const double scale = 1 / length(v);
        double step = std::numeric_limits<double>::infinity();  // no component moves by more than root of its size
        for (int c = 0; c < n; ++c) {
            v[c] = static_cast<R>(static_cast<double>(v[c]) * scale);
            const double size = y[c] == R(0) ? 1 : std::abs(static_cast<double>(y[c]));
            if (std::abs(static_cast<double>(v[c])) > 1e-6)
                step = std::min(step, root * size / std::abs(static_cast<double>(v[c])));
        }
        vec<R, n> moved;
        for (int c = 0; c < n; ++c)
            moved[c] = static_cast<R>(static_cast<double>(y[c]) + step * static_cast<double>(v[c]));
        const auto f_moved = evaluate_rhs<Model>(t, moved, p);
        along = 0;
        vec<R, n> product;
        for (int c = 0; c < n; ++c) {
            product[c] = static_cast<R>(static_cast<double>(f_moved[c] - f[c]) / step);
            along += static_cast<double>(product[c]) * static_cast<double>(v[c]);
        }
        v = product;
        if (k >= settling) logarithms += std::log(length(v));
        if (!(length(v) > 0)) return 0;
    }
    const double rate = std::exp(logarithms / (iterations - settling));
    const double h = step_of(e, i);
    const bool decays = h * along < 0 && std::abs(along) > 0.7 * rate;
    return decays ? std::abs(h) * rate : 0;
}

struct stiffness {
    std::int64_t looked_at = 0;
    std::int64_t limited = 0;  // by stability
    double share = 0;          // largest h lambda over the stability limit
};

/// Looks at 64 or so instances, where they now are. Steps that stability limits hover about its limit; those that accuracy
/// limits resolve the fastest mode and stay well below.
template <class Method, class Model, class R>
stiffness find_stiffness(ensemble<Model, R>& e, double maximum_step) {
    stiffness found;
    const double limit = real_stability_limit<Method>();
    const std::int64_t stride = std::max<std::int64_t>(e.size() / 64, 1);
    for (std::int64_t i = 0; i < e.size(); i += stride) {
        const double h = std::abs(step_of(e, i));
        if (!std::isfinite(h) || h >= maximum_step) continue;
        ++found.looked_at;
        const double share = fastest_decay(e, i) / limit;
        if (!(share > 0.5)) continue;
        ++found.limited;
        found.share = std::max(found.share, share);
    }
    return found;
}

}  // namespace myriad::host
