// SPDX-License-Identifier: MIT
// The peers' loop over a sweep: an OpenMP loop over single instances, scheduled dynamically because their costs differ.
#pragma once

#include <cstdint>
#include <exception>

#include "sweep.hpp"

namespace cpu_peers {

/// Integrates every instance by `integrate(y, parameter_of, accepted)`, which every thread creates once by `make()`: y
/// is the state, changed in place; `parameter_of(c)` is the instance's parameter c; `accepted` counts its steps. It
/// returns the instance's ending.
template <int n, class Make>
outcome run_by_threads(const sweep& work, Make&& make) {
    return timed([&] {
#pragma omp parallel num_threads(work.threads)
        {
            auto&& integrate = make();
#pragma omp for schedule(dynamic, 4)
            for (std::int64_t i = 0; i < work.instances; ++i) {
                double y[n];
                for (int c = 0; c < n; ++c) y[c] = work.states[c * work.instances + i];
                const auto parameter_of = [&](int c) { return work.parameters[c * work.instances + i]; };
                std::int64_t accepted = 0;
                ending how = ending::failed;
                try {
                    how = integrate(y, parameter_of, accepted);
                } catch (const std::exception&) {  // odeint throws if a step cannot be made small enough
                }
                for (int c = 0; c < n; ++c) work.states[c * work.instances + i] = y[c];
                work.accepted[i] = accepted;
                work.endings[i] = how;
            }
        }
    });
}

/// The same for threads without data of their own.
template <int n, class Integrate>
outcome run_instances(const sweep& work, Integrate&& integrate) {
    return run_by_threads<n>(work, [&]() -> Integrate& { return integrate; });
}

}  // namespace cpu_peers
