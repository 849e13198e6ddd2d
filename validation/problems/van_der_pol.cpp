// SPDX-License-Identifier: MIT
// The van der Pol oscillator to t = 20. The middle instance has reference values.
#include "van_der_pol.hpp"

#include "../peers.hpp"
#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem van_der_pol_problem() {
    problem p;
    p.name = "van_der_pol";
    p.what = "van der Pol, from (2, 0) to t = 20; mu from 0.2 to 1.8";
    for (const double mu : spread(0.2, 1.8, 65)) p.instances.push_back({{2, 0}, {mu}, 20});
    p.instances[32].parameter[van_der_pol::mu] = 1;  // exactly
    p.sampled = {van_der_pol::x, van_der_pol::v};
    p.longest_step = 0.125;
    p.fixed_step = 0.01;
    // quadruple precision
    p.exactly = [](const instance& i, std::int64_t) {
        return known_end(i.parameter[van_der_pol::mu] == 1, {2.0081497621749485920, -0.042508875273202146986});
    };
    complete<van_der_pol>(p);
    p.by_odeint = &by_cash_karp_of_odeint<van_der_pol>;
    return p;
}

}  // namespace validation
