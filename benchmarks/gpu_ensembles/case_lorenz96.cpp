// SPDX-License-Identifier: MIT
// The cases lorenz96_<states>: Lorenz 96 as one model and as coupled units, in double and single precision.
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "cases.hpp"
#include "lorenz96.hpp"
#include "reference.hpp"

namespace gpu_ensembles {
namespace {

double forcing(std::int64_t instance, std::int64_t size) {
    return 16 * static_cast<double>(instance) / static_cast<double>(std::max<std::int64_t>(size - 1, 1));
}
template <class Model, class R>
void fill(myriad::ensemble<Model, R>& instances) {
    for (std::int64_t i = 0; i < instances.size(); ++i)
        instances.parameter(0)[i] = static_cast<R>(forcing(i, instances.size()));
    instances.time_domain(0, 1);
}
constexpr double first_state(int c) { return c == 0 ? 9 : 8; }
template <class Model, class R>
void start(myriad::ensemble<Model, R>& instances) {
    for (int c = 0; c < Model::n_state; ++c) instances.state(c) = static_cast<R>(first_state(c));
}

/// The states at t = 1, by classic Runge-Kutta steps in double precision.
std::vector<double> reference(int n, double F) {
    constexpr int steps = 2000;
    constexpr double h = 1.0 / steps;
    const auto count = static_cast<std::size_t>(n);
    std::vector<double> x, at(count), slope(count), sum(count);
    for (int c = 0; c < n; ++c) x.push_back(first_state(c));
    const auto find_slope = [&](const std::vector<double>& y) {
        for (std::size_t i = 0; i < count; ++i)
            slope[i] = (y[(i + 1) % count] - y[(i + count - 2) % count]) * y[(i + count - 1) % count] - y[i] + F;
    };
    for (int step = 0; step < steps; ++step) {
        at = sum = x;
        for (int stage = 0; stage < 4; ++stage) {
            find_slope(at);
            const double weight = stage == 0 || stage == 3 ? h / 6 : h / 3, next = stage < 2 ? h / 2 : h;
            for (std::size_t i = 0; i < count; ++i) {
                sum[i] += weight * slope[i];
                at[i] = x[i] + next * slope[i];
            }
        }
        x = sum;
    }
    return x;
}
/// Those of all compared instances.
std::vector<std::vector<double>> references(int n, std::int64_t size) {
    std::vector<std::vector<double>> all;
    for (std::int64_t k = 0; k < compared; ++k) all.push_back(reference(n, forcing(compared_instance(k, size), size)));
    return all;
}

template <class Model, class R, class Method = myriad::tsitouras_5>
measurement measure(const char* name, double tolerance, std::int64_t size, const measure_options& how,
                    const std::vector<std::vector<double>>& truth) {
    const problem<Model, R> what{
        {.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, &fill<Model, R>, &start<Model, R>};
    measurement m = measure_myriad<Method>(what, size, how, [&](const auto& found, measurement& of) {
        std::vector<double> errors;
        for (std::int64_t k = 0; k < compared; ++k) {
            double worst = 0;
            for (int c = 0; c < Model::n_state; ++c) {
                const double value = truth[static_cast<std::size_t>(k)][static_cast<std::size_t>(c)];
                const double is = static_cast<double>(found.state(c)[compared_instance(k, size)]);
                worst = larger_or_nan(worst, std::fabs(is - value) / std::max(1.0, std::fabs(value)));
            }
            errors.push_back(worst);
        }
        set_errors(of, std::move(errors));
    });
    m.implementation = name;
    return m;
}

template <int n>
std::vector<measurement> measure_size(std::int64_t size, const measure_options& how) {
    const auto truth = references(n, size);
    std::vector<measurement> all;
    if constexpr (n <= 32) {
        all.push_back(measure<lorenz96<n>, double>("whole 1e-6", 1e-6, size, how, truth));
        all.push_back(measure<lorenz96<n>, float>("whole float 1e-4", 1e-4, size, how, truth));
        all.push_back(measure<lorenz96<n>, double, tsitouras_5_rms>("whole rms 1e-6", 1e-6, size, how, truth));
        all.push_back(measure<lorenz96<n>, float, tsitouras_5_rms>("whole rms float 1e-4", 1e-4, size, how, truth));
    }
    if constexpr (n >= 16) {
        all.push_back(measure<lorenz96_units<n>, double>("units 1e-6", 1e-6, size, how, truth));
        all.push_back(measure<lorenz96_units<n>, float>("units float 1e-4", 1e-4, size, how, truth));
    }
    return all;
}
template <int n>
benchmark_case case_of() {
    return {.name = "lorenz96_" + std::to_string(n),
            .work = "Lorenz 96 with " + std::to_string(n) + " states to t = 1 by tsitouras_5, F = linspace(0, 16, N)",
            .error = "of 64 instances against 2000 classic Runge-Kutta steps, over max(1, |value|)",
            .allowed_error = 2,  // chaotic for F = 16: 0.33 in single precision, 1.6 with tsitouras_5_rms
            .sizes = {131'072},
            .measure = &measure_size<n>};
}

}  // namespace

std::vector<benchmark_case> lorenz96_cases() {
    return {case_of<4>(),   case_of<8>(),   case_of<16>(),  case_of<32>(),  case_of<64>(),
            case_of<128>(), case_of<256>(), case_of<512>(), case_of<1024>()};
}

}  // namespace gpu_ensembles
