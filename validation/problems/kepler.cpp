// SPDX-License-Identifier: MIT
// Kepler orbits from the perihelion, in closed form by Kepler's equation.
#include "kepler.hpp"

#include <cmath>
#include <numbers>

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {
namespace {

/// Position and velocity at time t on the orbit with semi-major axis 1 and eccentricity e: Kepler's equation by
/// Newton's method.
std::vector<double> place_on_orbit(double e, double t) {
    using real = long double;
    const real mean = std::remainder(static_cast<real>(t), 2 * std::numbers::pi_v<real>);
    real E = mean;
    for (int k = 0; k < 50; ++k) E -= (E - e * std::sin(E) - mean) / (1 - e * std::cos(E));
    const real width = std::sqrt(1 - static_cast<real>(e) * e), rate = 1 / (1 - e * std::cos(E));
    return {static_cast<double>(std::cos(E) - e), static_cast<double>(width * std::sin(E)),
            static_cast<double>(-std::sin(E) * rate), static_cast<double>(width * std::cos(E) * rate)};
}

}  // namespace

problem kepler_problem() {
    problem p;
    p.name = "kepler";
    p.what =
        "Kepler orbits of half-axis 1 from the perihelion to t = 10; eccentricity from 0 to 0.6; passages of the "
        "perihelion";
    for (const double e : spread(0, 0.6, 64))
        p.instances.push_back({{1 - e, 0, 0, std::sqrt((1 + e) / (1 - e))}, {}, 10});
    p.events = {{.direction = myriad::direction::rising, .tolerance = 1e-12}};
    p.event_times = {kepler::t_perihelion};
    p.events_per_instance = 1;
    p.sampled = {kepler::x, kepler::y, kepler::u, kepler::v};
    p.longest_step = 0.1;
    p.fixed_step = 0.005;
    p.exactly = [](const instance& i, std::int64_t samples) {
        const double e = 1 - i.state[kepler::x];
        solution s;
        s.end = place_on_orbit(e, i.t_end);
        s.accessory = {2 * std::numbers::pi};
        s.count = {1};
        for (const double t : evenly(i.t_end, samples)) s.samples.push_back(place_on_orbit(e, t));
        return s;
    };
    // energy and angular momentum
    p.invariants = [](const instance&, const std::vector<double>& s) -> std::vector<double> {
        return {(s[2] * s[2] + s[3] * s[3]) / 2 - 1 / std::hypot(s[0], s[1]), s[0] * s[3] - s[1] * s[2]};
    };
    complete<kepler>(p);
    return p;
}

}  // namespace validation
