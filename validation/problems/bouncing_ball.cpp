// SPDX-License-Identifier: MIT
// Bouncing balls until their twentieth impact, in closed form.
#include "bouncing_ball.hpp"

#include <cmath>

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {
namespace {

/// Time of the n-th impact: t_1 + 2 t_1 r (1 - r^(n-1)) / (1 - r).
double impact_time(double r, int n) {
    const double first = std::sqrt(2 / 9.81);
    return first + 2 * first * r * (1 - std::pow(r, n - 1)) / (1 - r);
}

}  // namespace

problem bouncing_ball_problem() {
    problem p;
    p.name = "bouncing_ball";
    p.what = "Balls from rest at height 1 until their twentieth impact; restitution from 0.75 to 0.9; times of impacts";
    for (const double r : spread(0.75, 0.9, 64)) p.instances.push_back({{1, 0}, {r}, 10});
    p.events = {{.direction = myriad::direction::falling, .tolerance = 1e-12, .stop_after = 20}};
    p.event_times = {bouncing_ball::t_1, bouncing_ball::t_2, bouncing_ball::t_5, bouncing_ball::t_10,
                     bouncing_ball::t_20};
    p.events_per_instance = 20;
    p.fixed_step = 0.01;
    p.error_follows_tolerance = false;  // parabolas are integrated exactly
    p.exactly = [](const instance& i, std::int64_t) {
        const double r = i.parameter[bouncing_ball::restitution];
        solution s;
        s.end = {0, std::pow(r, 20) * std::sqrt(2 * 9.81)};
        for (const int n : {1, 2, 5, 10, 20}) s.accessory.push_back(impact_time(r, n));
        s.count = {20};
        return s;
    };
    complete<bouncing_ball>(p);
    add_float_methods<bouncing_ball>(p);
    return p;
}

}  // namespace validation
