// SPDX-License-Identifier: MIT
// A ring of 24 van der Pol oscillators, from starts that differ from one to the next.
#include "ring_of_48.hpp"

#include <cmath>

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem ring_of_48_problem() {
    problem p;
    p.name = "ring_of_48";
    p.what = "24 van der Pol oscillators in a ring (48 states) to t = 0.1; mu from 80 to 120";
    for (const double mu : spread(80, 120, 3)) {
        std::vector<double> start;
        for (int c = 0; c < ring_of_48::n_state; ++c) start.push_back(2 * std::cos(1.0 + c));
        p.instances.push_back({start, {mu}, 0.1});
    }
    p.stiff = true;
    p.sampled = {0, 1, 47};
    complete<ring_of_48>(p);
    return p;
}

}  // namespace validation
