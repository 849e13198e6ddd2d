// SPDX-License-Identifier: MIT
// Lorenz' equations from (1, 0, 0) to t = 10, below the onset of chaos. The last instance has reference values.
#include "lorenz.hpp"

#include "../peers.hpp"
#include "../runner.hpp"
#include "problems.hpp"

namespace validation {

problem lorenz_problem() {
    problem p;
    p.name = "lorenz";
    p.what = "Lorenz, sigma 10, beta 8/3, from (1, 0, 0) to t = 10; rho from 0 to 21";
    for (const double rho : spread(0, 21, 64)) p.instances.push_back({{1, 0, 0}, {rho}, 10});
    p.sampled = {lorenz::x, lorenz::y, lorenz::z};
    // No measured orders: the fast swings make errors of opposite sign, whose sum passes through zero as the step
    // decreases.
    p.fixed_step = 0.005;
    // quadruple precision
    p.exactly = [](const instance& i, std::int64_t) {
        return known_end(i.parameter[lorenz::rho] == 21,
                         {-7.8734410765709620402, -6.7133208531654644431, 22.176159652834202702});
    };
    complete<lorenz>(p);
    p.by_odeint = &by_cash_karp_of_odeint<lorenz>;
    add_float_methods<lorenz>(p);
    return p;
}

}  // namespace validation
