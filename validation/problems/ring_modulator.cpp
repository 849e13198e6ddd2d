// SPDX-License-Identifier: MIT
// The ring modulator over a twentieth of its slow signal's period.
#include "ring_modulator.hpp"

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem ring_modulator_problem() {
    problem p;
    p.name = "ring_modulator";
    p.what = "Ring modulator (15 states) from rest to t = 5e-5; the amplitude of the fast signal from 1.5 to 2.5";
    for (const double carrier : spread(1.5, 2.5, 3))
        p.instances.push_back({std::vector<double>(ring_modulator::n_state, 0), {carrier}, 5e-5});
    p.stiff = true;
    p.sampled = {0, 2, 6};
    complete<ring_modulator>(p);
    return p;
}

}  // namespace validation
