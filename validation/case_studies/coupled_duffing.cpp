// SPDX-License-Identifier: MIT
// Rings of coupled Duffing oscillators against CVODE: states after periods of the forcing, and the second local maximum
// of each oscillator by root finding. Exit status 0 if all agree, else 1.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <vector>

#include "cvode.hpp"
#include "sweep.hpp"

namespace {

using namespace ring_sweep;
constexpr int n = ring::n_unit;

struct outcome {
    std::vector<double> state;           ///< after the last period
    std::vector<double> second_maximum;  ///< of each oscillator
};

outcome by_cvode(std::vector<double> y, std::int64_t periods) {
    validation::cvode solution(
        2 * n,
        [](double t, const double* u, double* du) {
            const double force = amplitude * std::cos(frequency * t);
            for (int i = 0; i < n; ++i) {
                const double *left = u + 2 * ((i + n - 1) % n), *right = u + 2 * ((i + 1) % n), x = u[2 * i],
                             v = u[2 * i + 1];
                du[2 * i] = v + strength * ((left[0] + right[0]) / 2 - x);
                du[2 * i + 1] = -damping * v + x - x * x * x + force + strength * ((left[1] + right[1]) / 2 - v);
            }
        },
        1e-12, 1e-12);
    solution.watch(std::vector<int>(n, -1), [](double, const double* u, double* g) {
        for (int i = 0; i < n; ++i) g[i] = u[2 * i + 1];
    });
    outcome found{{}, std::vector<double>(n)};
    for (int i = 0; i < n; ++i) found.second_maximum[static_cast<std::size_t>(i)] = y[static_cast<std::size_t>(2 * i)];
    std::vector<int> maxima(n, 0);
    solution.start(0, y);
    const double end = static_cast<double>(periods) * period;
    while (solution.advance(end)) {
        const auto which = solution.found();
        for (std::size_t i = 0; i < n; ++i)
            if (which[i] != 0 && ++maxima[i] == 2) found.second_maximum[i] = solution.y(2 * i);
    }
    found.state = solution.state();
    return found;
}

}  // namespace

int main() {
    // Nearby rings move apart within some periods: two show every part of the model, and the error of a step, 1e-8 at
    // some 1000 steps, has grown little.
    constexpr std::int64_t periods = 2;
    constexpr double allowed = 1e-5;
    auto sweep = prepare(25);
    std::vector<std::vector<double>> starts;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        starts.emplace_back();
        for (int c = 0; c < ring::n_state; ++c) starts.back().push_back(sweep.state(c)[i]);
    }
    myriad::options options = settings(periods);
    options.phase_step = myriad::phase_step::carry_on;
    myriad::solve<myriad::cash_karp>(myriad::device::parse("cpu"), sweep, options);
    double worst = 0, worst_maximum = 0;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const outcome expected = by_cvode(starts[static_cast<std::size_t>(i)], periods);
        const auto larger = [](double& of, double error) { of = std::isnan(error) ? 1e9 : std::max(of, error); };
        for (int c = 0; c < ring::n_state; ++c)
            larger(worst, std::abs(sweep.state(c)[i] - expected.state[static_cast<std::size_t>(c)]));
        for (int unit = 0; unit < n; ++unit)
            larger(worst_maximum, std::abs(sweep.accessory(ring::accessory_of(unit, oscillator::second_maximum))[i] -
                                           expected.second_maximum[static_cast<std::size_t>(unit)]));
    }
    std::cout << sweep.size() << " rings after " << periods << " periods: states within " << worst
              << " of CVODE, second maxima within " << worst_maximum << '\n';
    return worst < allowed && worst_maximum < allowed ? 0 : 1;
}
