// SPDX-License-Identifier: MIT
// A problem solved by Boost.odeint's controlled Cash-Karp stepper, with the same right-hand side.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

#include <boost/numeric/odeint.hpp>
#include <myriad/kernel/model/lane.hpp>
#include <myriad/model.hpp>

#include "problem.hpp"

namespace validation {

template <class Model>
outcome by_cash_karp_of_odeint(const problem& p, double tolerance) {
    namespace odeint = boost::numeric::odeint;
    constexpr auto n = static_cast<std::size_t>(myriad::detail::n_state<Model>);
    using state = std::array<double, n>;
    outcome out;
    const auto begin = std::chrono::steady_clock::now();
    for (const instance& i : p.instances) {
        myriad::inputs<Model, double> inputs{};
        for (int c = 0; c < myriad::detail::n_parameter<Model>; ++c)
            inputs.parameter[c] = i.parameter[static_cast<std::size_t>(c)];
        inputs.shared = p.shared.data();
        long evaluations = 0;
        const auto system = [&](const state& y, state& dy, double t) {
            myriad::vec<double, myriad::detail::n_state<Model>> values;
            for (std::size_t c = 0; c < n; ++c) values[static_cast<int>(c)] = y[c];
            const auto slope = Model::template rhs<double>(t, values, inputs);
            for (std::size_t c = 0; c < n; ++c) dy[c] = slope[static_cast<int>(c)];
            ++evaluations;
        };
        state y;
        for (std::size_t c = 0; c < n; ++c) y[c] = i.state[c];
        odeint::integrate_adaptive(
            odeint::make_controlled<odeint::runge_kutta_cash_karp54<state>>(tolerance, tolerance), system, y, 0.0,
            i.t_end, 1e-2);
        solution s;
        s.end.assign(y.begin(), y.end());
        out.instances.push_back(s);
        out.evaluations.push_back(static_cast<double>(evaluations));
    }
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

}  // namespace validation
