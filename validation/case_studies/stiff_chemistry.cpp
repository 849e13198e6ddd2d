// SPDX-License-Identifier: MIT
// Periods and extreme values of the Oregonator's limit cycles against CVODE's BDF, and its states of rest. Exit status
// 0 if all is well, else 1.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>

#include <myriad/myriad.hpp>

#include "cvode.hpp"
#include "sweep.hpp"

namespace {

namespace plane = oregonator_sweep;

struct inputs {
    double parameter[oregonator::n_parameter];
    struct {
        double operator[](int c) const { return c == oregonator::q ? plane::q : plane::ratio; }
    } shared;
    double operator[](int c) const { return parameter[c]; }
};

/// One cycle, from one maximum of z to the next; a period of zero if there is no next one.
struct cycle {
    double period = 0, z_largest = 0;
};

/// The cycle that follows `before` others, from the start of the sweep.
cycle by_cvode(double f, double epsilon, int before) {
    const inputs p{{f, epsilon}, {}};
    validation::cvode reaction(
        3,
        [p](double t, const double* y, double* dy) {
            const auto slope = oregonator::rhs<double>(t, {y[0], y[1], y[2]}, p);
            for (int c = 0; c < 3; ++c) dy[c] = slope[c];
        },
        1e-9, 1e-13, validation::multistep::bdf);
    reaction.watch({-1}, [p](double t, const double* y, double* g) {
        g[0] = oregonator::events<double>(t, {y[0], y[1], y[2]}, p)[0];
    });
    const Eigen::Vector3d rest = plane::equilibrium(f);
    reaction.start(0, {rest[0], rest[1], rest[2] * (1 + plane::perturbation)});
    double begun = 0;
    for (int k = 0; k <= before; ++k) {
        begun = reaction.t();
        if (!reaction.advance(begun + plane::longest_cycle)) return {};
    }
    return {reaction.t() - begun, reaction.y(oregonator::z)};
}

}  // namespace

int main() {
    constexpr std::int64_t side = 9, cycles = 24;
    // A step's error estimate is below 1e-6 of each concentration. It has order 4 and the solution order 5, and a limit
    // cycle forgets errors across it: the errors of a whole cycle stay below the tolerance of one step.
    constexpr double bound = plane::tolerance;
    auto sweep = plane::prepare(side);
    auto options = plane::integration(cycles);
    options.record = {.from_phase = cycles - 1, .time = true};
    const auto report = myriad::solve<myriad::rodas_5p>(myriad::device::parse("cpu"), sweep, options);
    std::int64_t oscillating = 0, resting = 0, wrong = 0;
    double worst = 0;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const double f = sweep.parameter(oregonator::f)[i], epsilon = sweep.parameter(oregonator::epsilon)[i];
        const auto at_rest = plane::growth_at(f, epsilon);
        const bool turns = sweep.status(i) == myriad::status::stopped_by_event;
        const double z = sweep.state(oregonator::z)[i];
        // The exponent by which deviations grow or decay over all cycles; fewer than 20 leave a trace of the start.
        const double turn = at_rest.frequency > 0 ? 2 * std::acos(-1.0) / at_rest.frequency : 1;
        if (std::abs(at_rest.rate) * turn * cycles < 20) continue;
        bool right = true;
        if (at_rest.rate > 0) {
            ++oscillating;
            const cycle expected = by_cvode(f, epsilon, cycles - 1);
            const double error = std::max(std::abs(report.records.time()(i, 0) / expected.period - 1),
                                          std::abs(z / expected.z_largest - 1));
            right = turns && error < bound;
            worst = std::max(worst, error);
        } else {
            ++resting;
            right = std::abs(z / plane::equilibrium(f)[2] - 1) < plane::tolerance;
        }
        wrong += !right;
        if (!right) std::cout << "WRONG: f = " << f << ", epsilon = " << epsilon << '\n';
    }
    std::cout << oscillating
              << " oscillating reactions compared with CVODE, largest relative error of period or maximum " << worst
              << "; " << resting << " at rest; " << wrong << " wrong\n";
    return wrong == 0 && oscillating >= side && resting >= side ? 0 : 1;
}
