// SPDX-License-Identifier: MIT
// The magnets of pendulums stopped early, and the barrier that stops them, against CVODE run to the end. Exit status 0
// if all is well, else 1.
#include <cmath>
#include <cstdint>
#include <iostream>

#include <myriad/myriad.hpp>

#include "cvode.hpp"
#include "sweep.hpp"

namespace {

using namespace basins;

struct constants {
    struct {
        double operator[](int i) const {
            return i == pendulum::omega ? omega : i == pendulum::damping ? damping : height;
        }
    } shared;
};

/// The magnet of a pendulum released at rest, after a time in which its oscillation has decayed by exp(-damping t / 2)
/// = 0.0025.
int by_cvode(double x, double y) {
    validation::cvode bob(
        4,
        [](double t, const double* s, double* ds) {
            const auto slope = pendulum::rhs<double>(t, {s[0], s[1], s[2], s[3]}, constants{});
            for (int c = 0; c < 4; ++c) ds[c] = slope[c];
        },
        1e-10, 1e-10);
    bob.start(0, {x, y, 0, 0});
    bob.advance(60);
    return nearest_magnet(bob.y(0), bob.y(1));
}

}  // namespace

int main() {
    constexpr std::int64_t side = 24, every = 5;
    const Eigen::ArrayXd axis = places(side);
    auto sweep = grid(side, barrier(), 4 * natural_period);
    myriad::solve<myriad::dormand_prince_8>(myriad::device::parse("cpu"), sweep, integration());
    // Errors grow by less than a factor of 1e3 before a pendulum is captured, except at the basins' boundary: there a
    // start 1e-5 away, 1000 times the tolerance, ends elsewhere too.
    constexpr double shift = 1e-5;
    std::int64_t compared = 0, wrong = 0;
    for (std::int64_t i = 0; i < sweep.size(); i += every) {
        const double x = axis[i % side], y = axis[i / side];
        const int expected = by_cvode(x, y);
        if (by_cvode(x + shift, y) != expected || by_cvode(x, y + shift) != expected) continue;
        ++compared;
        const bool right = sweep.status(i) == myriad::status::stopped_by_user &&
                           nearest_magnet(sweep.state(pendulum::x)[i], sweep.state(pendulum::y)[i]) == expected;
        wrong += !right;
        if (!right) std::cout << "WRONG: the pendulum released at (" << x << ", " << y << ")\n";
    }
    std::cout << "Of " << (sweep.size() + every - 1) / every << " pendulums " << compared
              << " were compared with CVODE, " << wrong << " end over another magnet\n";
    return wrong == 0 && 2 * every * compared > sweep.size() ? 0 : 1;
}
