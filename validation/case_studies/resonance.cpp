// SPDX-License-Identifier: MIT
// Both branches of the nonlinear resonance curve against CVODE, which stops at the extrema by root finding. Exit status
// 0 if all agree, else 1.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <vector>

#include "../../examples/common/phases.hpp"
#include "cvode.hpp"
#include "sweep.hpp"

namespace {

constexpr std::int64_t frequencies = 12, transient = 200;

double largest_by_cvode(double omega, double beta, double v_start) {
    validation::cvode oscillator(
        2,
        [=](double t, const double* y, double* dy) {
            dy[0] = y[1];
            dy[1] = std::cos(omega * t) - 2 * resonance::zeta * y[1] - y[0] - beta * y[0] * y[0] * y[0];
        },
        1e-11, 1e-12);
    oscillator.watch({-1}, [](double, const double* y, double* g) { g[0] = y[1]; });
    oscillator.start(0, {0, v_start});
    const double period = 2 * std::numbers::pi / omega, t_begin = static_cast<double>(transient) * period;
    while (oscillator.advance(t_begin)) {
    }
    double largest = oscillator.y(0);
    while (oscillator.advance(t_begin + period)) largest = std::max(largest, oscillator.y(0));
    return largest;
}

}  // namespace

int main() {
    auto sweep = resonance::prepare<response>(frequencies);
    const std::vector<double> v_start(sweep.state(response::v).begin(), sweep.state(response::v).end());
    auto options = examples::smooth_phases(transient, resonance::tolerance);
    options.events = {{.tolerance = resonance::event_tolerance}};
    resonance::begin_response(sweep);
    const auto device = myriad::device::parse("cpu");
    myriad::solve<myriad::tsitouras_5>(device, sweep, options);
    resonance::begin_response(sweep);
    options.phases = 1;
    myriad::solve<myriad::tsitouras_5>(device, sweep, options);

    // Errors of a step, 1e-10 of the amplitude at some 100 steps per period, live for some periods. 1e-7 leaves room
    // for the folds, where they live longer; the transient, exp(-zeta t), is at most 9e-18.
    constexpr double allowed = 1e-7;
    double worst = 0;
    int two_branches = 0;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const double omega = sweep.parameter(response::omega)[i], beta = sweep.parameter(response::beta)[i];
        const double found = sweep.accessory(response::maximum)[i];
        const double expected = largest_by_cvode(omega, beta, v_start[static_cast<std::size_t>(i)]);
        const double error = std::abs(found / expected - 1);
        worst = std::isnan(error) ? 1 : std::max(worst, error);
        const bool upper = i / frequencies % resonance::starts == 1;
        two_branches += upper && found > 2 * sweep.accessory(response::maximum)[i - frequencies];
        if (!(error < allowed))
            std::cout << "beta " << beta << ", omega " << omega << ": " << found << ", CVODE " << expected << '\n';
    }
    std::cout << sweep.size() << " responses, " << two_branches
              << " pairs on two branches; largest relative difference from CVODE " << worst << '\n';
    return worst < allowed && two_branches > 0 ? 0 : 1;
}
