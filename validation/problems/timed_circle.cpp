// SPDX-License-Identifier: MIT
// The circle in logarithmic coordinates from 64 angles, in closed form; and one step by each method in 60 digits.
#include "timed_circle.hpp"

#include <cmath>

#include "../runner.hpp"
#include "one_step.hpp"
#include "problems.hpp"

namespace validation {
namespace {

std::vector<double> at_angle(double s) { return {std::exp(std::sin(s)), std::exp(std::cos(s))}; }

}  // namespace

problem timed_circle_problem() {
    problem p;
    p.name = "timed_circle";
    p.what = "A circle in logarithmic coordinates, run through at the speed 1 + t, from 64 angles to t = 2";
    // the first instance takes the single step
    for (const double s : spread(one_step_angle, 6.75, 64)) p.instances.push_back({at_angle(s), {}, 2});
    p.sampled = {timed_circle::u, timed_circle::w};
    p.longest_step = 1.0 / 8;
    p.exactly = [](const instance& i, std::int64_t samples) {
        const double start = std::atan2(std::log(i.state[timed_circle::u]), std::log(i.state[timed_circle::w]));
        const auto at = [start](double t) { return at_angle(start + t + t * t / 2); };
        solution s;
        s.end = at(i.t_end);
        for (const double t : evenly(i.t_end, samples)) s.samples.push_back(at(t));
        return s;
    };
    p.one_step = one_step;
    p.one_step_length = one_step_length;
    complete<timed_circle>(p);
    for (method_entry& m : stiff_methods_for<timed_circle>()) p.methods.push_back(std::move(m));  // for their orders
    return p;
}

}  // namespace validation
