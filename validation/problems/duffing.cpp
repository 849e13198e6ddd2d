// SPDX-License-Identifier: MIT
// The Duffing oscillator with its maxima and zeros. The middle instance has reference values.
#include "duffing.hpp"

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem duffing_problem() {
    problem p;
    p.name = "duffing";
    p.what =
        "Duffing, x'' + k x' - x + x^3 = 0.5 cos 1.2 t, from (0.1, 0) to t = 19, for k = 0.3 to t = 50; k from 0.25 to "
        "0.35; maxima and rises of x";
    for (const double k : spread(0.25, 0.35, 65)) p.instances.push_back({{0.1, 0}, {k}, 19});
    p.instances[32] = {{0.1, 0}, {0.3}, 50};
    p.shared = {0.5, 1.2};
    p.events = {{.direction = myriad::direction::falling, .tolerance = 1e-12},
                {.direction = myriad::direction::rising, .tolerance = 1e-12}};
    p.event_times = {duffing::t_maximum, duffing::t_rise};
    p.events_per_instance = 40;
    p.sampled = {duffing::x, duffing::v};
    p.longest_step = 0.2;
    p.fixed_step = 0.01;
    // quadruple precision
    p.exactly = [](const instance& i, std::int64_t) {
        return known_end(i.parameter[duffing::k] == 0.3, {1.1702802239391576732, 0.065504462499426847300});
    };
    complete<duffing>(p);
    return p;
}

}  // namespace validation
