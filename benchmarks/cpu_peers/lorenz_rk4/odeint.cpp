// SPDX-License-Identifier: MIT
// The Lorenz system by Boost.odeint, written as in its documentation.
#include <array>

#include <boost/numeric/odeint.hpp>

#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::lorenz {

outcome run_odeint(const sweep& work) {
    namespace odeint = boost::numeric::odeint;
    using state = std::array<double, n>;
    return run_instances<n>(work, [](double(&y)[n], auto&& parameter_of, std::int64_t& accepted) {
        const double p = parameter_of(0);
        state u = {y[0], y[1], y[2]};
        const auto system = [p](const state& s, state& ds, double) {
            slopes(s[0], s[1], s[2], p, ds[0], ds[1], ds[2]);
        };
        odeint::runge_kutta4<state> stepper;
        odeint::integrate_n_steps(stepper, system, u, 0.0, h, static_cast<std::size_t>(steps));
        for (std::size_t c = 0; c < u.size(); ++c) y[c] = u[c];
        accepted = steps;
        return ending::completed;
    });
}

}  // namespace cpu_peers::lorenz
