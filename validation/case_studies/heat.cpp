// SPDX-License-Identifier: MIT
// Heat conduction around a bubble: without flow of liquid against the slowest mode in closed form; with flow, heat
// flows and temperatures against CVODE on twice the points. Exit status 1 if a difference exceeds its bound.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <vector>

#include <myriad/kernel/model/lane.hpp>
#include <myriad/myriad.hpp>

#include "cvode.hpp"
#include "shell.hpp"

namespace {

constexpr double tolerance = 1e-9, outer = shell::outer;
bool all_well = true;

void expect_below(const char* what, double diffusivity, double error, double bound) {
    const bool well = error <= bound;  // false for NaN
    all_well = all_well && well;
    std::cout << what << ", diffusivity " << diffusivity << ": " << error << " (at most " << bound << ")"
              << (well ? "\n" : " FAILED\n");
}

/// One instance after so many phases, by Myriad on 24 points.
struct solution {
    Eigen::ArrayXd temperature;  // at all points
    double heat = 0;             // in the last period
};
solution by_myriad(const Eigen::ArrayXd& start, double wall, double diffusivity, double pulse, std::int64_t phases) {
    myriad::ensemble<heat_24> one(1);
    const Eigen::ArrayXd shared = shell::shared_values<24>(wall);
    for (int s = 0; s < heat_24::n_shared; ++s) one.shared(s) = shared[s];
    for (int c = 0; c < heat_24::inner; ++c) one.state(heat_24::temperature + c) = start[c + 1];
    one.state(heat_24::heat) = 0;
    one.parameter(heat_24::diffusivity) = diffusivity;
    one.parameter(heat_24::through) = 0;
    one.parameter(heat_24::pulse) = pulse;
    one.time_domain(0, 1.0 / heat_24::phases_per_period);
    const auto report = myriad::solve<myriad::tsitouras_5>(
        myriad::device::cpu(), one,
        {.phases = phases,
         .relative_tolerance = tolerance,
         .absolute_tolerance = tolerance,
         .record = {.from_phase = phases - heat_24::phases_per_period, .states = {heat_24::heat}}});
    solution s{Eigen::ArrayXd::Zero(24), report.records.state(heat_24::heat).sum()};
    s.temperature[0] = wall;
    for (int c = 0; c < heat_24::inner; ++c) s.temperature[c + 1] = one.state(heat_24::temperature + c)[0];
    return s;
}

/// The same by CVODE, with the model's own right-hand side on `points` points.
template <int points>
solution by_cvode(double diffusivity, double pulse, int periods) {
    using model = heat_conduction<points>;
    const Eigen::ArrayXd shared = shell::shared_values<points>(1);
    myriad::inputs<model, double> p{};
    p.parameter[model::diffusivity] = diffusivity;
    p.parameter[model::through] = 0;
    p.parameter[model::pulse] = pulse;
    p.shared = shared.data();
    validation::cvode solver(
        model::n_state,
        [&](double t, const double* y, double* dy) {
            myriad::vec<double, model::n_state> state;
            std::copy(y, y + model::n_state, &state[0]);
            const auto slope = model::template rhs<double>(t, state, p);
            std::copy(&slope[0], &slope[0] + model::n_state, dy);
        },
        1e-10, 1e-11, validation::multistep::bdf);
    const Eigen::ArrayXd start = shell::still_temperature(chebyshev::points(1, outer, points));
    std::vector<double> state(start.data() + 1, start.data() + points - 1);
    state.push_back(0);
    solver.start(0, state);
    solver.advance(periods - 1);
    const double before = solver.y(model::heat);
    solver.advance(periods);
    solution s{Eigen::ArrayXd::Zero(points), solver.y(model::heat) - before};
    s.temperature[0] = 1;
    for (int c = 0; c < model::inner; ++c) s.temperature[c + 1] = solver.y(static_cast<std::size_t>(c));
    return s;
}

/// The error of 24 points. Next to the wall a layer decays like exp(-(r - 1) z) with z = pulse / diffusivity for a
/// pulse of one; its Chebyshev coefficient k is of size exp(-k^2 / (2 z)) / sqrt(2 pi z) on a shell of thickness two,
/// and its slope at the wall k^2 times that. Four of them, plus the steps' errors.
double missed(double diffusivity) {
    const double z = 1 / diffusivity, k = 24;
    return 4 * k * k * std::exp(-k * k / (2 * z)) / std::sqrt(2 * std::numbers::pi * z) + 100 * tolerance;
}

}  // namespace

int main() {
    const Eigen::ArrayXd r = chebyshev::points(1, outer, 24);
    for (const double diffusivity : {0.05, 0.3, 2.0}) {
        // Without flow of liquid, and with walls at zero. Stability makes steps so short that only the errors of 24
        // points and of rounding remain: a sine is a polynomial of degree 23 to 1e-15.
        const Eigen::ArrayXd mode = shell::slowest_mode(r);
        const double k = std::numbers::pi / (outer - 1), t = 1;
        const Eigen::ArrayXd exact = mode * std::exp(-diffusivity * k * k * t);
        const auto decayed = by_myriad(mode, 0, diffusivity, 0, heat_24::phases_per_period);
        expect_below("slowest mode", diffusivity, (decayed.temperature - exact).abs().maxCoeff(), 10 * tolerance);

        const auto here = by_myriad(shell::still_temperature(r), 1, diffusivity, 1, 2 * heat_24::phases_per_period);
        const auto same = by_cvode<24>(diffusivity, 1, 2);
        expect_below("heat flow, CVODE on 24 points", diffusivity, std::abs(here.heat - same.heat), 100 * tolerance);
        const auto finer = by_cvode<48>(diffusivity, 1, 2);
        expect_below("heat flow, CVODE on 48 points", diffusivity, std::abs(here.heat - finer.heat),
                     missed(diffusivity));
        const Eigen::MatrixXd P = chebyshev::interpolation_matrix(chebyshev::points(1, outer, 48), r);
        expect_below("temperature, CVODE on 48 points", diffusivity,
                     ((P * finer.temperature.matrix()).array() - here.temperature).abs().maxCoeff(),
                     missed(diffusivity));
    }
    std::cout << (all_well ? "All checks passed.\n" : "A check FAILED.\n");
    return all_well ? EXIT_SUCCESS : EXIT_FAILURE;
}
