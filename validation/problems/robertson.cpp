// SPDX-License-Identifier: MIT
// Robertson's reaction to t = 40. The middle instance has reference values.
#include "robertson.hpp"

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem robertson_problem() {
    problem p;
    p.name = "robertson";
    p.what = "Robertson from (1, 0, 0) to t = 40; k1 from 0.02 to 0.06, k2 = 3e7";
    for (const double k1 : spread(0.02, 0.06, 65)) p.instances.push_back({{1, 0, 0}, {k1, 3e7}, 40});
    p.instances[32].parameter[robertson::k1] = 0.04;  // exactly
    p.stiff = true;
    p.sampled = {robertson::a, robertson::c};
    // quadruple precision
    p.exactly = [](const instance& i, std::int64_t) {
        return known_end(i.parameter[robertson::k1] == 0.04,
                         {0.71582706871940509, 9.1855347645577639e-6, 0.28416374574583035});
    };
    p.invariants = [](const instance&, const std::vector<double>& y) -> std::vector<double> {
        return {y[0] + y[1] + y[2]};
    };
    complete<robertson>(p);
    return p;
}

}  // namespace validation
