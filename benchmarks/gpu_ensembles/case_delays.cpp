// SPDX-License-Identifier: MIT
// The cases with delays: the past in a ring per instance, whose reading and writing bounds them.
#include <algorithm>
#include <cmath>
#include <vector>

#include "cases.hpp"
#include "delayed_kuramoto.hpp"
#include "problems/delayed.hpp"
#include "reference.hpp"

namespace gpu_ensembles {
namespace {

/// Differences of the first state of the first instances from the same on the CPU.
template <class Method, class Model>
measurement measure_delays(const char* name, const problem<Model>& what, std::int64_t size,
                           const measure_options& how) {
    measurement m = measure_myriad<Method>(what, size, how, [&](const auto& found, measurement& of) {
        myriad::ensemble<Model> few(compared);
        what.fill(few);
        for (std::int64_t k = 0; k < compared; ++k)
            for (int c = 0; c < Model::n_parameter; ++c) few.parameter(c)[k] = found.parameter(c)[k];
        what.start(few);
        myriad::solve<Method>(myriad::device::cpu(), few, what.options);
        std::vector<double> errors(compared, 0.0);
        for (std::int64_t k = 0; k < compared; ++k)
            errors[static_cast<std::size_t>(k)] = std::fabs(found.state(0)[k] - few.state(0)[k]);
        set_errors(of, std::move(errors));
    });
    m.implementation = name;
    return m;
}

myriad::options fixed(std::int64_t history) { return {.step = 1e-3, .history_steps = history}; }

void fill_lorenz(myriad::ensemble<problems::delayed_lorenz>& e) {
    e.parameter(problems::delayed_lorenz::r) = Eigen::ArrayXd::LinSpaced(e.size(), 0, 50);
    e.time_domain(0, 10);
}
void start_lorenz(myriad::ensemble<problems::delayed_lorenz>& e) {
    for (int c = 0; c < 3; ++c) e.state(c) = -8;
}
template <class Model>
void fill_logistic(myriad::ensemble<Model>& e) {
    e.parameter(Model::r) = Eigen::ArrayXd::LinSpaced(e.size(), 0, Model::n_delayed == 1 ? 4 : 2);
    e.time_domain(0, 10);
}
template <class Model>
void start_logistic(myriad::ensemble<Model>& e) {
    e.state(Model::x) = 0.5;
}
void fill_ball(myriad::ensemble<problems::delayed_ball>& e) {
    const auto n = static_cast<std::int64_t>(std::lround(std::sqrt(static_cast<double>(e.size()))));
    for (std::int64_t i = 0; i < e.size(); ++i) {
        e.parameter(problems::delayed_ball::drag)[i] =
            0.1 + 1.4 * static_cast<double>(i % n) / static_cast<double>(n - 1);
        e.parameter(problems::delayed_ball::tau)[i] =
            0.1 + 1.9 * std::min(1.0, static_cast<double>(i / n) / static_cast<double>(n - 1));
    }
    e.time_domain(0, 60);
}
void start_ball(myriad::ensemble<problems::delayed_ball>& e) {
    e.state(problems::delayed_ball::v) = 0;
    e.state(problems::delayed_ball::x) = 20;
    e.integer_accessory(problems::delayed_ball::bounces) = 0;
}

std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    using namespace problems;
    using rk4 = myriad::runge_kutta_4;
    const problem<delayed_lorenz> lorenz{fixed(512), &fill_lorenz, &start_lorenz};
    const problem<delayed_lorenz> adaptive{
        {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-8, .history_steps = 256}, &fill_lorenz, &start_lorenz};
    const problem<delayed_logistic> once{fixed(1024), &fill_logistic<delayed_logistic>,
                                         &start_logistic<delayed_logistic>};
    const problem<twice_delayed_logistic> twice{fixed(2048), &fill_logistic<twice_delayed_logistic>,
                                                &start_logistic<twice_delayed_logistic>};
    const problem<delayed_ball> ball{{.relative_tolerance = 1e-6,
                                      .absolute_tolerance = 1e-6,
                                      .history_steps = 512,
                                      .events = {{.direction = myriad::direction::falling}}},
                                     &fill_ball,
                                     &start_ball};
    return {measure_delays<rk4>("lorenz runge_kutta_4", lorenz, size, how),
            measure_delays<myriad::dormand_prince_5>("lorenz dormand_prince_5", adaptive, size, how),
            measure_delays<rk4>("logistic", once, size, how),
            measure_delays<rk4>("logistic two delays", twice, size, how),
            measure_delays<myriad::dormand_prince_5>("bouncing ball", ball, size, how)};
}

template <class Model>
void fill_phases(myriad::ensemble<Model>& e) {
    using phase = typename Model::unit_type;
    constexpr int n = Model::n_unit;
    e.parameter(phase::K) = Eigen::ArrayXd::LinSpaced(e.size(), 0.2, 2);
    e.parameter(phase::tau) = Eigen::ArrayXd::LinSpaced(e.size(), 0.5, 1.5);
    for (int unit = 0; unit < n; ++unit)
        e.parameter(Model::parameter_of(unit, phase::omega)) = 1 + 0.5 * std::sin(unit);
    myriad::set_coupling(e, 0, Eigen::MatrixXd::Constant(n, n, 1.0 / n));
    e.time_domain(0, 20);
}
template <class Model>
void start_phases(myriad::ensemble<Model>& e) {
    for (int unit = 0; unit < Model::n_unit; ++unit) e.state(unit) = 0.1 * (unit * 7 % 64);
}
template <int units, int threads>
measurement measure_units(const char* name, std::int64_t size, const measure_options& how) {
    using model = delayed_phases<units, threads>;
    const problem<model> phases{{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-6, .history_steps = 128},
                                &fill_phases<model>,
                                &start_phases<model>};
    return measure_delays<myriad::dormand_prince_5>(name, phases, size, how);
}
std::vector<measurement> measure_all_units(std::int64_t size, const measure_options& how) {
    return {measure_units<64, 1>("64 units, one thread", size, how), measure_units<64, 0>("64 units, team", size, how),
            measure_units<64, 16>("64 units, team of 16", size, how),
            measure_units<100, 1>("100 units, one thread", size, how),
            measure_units<100, 0>("100 units, team", size, how)};
}

}  // namespace

benchmark_case delayed_units_case() {
    return {.name = "delayed_units",
            .work =
                "Kuramoto's oscillators with a delay, 64 and 100 of them, to t = 20 by dormand_prince_5 at 1e-6, by "
                "one thread of a GPU for each instance and by teams",
            .error = "difference of the first 64 instances from the same on the CPU",
            .allowed_error = 1e-3,
            .sizes = {1024, 8192},
            .measure = &measure_all_units};
}

benchmark_case delays_case() {
    return {.name = "delays",
            .work =
                "10 000 Runge-Kutta steps to t = 10 of Lorenz with a delay and of the logistic equation with one and "
                "two; Lorenz by dormand_prince_5 at 1e-8; a ball with a delayed drag to t = 60 at 1e-6",
            .error = "difference of the first 64 instances from the same on the CPU",
            .allowed_error = 1e-3,
            .sizes = {262'144},
            .measure = &measure};
}

}  // namespace gpu_ensembles
