// SPDX-License-Identifier: MIT
// The Oregonator over its first pulse.
#include "oregonator.hpp"

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem oregonator_problem() {
    problem p;
    p.name = "oregonator";
    p.what = "Oregonator from (1, 2, 3) to t = 30; s from 60 to 90";
    for (const double s : spread(60, 90, 64)) p.instances.push_back({{1, 2, 3}, {s}, 30});
    p.stiff = true;
    p.sampled = {oregonator::a, oregonator::b, oregonator::c};
    complete<oregonator>(p);
    return p;
}

}  // namespace validation
