// SPDX-License-Identifier: MIT
// The pressure relief valve by Boost.odeint, which has no events: its user checks the signs after every controlled step
// and repeats the step with the plain stepper until it ends on the event. The reference does so with Fehlberg 7(8) in
// long double at tolerances near rounding.
#include <array>

#include <boost/numeric/odeint.hpp>

#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::relief_valve_case {
namespace {

template <class T>
using state_of = std::array<T, n>;

template <class Stepper, class T>
outcome run(const sweep& work, T allowed, T allowed_event) {
    namespace odeint = boost::numeric::odeint;
    using state = state_of<T>;
    return run_instances<n>(work, [&](double(&y)[n], auto&& parameter_of, std::int64_t& accepted) {
        const T q = T(parameter_of(0));
        const auto system = [q](const state& s, state& ds, T) { slopes(s.data(), q, ds.data()); };
        auto controlled = odeint::make_controlled<Stepper>(allowed, allowed);
        Stepper plain;
        state u = {T(y[0]), T(y[1]), T(y[2])};
        ending how = ending::completed;
        valve<T> memory;
        memory.begin(u.data(), allowed_event);
        for (int phase = 0; phase < work.phases && how == ending::completed; ++phase) {
            memory.begin_phase(u.data());
            T t = 0, dt = T(first_step);
            for (std::int64_t trials = 0;; ++trials) {
                if (trials == most_steps) return ending::failed;
                const state before = u;
                const T begin = t, tried = dt;
                if (controlled.try_step(system, u, t, dt) == odeint::fail) continue;
                bool fired[events] = {};
                const bool crossed[events] = {memory.crosses(section, u.data()), memory.crosses(seat, u.data())};
                if (crossed[section] || crossed[seat]) {
                    const state beyond = u;
                    T length = tried;
                    for (int e = 0; e < events; ++e) {
                        if (!crossed[e]) continue;
                        state end;
                        const T found =
                            locate(e, before.data(), tried, value(e, beyond.data()), allowed_event, T(0), end.data(),
                                   [&](T l, T*) { plain.do_step(system, before, begin, end, l); });
                        if (found >= length) continue;
                        length = found;
                        u = end;
                        t = begin + found;
                        fired[section] = e == section;
                        fired[seat] = e == seat;
                    }
                }
                ++accepted;
                if (memory.after_step(before.data(), u.data(), fired, how)) break;
            }
        }
        for (std::size_t c = 0; c < u.size(); ++c) y[c] = static_cast<double>(u[c]);
        return how;
    });
}

}  // namespace

outcome run_odeint(const sweep& work) {
    return run<boost::numeric::odeint::runge_kutta_cash_karp54<state_of<double>>>(work, work.tolerance,
                                                                                  work.event_tolerance);
}
outcome run_reference(const sweep& work) {
    using R = long double;
    return run<boost::numeric::odeint::runge_kutta_fehlberg78<state_of<R>, R, state_of<R>, R>>(work, R(1e-16),
                                                                                               R(1e-15));
}

}  // namespace cpu_peers::relief_valve_case
