// SPDX-License-Identifier: MIT
// The chemical Langevin equation of a bacterial stress response: a factor that amplifies itself, and three steps of a
// delayed answer that holds it down. As in utkarsh530/GPUODEBenchmarks on GitHub (T. Loman's model), with its grid of
// parameters.
#pragma once

#include <myriad/model.hpp>

namespace problems {

struct stress_response {
    enum state { factor, answer_1, answer_2, answer_3, n_state };
    enum parameter { S, D, tau, v0, n, eta, n_parameter };
    // two for each state: what makes it, and what it loses
    enum noise { made, lost, made_1, lost_1, made_2, lost_2, made_3, lost_3, n_noise };

    template <class R>
    MYRIAD_FUNCTION static R production(const myriad::vec<R, n_state>& y, const auto& p) {
        using myriad::pow;
        const R up = pow(p[S] * y[factor], p[n]), down = pow(p[D] * y[answer_3], p[n]);
        return p[v0] + up / (up + down + R(1));
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        const R rate = R(1) / p[tau];
        return {stress_response::production(y, p) - y[factor], (y[factor] - y[answer_1]) * rate,
                (y[answer_1] - y[answer_2]) * rate, (y[answer_2] - y[answer_3]) * rate};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<myriad::vec<R, n_noise>, n_state> diffusion(auto,
                                                                                   const myriad::vec<R, n_state>& y,
                                                                                   const auto& p) {
        using myriad::abs, myriad::sqrt;  // steps may leave numbers below zero
        const R of_rate = p[eta] * sqrt(R(1) / p[tau]);
        myriad::vec<myriad::vec<R, n_noise>, n_state> g{};
        g[factor][made] = p[eta] * sqrt(abs(stress_response::production(y, p)));
        g[factor][lost] = -(p[eta] * sqrt(abs(y[factor])));
        for (int i = answer_1; i < n_state; ++i) {
            g[i][2 * i] = of_rate * sqrt(abs(y[i - 1]));
            g[i][2 * i + 1] = -(of_rate * sqrt(abs(y[i])));
        }
        return g;
    }
};

}  // namespace problems
