// SPDX-License-Identifier: MIT
// The air pollution model to t = 60, whose rates span 19 decades. The middle instance has published values.
#include "pollution.hpp"

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem pollution_problem() {
    problem p;
    p.name = "pollution";
    p.what = "Air pollution (20 states) to t = 60; the rate of the first reaction from 0.1 to 0.6";
    for (const double k1 : spread(0.1, 0.6, 5))
        p.instances.push_back({{pollution::start, pollution::start + pollution::n_state}, {k1}, pollution::t_end});
    p.stiff = true;
    p.sampled = {0, 1, 7};
    complete<pollution>(p);
    return p;
}

}  // namespace validation
