// SPDX-License-Identifier: MIT
// The same sweep by Boost.odeint, as a table.
// snippet: sweep
#include <array>
#include <cstdio>
#include <vector>

#include <boost/numeric/odeint.hpp>

int main() {
    namespace odeint = boost::numeric::odeint;
    using state = std::array<double, 2>;
    constexpr int instances = 1024;
    std::vector<double> mu(instances);
    std::vector<state> all(instances, state{1, 0});
    for (int i = 0; i < instances; ++i) mu[i] = 0.5 + 3.5 * i / (instances - 1);

#pragma omp parallel for schedule(dynamic, 16)
    for (int i = 0; i < instances; ++i) {
        const auto rhs = [m = mu[i]](const state& y, state& dydt, double) {
            dydt = {y[1], m * (1 - y[0] * y[0]) * y[1] - y[0]};
        };
        const auto stepper = odeint::make_controlled<odeint::runge_kutta_dopri5<state>>(1e-8, 1e-8);
        odeint::integrate_adaptive(stepper, rhs, all[i], 0.0, 20.0, 1e-2);
    }
    // end of snippet

    std::puts("mu,x,v");
    for (int i = 0; i < instances; ++i) std::printf("%.17g,%.17g,%.17g\n", mu[i], all[i][0], all[i][1]);
    return std::fflush(stdout) == 0 ? 0 : 1;
}
