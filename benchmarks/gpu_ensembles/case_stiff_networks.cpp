// SPDX-License-Identifier: MIT
// The cases stiff_<problem>: networks of 3 to 64 states by Rosenbrock methods, in double and single precision.
#include <cmath>
#include <random>
#include <string>

#include "cases.hpp"
#include "reference.hpp"
#include "stiff_networks.hpp"

namespace gpu_ensembles {
namespace {

template <class R>
void fill_pollution(myriad::ensemble<problems::pollution, R>& instances) {
    const auto last = static_cast<double>(std::max<std::int64_t>(instances.size() - 1, 1));
    for (std::int64_t i = 0; i < instances.size(); ++i)
        instances.parameter(problems::pollution::k1)[i] =
            static_cast<R>(3.5e-2 * std::pow(100.0, static_cast<double>(i) / last));
    instances.time_domain(0, static_cast<R>(problems::pollution::t_end));
}
template <class R>
void start_pollution(myriad::ensemble<problems::pollution, R>& instances) {
    for (int c = 0; c < problems::pollution::n_state; ++c)
        instances.state(c) = static_cast<R>(problems::pollution::start[c]);
}

/// As published with modax: damping 100, within a fifth, and starts at random around the limit cycle.
template <int n, class R>
void fill_ring(myriad::ensemble<problems::van_der_pol_ring<n>, R>& instances) {
    std::mt19937_64 engine(42);
    std::uniform_real_distribution<double> damping(80, 120);
    for (std::int64_t i = 0; i < instances.size(); ++i) instances.parameter(0)[i] = static_cast<R>(damping(engine));
    instances.time_domain(0, 1);
}
template <int n, class R>
void start_ring(myriad::ensemble<problems::van_der_pol_ring<n>, R>& instances) {
    std::mt19937_64 engine(43);
    std::uniform_real_distribution<double> amplitude(0.25, 3), sign(-1, 1);
    std::normal_distribution<double> velocity(0, 2);
    for (std::int64_t i = 0; i < instances.size(); ++i) {
        for (int x = 0; x < n; x += 2) {
            instances.state(x)[i] = static_cast<R>(std::copysign(amplitude(engine), sign(engine)));
            instances.state(x + 1)[i] = static_cast<R>(velocity(engine));
        }
    }
}

/// Rates within a factor of ten around Robertson's own, and starts of random composition.
template <class R>
void fill_robertson(myriad::ensemble<robertson, R>& instances) {
    constexpr double rates[] = {0.04, 1e4, 3e7};
    std::mt19937_64 engine(42);
    std::uniform_real_distribution<double> decades(-1, 1);
    for (std::int64_t i = 0; i < instances.size(); ++i)
        for (int k = 0; k < robertson::n_parameter; ++k)
            instances.parameter(k)[i] = static_cast<R>(rates[k] * std::pow(10.0, decades(engine)));
    instances.time_domain(0, R(1e5));
}
template <class R>
void start_robertson(myriad::ensemble<robertson, R>& instances) {
    std::mt19937_64 engine(43);
    std::uniform_real_distribution<double> part(0, 0.99), decades(-8, -1);
    for (std::int64_t i = 0; i < instances.size(); ++i) {
        const double a = part(engine), b = std::pow(10.0, decades(engine));
        instances.state(robertson::a)[i] = static_cast<R>((1 - b) * a);
        instances.state(robertson::b)[i] = static_cast<R>(b);
        instances.state(robertson::c)[i] = static_cast<R>((1 - b) * (1 - a));
    }
}

/// The largest component's difference of the compared instances, over max(1, |value|), from a run at 1e-10.
template <class Method, class Model, class R>
measurement measure_method(const std::string& name, const problem<Model, R>& what, std::int64_t size,
                           const measure_options& how, const std::vector<double>& truth) {
    constexpr int n = myriad::detail::n_state<Model>;
    measurement m = measure_myriad<Method>(what, size, how, [&](const auto& found, measurement& of) {
        std::vector<double> errors;
        for (std::int64_t k = 0; k < compared; ++k) {
            const std::int64_t i = compared_instance(k, size);
            double worst = 0;
            for (int c = 0; c < n; ++c) {
                const double value = truth[static_cast<std::size_t>(k * n + c)];
                worst = larger_or_nan(
                    worst, std::fabs(static_cast<double>(found.state(c)[i]) - value) / std::max(1.0, std::fabs(value)));
            }
            errors.push_back(worst);
        }
        set_errors(of, std::move(errors));
    });
    m.implementation = name;
    return m;
}

/// The states of the compared instances at the end, at a tolerance of 1e-10.
template <class Model>
std::vector<double> truth_of(problem<Model> what, std::int64_t size, const myriad::device& device) {
    myriad::ensemble<Model> all(size);
    what.fill(all);
    what.start(all);
    what.options.relative_tolerance = 1e-10;
    what.options.absolute_tolerance = 1e-12;
    myriad::solve<myriad::rodas_5p>(device, all, what.options);
    std::vector<double> states;
    for (std::int64_t k = 0; k < compared; ++k)
        for (int c = 0; c < myriad::detail::n_state<Model>; ++c)
            states.push_back(all.state(c)[compared_instance(k, size)]);
    return states;
}

myriad::options at(double relative, double absolute) {
    return {.relative_tolerance = relative, .absolute_tolerance = absolute};
}

std::vector<measurement> measure_pollution(std::int64_t size, const measure_options& how) {
    const problem<problems::pollution> fine{at(1e-6, 1e-6), &fill_pollution<double>, &start_pollution<double>};
    problem<problems::pollution> coarse = fine;
    coarse.options = at(1e-4, 1e-4);
    problem<problems::pollution> same = fine;
    same.options = at(1e-4, 1e-6);
    const problem<problems::pollution, float> single{same.options, &fill_pollution<float>, &start_pollution<float>};
    const auto truth = truth_of(fine, size, how.device);
    return {measure_method<myriad::rodas_5p>("rodas_5p 1e-6", fine, size, how, truth),
            measure_method<myriad::rosenbrock_23>("rosenbrock_23 1e-4", coarse, size, how, truth),
            measure_method<myriad::rodas_5p>("rodas_5p 1e-4", same, size, how, truth),
            measure_method<myriad::rodas_5p>("rodas_5p float 1e-4", single, size, how, truth)};
}

template <int n>
std::vector<measurement> measure_ring(std::int64_t size, const measure_options& how) {
    using model = problems::van_der_pol_ring<n>;
    const problem<model> fine{at(1e-6, 1e-8), &fill_ring<n, double>, &start_ring<n, double>};
    const auto truth = truth_of(fine, size, how.device);
    std::vector<measurement> all{measure_method<myriad::rodas_5p>("rodas_5p 1e-6", fine, size, how, truth)};
    if constexpr (n <= 32) {
        const problem<model, float> single{at(1e-4, 1e-6), &fill_ring<n, float>, &start_ring<n, float>};
        problem<model> same = fine;
        same.options = single.options;
        all.push_back(measure_method<myriad::rodas_5p>("rodas_5p 1e-4", same, size, how, truth));
        all.push_back(measure_method<myriad::rodas_5p>("rodas_5p float 1e-4", single, size, how, truth));
    }
    return all;
}

std::vector<measurement> measure_robertson(std::int64_t size, const measure_options& how) {
    const problem<robertson> fine{at(1e-6, 1e-8), &fill_robertson<double>, &start_robertson<double>};
    return {measure_method<myriad::rodas_5p>("rodas_5p 1e-6", fine, size, how, truth_of(fine, size, how.device))};
}

}  // namespace

std::vector<benchmark_case> stiff_cases() {
    const std::string error = "of 64 instances at the end, over max(1, |value|), against rodas_5p at 1e-10";
    return {{.name = "stiff_pollution",
             .work = "20 states to t = 60, the rate of the first reaction over two decades",
             .error = error,
             .allowed_error = 1e-3,
             .sizes = {1000, 131'072},
             .measure = &measure_pollution},
            {.name = "stiff_ring_8",
             .work = "4 van der Pol oscillators in a ring to t = 1",
             .error = error,
             .allowed_error = 5e-2,
             .sizes = {1000, 131'072},
             .measure = &measure_ring<8>},
            {.name = "stiff_ring_32",
             .work = "16 van der Pol oscillators in a ring to t = 1",
             .error = error,
             .allowed_error = 5e-2,
             .sizes = {1000, 32'768},
             .measure = &measure_ring<32>},
            {.name = "stiff_ring_64",
             .work = "32 van der Pol oscillators in a ring to t = 1",
             .error = error,
             .allowed_error = 5e-2,
             .sizes = {1000},
             .measure = &measure_ring<64>},
            {.name = "stiff_robertson",
             .work = "Robertson's reactions to t = 1e5, each rate over two decades",
             .error = error,
             .allowed_error = 1e-3,
             .sizes = {100'000},
             .measure = &measure_robertson}};
}

}  // namespace gpu_ensembles
