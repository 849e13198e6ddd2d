// SPDX-License-Identifier: MIT
// High irradiance responses to t = 321.8122, from different amounts of the inactive substance.
#include "hires.hpp"

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem hires_problem() {
    problem p;
    p.name = "hires";
    p.what = "High irradiance responses (8 states) to t = 321.8122; the first substance from 0.5 to 1.5";
    for (const double first : spread(0.5, 1.5, 9)) {
        std::vector<double> start(hires::start, hires::start + hires::n_state);
        start[0] = first;
        p.instances.push_back({start, {}, hires::t_end});
    }
    p.stiff = true;
    p.sampled = {0, 5, 7};
    complete<hires>(p);
    return p;
}

}  // namespace validation
