// SPDX-License-Identifier: MIT
// The Lorenz system by a hand-written scalar loop, in double and, as the reference for rounding errors, in long double.
#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::lorenz {
namespace {

template <class T>
outcome run(const sweep& work) {
    return run_instances<n>(work, [](double(&y)[n], auto&& parameter_of, std::int64_t& accepted) {
        const T p = T(parameter_of(0)), step = T(1) / T(steps), half = step / T(2), sixth = step / T(6);
        T u[n] = {T(y[0]), T(y[1]), T(y[2])}, k1[n], k2[n], k3[n], k4[n];
        for (int i = 0; i < steps; ++i) {
            slopes<T>(u[0], u[1], u[2], p, k1[0], k1[1], k1[2]);
            slopes<T>(u[0] + half * k1[0], u[1] + half * k1[1], u[2] + half * k1[2], p, k2[0], k2[1], k2[2]);
            slopes<T>(u[0] + half * k2[0], u[1] + half * k2[1], u[2] + half * k2[2], p, k3[0], k3[1], k3[2]);
            slopes<T>(u[0] + step * k3[0], u[1] + step * k3[1], u[2] + step * k3[2], p, k4[0], k4[1], k4[2]);
            each<n>([&](int c) { u[c] = u[c] + sixth * (k1[c] + T(2) * (k2[c] + k3[c])) + sixth * k4[c]; });
        }
        for (int c = 0; c < n; ++c) y[c] = static_cast<double>(u[c]);
        accepted = steps;
        return ending::completed;
    });
}

}  // namespace

outcome run_loop(const sweep& work) { return run<double>(work); }
outcome run_reference(const sweep& work) { return run<long double>(work); }

}  // namespace cpu_peers::lorenz
