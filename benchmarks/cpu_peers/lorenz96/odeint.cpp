// SPDX-License-Identifier: MIT
// Lorenz 96 by Boost.odeint: its controlled stepper of Dormand and Prince and, for the reference, its Fehlberg 7(8) in
// long double at a tolerance near rounding.
#include <array>

#include <boost/numeric/odeint.hpp>

#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::lorenz96 {
namespace {

template <int n, class Stepper, class T>
outcome run(const sweep& work, T allowed) {
    namespace odeint = boost::numeric::odeint;
    using state = std::array<T, n>;
    return run_instances<n>(work, [&](double(&y)[n], auto&& parameter_of, std::int64_t& accepted) {
        const T F = T(parameter_of(0));
        state x;
        for (std::size_t c = 0; c < x.size(); ++c) x[c] = T(y[c]);
        const auto system = [F](const state& s, state& ds, T) { slopes(F, s, ds); };
        accepted = static_cast<std::int64_t>(odeint::integrate_adaptive(
            odeint::make_controlled<Stepper>(allowed, allowed), system, x, T(0), T(work.phases), T(1e-3)));
        for (std::size_t c = 0; c < x.size(); ++c) y[c] = static_cast<double>(x[c]);
        return ending::completed;
    });
}

template <int n, class T>
using state_of = std::array<T, n>;

}  // namespace

template <int n>
outcome run_odeint(const sweep& work) {
    return run<n, boost::numeric::odeint::runge_kutta_dopri5<state_of<n, double>>>(work, work.tolerance);
}
template <int n>
outcome run_reference(const sweep& work) {
    using R = long double;
    return run<n, boost::numeric::odeint::runge_kutta_fehlberg78<state_of<n, R>, R, state_of<n, R>, R>>(work, R(1e-14));
}
template outcome run_odeint<32>(const sweep&);
template outcome run_odeint<128>(const sweep&);
template outcome run_reference<32>(const sweep&);
template outcome run_reference<128>(const sweep&);

}  // namespace cpu_peers::lorenz96
