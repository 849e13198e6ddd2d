// SPDX-License-Identifier: MIT
// The Duffing oscillator by Boost.odeint: its controlled Cash-Karp stepper and, for the reference, its Fehlberg 7(8) in
// long double at a tolerance near rounding.
#include <array>

#include <boost/numeric/odeint.hpp>

#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::duffing {
namespace {

template <class Stepper, class T>
outcome run(const sweep& work, T allowed) {
    namespace odeint = boost::numeric::odeint;
    using state = std::array<T, n>;
    return run_instances<n>(work, [&](double(&y)[n], auto&& parameter_of, std::int64_t& accepted) {
        const T k = T(parameter_of(0));
        state u = {T(y[0]), T(y[1])};
        const auto system = [k](const state& s, state& ds, T t) { slopes(t, s[0], s[1], k, ds[0], ds[1]); };
        auto stepper = odeint::make_controlled<Stepper>(allowed, allowed);
        for (int phase = 0; phase < work.phases; ++phase)
            accepted += static_cast<std::int64_t>(
                odeint::integrate_adaptive(stepper, system, u, T(0), T(period), T(first_step)));
        for (std::size_t c = 0; c < u.size(); ++c) y[c] = static_cast<double>(u[c]);
        return ending::completed;
    });
}

template <class T>
using state_of = std::array<T, n>;

}  // namespace

outcome run_odeint(const sweep& work) {
    return run<boost::numeric::odeint::runge_kutta_cash_karp54<state_of<double>>>(work, work.tolerance);
}
outcome run_reference(const sweep& work) {
    using R = long double;
    return run<boost::numeric::odeint::runge_kutta_fehlberg78<state_of<R>, R, state_of<R>, R>>(work, R(1e-16));
}

}  // namespace cpu_peers::duffing
