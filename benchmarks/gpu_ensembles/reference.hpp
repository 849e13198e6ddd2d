// SPDX-License-Identifier: MIT
// The references for results: classic Runge-Kutta steps of Lorenz' equations in long double, and the differences.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "measure.hpp"
#include "models.hpp"

namespace gpu_ensembles {

/// Number of compared instances, spread evenly over the ensemble, both ends included.
inline constexpr std::int64_t compared = 64;
inline std::int64_t compared_instance(std::int64_t number, std::int64_t size, std::int64_t count = compared) {
    return number * (size - 1) / std::max<std::int64_t>(count - 1, 1);
}

/// `count` instances, spread evenly over the `size` of a problem, at their start.
template <class Model>
myriad::ensemble<Model> spread_instances(const problem<Model>& what, std::int64_t size, std::int64_t count = compared) {
    myriad::ensemble<Model> all(size), few(count);
    what.fill(all);
    what.fill(few);  // values common to all instances
    for (int c = 0; c < myriad::detail::n_parameter<Model>; ++c)
        for (std::int64_t k = 0; k < count; ++k)
            few.parameter(c)[k] = all.parameter(c)[compared_instance(k, size, count)];
    what.start(few);
    return few;
}

using exact_state = std::array<long double, 3>;

/// The state after `steps` classic Runge-Kutta steps of length h.
inline exact_state lorenz_reference(double rho, const exact_state& start, std::int64_t steps, long double h) {
    const auto slope = [rho](const exact_state& s) {
        return exact_state{10 * (s[1] - s[0]), rho * s[0] - s[1] - s[0] * s[2], s[0] * s[1] - 8.0L / 3 * s[2]};
    };
    const auto advance = [](const exact_state& s, long double length, const exact_state& k) {
        return exact_state{s[0] + length * k[0], s[1] + length * k[1], s[2] + length * k[2]};
    };
    exact_state s = start;
    for (std::int64_t i = 0; i < steps; ++i) {
        exact_state k = slope(s), sum = advance(s, h / 6, k);
        k = slope(advance(s, h / 2, k));
        sum = advance(sum, h / 3, k);
        k = slope(advance(s, h / 2, k));
        sum = advance(sum, h / 3, k);
        k = slope(advance(s, h, k));
        s = advance(sum, h / 6, k);
    }
    return s;
}

/// The larger of two errors; NaN if one is.
inline double larger_or_nan(double a, double b) { return a != a || b <= a ? a : b; }

/// Sets the maximum of the errors, which is NaN if one of them is, and their median.
inline void set_errors(measurement& m, std::vector<double> errors) {
    m.max_error = 0;
    for (double& e : errors) {
        m.max_error = larger_or_nan(m.max_error, e);
        if (e != e) e = std::numeric_limits<double>::infinity();  // NaN cannot be sorted
    }
    m.median_error = median(std::move(errors));
}

/// All but the largest tenth of the errors, of instances in which small ones grow; all if one is NaN.
inline std::vector<double> without_largest_tenth(std::vector<double> errors) {
    if (std::any_of(errors.begin(), errors.end(), [](double e) { return e != e; })) return errors;
    std::sort(errors.begin(), errors.end());
    errors.resize(errors.size() - errors.size() / 10);
    return errors;
}

/// One phase of the 64 compared instances of an ensemble of `size` on the device and on the CPU: for each, the
/// difference in its worst component, over max(1, |value|); NaN if they ended differently.
template <class Method, class Model>
std::vector<double> differences_from_cpu(const problem<Model>& what, std::int64_t size, const myriad::device& device) {
    const auto integrated_on = [&](const myriad::device& where) {
        auto few = spread_instances(what, size);
        myriad::options options = what.options;
        options.phases = 1;
        myriad::solve<Method>(where, few, options);
        return few;
    };
    const auto here = integrated_on(device), there = integrated_on(myriad::device::cpu());
    std::vector<double> differences;
    for (std::int64_t k = 0; k < compared; ++k) {
        double worst = here.status(k) == there.status(k) ? 0 : std::nan("");
        for (int c = 0; c < myriad::detail::n_state<Model>; ++c) {
            const double value = there.state(c)[k], difference = std::fabs(here.state(c)[k] - value);
            worst = larger_or_nan(worst, difference / std::max(1.0, std::fabs(value)));
        }
        differences.push_back(worst);
    }
    return differences;
}

}  // namespace gpu_ensembles
