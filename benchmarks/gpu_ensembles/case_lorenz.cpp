// SPDX-License-Identifier: MIT
// The cases of Lorenz' equations: classic Runge-Kutta steps against the hand-written kernel, and Tsitouras' method.
#include <cmath>
#include <cstdio>

#include "by_hand.hpp"
#include "cases.hpp"
#include "models.hpp"
#include "reference.hpp"

namespace gpu_ensembles {
namespace {

constexpr int steps = 1000;
constexpr double h = 1e-3;

Eigen::ArrayXd range_of_rho(std::int64_t size) { return Eigen::ArrayXd::LinSpaced(size, 0, 21); }

template <class Model>
void fill(myriad::ensemble<Model>& instances) {
    instances.parameter(Model::rho) = range_of_rho(instances.size());
    instances.time_domain(0, 1);
}
template <class Model>
void start_at_ten(myriad::ensemble<Model>& instances) {
    for (const auto c : {Model::x, Model::y, Model::z}) instances.state(c) = 10;
}
void start_at_one(myriad::ensemble<lorenz>& instances) {
    instances.state(lorenz::x) = 1;
    instances.state(lorenz::y) = 0;
    instances.state(lorenz::z) = 0;
}

template <class Model>
problem<Model> fixed_steps() {
    return {{.step = h}, &fill<Model>, &start_at_ten<Model>};
}

constexpr exact_state tens{10, 10, 10}, ones{1, 0, 0};

/// The largest difference of a component, over max(1, |value|).
double worst_component(const exact_state& found, const exact_state& exact) {
    double worst = 0;
    for (std::size_t c = 0; c < exact.size(); ++c) {
        const long double error = std::fabs(found[c] - exact[c]) / std::max(1.0L, std::fabs(exact[c]));
        worst = larger_or_nan(worst, static_cast<double>(error));
    }
    return worst;
}
/// The norm of the difference over that of the value, as single components cross zero.
double relative_length(const exact_state& found, const exact_state& exact) {
    const auto length = [](const exact_state& s) { return std::hypot(s[0], s[1], s[2]); };
    const exact_state difference{found[0] - exact[0], found[1] - exact[1], found[2] - exact[2]};
    return static_cast<double>(length(difference) / length(exact));
}

/// The error of every compared instance, with results from `state(component, instance)`, against `count` reference
/// steps.
template <class State, class Error>
std::vector<double> errors_of(std::int64_t size, State&& state, const exact_state& start, std::int64_t count,
                              Error&& error) {
    const Eigen::ArrayXd rho = range_of_rho(size);
    std::vector<double> errors;
    for (std::int64_t k = 0; k < compared; ++k) {
        const std::int64_t i = compared_instance(k, size);
        const exact_state exact = lorenz_reference(rho[i], start, count, 1.0L / static_cast<long double>(count));
        errors.push_back(error({state(0, i), state(1, i), state(2, i)}, exact));
    }
    return errors;
}

measurement measure_by_hand(std::int64_t size, const measure_options& how) {
    measurement m{.implementation = "by_hand", .instances = size};
    lorenz_by_hand kernel(how.device.number(), size, eight_thirds::b);
    const auto start = [&] { std::fill_n(kernel.state(), 3 * size, 10.0); };
    Eigen::Map<Eigen::ArrayXd>(kernel.parameter(), size) = range_of_rho(size);
    start();
    kernel.choose_block(steps, h);
    warm_up([&] {
        start();
        kernel.run(steps, h);
    });
    std::vector<double> alone, all;
    for (int i = 0; i < how.repetitions; ++i) {
        start();
        const auto [kernel_ms, end_to_end_ms] = kernel.run(steps, h);
        alone.push_back(kernel_ms);
        all.push_back(end_to_end_ms);
    }
    m.kernel_ms = m.counting_kernel_ms = median(alone);
    m.end_to_end_ms = median(all);
    m.accepted_steps = steps * size;
    m.rhs_evaluations = 4 * steps * size;
    const auto used = kernel.kernel();
    m.registers = used.registers;
    m.block_size = used.block_size;
    m.local_bytes = used.local_bytes;
    const auto state = [&](int c, std::int64_t i) { return kernel.state()[c * size + i]; };
    set_errors(m, errors_of(size, state, tens, steps, worst_component));
    return m;
}

std::vector<measurement> measure_fixed(std::int64_t size, const measure_options& how) {
    const auto inspect = [size](const myriad::ensemble<lorenz>& instances, measurement& m) {
        set_errors(
            m, errors_of(
                   size, [&](int c, std::int64_t i) { return instances.state(c)[i]; }, tens, steps, worst_component));
    };
    std::vector<measurement> all = {measure_myriad<myriad::runge_kutta_4>(fixed_steps<lorenz>(), size, how, inspect)};
    if (how.device.which() == myriad::device::kind::cuda) all.push_back(measure_by_hand(size, how));
    return all;
}

/// One method at one tolerance.
template <class Method>
measurement measure_method(double tolerance, std::int64_t size, const measure_options& how, double first_step = 0.01) {
    const problem<lorenz> what{
        {.relative_tolerance = tolerance, .absolute_tolerance = tolerance / 1000, .step = first_step},
        &fill<lorenz>,
        &start_at_one};
    return measure_myriad<Method>(what, size, how, [size](const myriad::ensemble<lorenz>& instances, measurement& m) {
        set_errors(
            m, errors_of(
                   size, [&](int c, std::int64_t i) { return instances.state(c)[i]; }, ones, 20'000, relative_length));
    });
}

template <class Method>
measurement measure_method(const char* name, double tolerance, std::int64_t size, const measure_options& how,
                           double first_step = 0.01) {
    measurement m = measure_method<Method>(tolerance, size, how, first_step);
    m.implementation = name;
    return m;
}

/// Alternatives with errors below those of Tsitouras' method at 1e-3, 1e-6 and 1e-8.
std::vector<measurement> measure_methods(std::int64_t size, const measure_options& how) {
    return {measure_method<myriad::tsitouras_5>("tsitouras_5 1.35e-3 first step 0.04", 1.35e-3, size, how, 0.04),
            measure_method<myriad::verner_7>("verner_7 6e-6", 6e-6, size, how),
            measure_method<myriad::verner_7>("verner_7 5e-8", 5e-8, size, how),
            measure_method<myriad::dormand_prince_8>("dormand_prince_8 1e-6", 1e-6, size, how),
            measure_method<myriad::dormand_prince_8>("dormand_prince_8 6e-9", 6e-9, size, how)};
}

}  // namespace

std::vector<benchmark_case> lorenz_cases() {
    std::vector<benchmark_case> all = {
        {.name = "lorenz_rk4",
         .work = "1000 steps of 1e-3, start (10, 10, 10), rho = linspace(0, 21, N), b = 8/3",
         .error = "of 64 instances against the same steps in long double, over max(1, |value|)",
         .allowed_error = 1e-10,
         .sizes = {8192, 65536, 768'000, 4'194'304},
         .measure = &measure_fixed}};
    const std::string start = "start (1, 0, 0), t in [0, 1], ";
    const std::string first = ", atol rtol/1000, first step 0.01, rho = linspace(0, 21, N), b = 8/3";
    const std::string distance =
        "of 64 instances against 20000 classic Runge-Kutta steps in long double, length of the "
        "difference over that of the value";
    for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
        char text[16];
        std::snprintf(text, sizeof text, "%.0e", tolerance);
        // the C library's 1e-03 becomes 1e-3
        std::string exponent(text);
        exponent.erase(3, 1);
        all.push_back({.name = "lorenz_tsit5_" + exponent,
                       .work = start + "rtol " + exponent + first,
                       .error = distance,
                       .allowed_error = 10 * tolerance,
                       .sizes = {32768, 65536, 131'072, 262'144, 524'288},
                       .measure = [tolerance](std::int64_t size, const measure_options& how) {
                           return std::vector{measure_method<myriad::tsitouras_5>(tolerance, size, how)};
                       }});
    }
    all.push_back({.name = "lorenz_methods",
                   .work = start + "by method and rtol" + first,
                   .error = distance,
                   .allowed_error = 1e-1,
                   .sizes = {32768, 524'288},
                   .measure = &measure_methods});
    return all;
}

std::vector<check_value> check_lorenz(const myriad::device& device) {
    constexpr std::int64_t size = 8192;
    const auto what = fixed_steps<tutorial_lorenz>();
    myriad::ensemble<tutorial_lorenz> instances(size);
    what.fill(instances);
    what.start(instances);
    const auto report = myriad::solve<myriad::runge_kutta_4>(device, instances, what.options);
    using model = tutorial_lorenz;
    return {{"lorenz sum of x", instances.state(model::x).sum(), 38485.28, 0.00501},
            {"lorenz sum of y", instances.state(model::y).sum(), 45229.52, 0.00501},
            {"lorenz sum of z", instances.state(model::z).sum(), 71970.47, 0.00501},
            {"lorenz evaluations per instance", static_cast<double>(report.rhs_evaluations) / size, 4 * steps, 0}};
}

}  // namespace gpu_ensembles
