// SPDX-License-Identifier: MIT
// The Lorenz system by the plain loop over packs, `for every step: y = rk4(y)`, without a check, a hook or a counter: a
// lower bound on Myriad's time. The packs are the library's, arrays of xsimd batches, so that only the loop differs.
#pragma once

#include <algorithm>
#include <cstdint>

#include <myriad/kernel/core/macros.hpp>
#include <myriad/kernel/scalar/pack.hpp>

#include "equations.hpp"

namespace cpu_peers::lorenz {
namespace {  // compiled with different flags in different files, which must not share any of it

template <class S>
struct point {
    S c[n];
};

template <class S>
MYRIAD_FUNCTION point<S> slopes_at(const point<S>& u, const S& p) {
    using myriad::fma;
    return {
        {S(10.0) * (u.c[1] - u.c[0]), fma(u.c[0], p - u.c[2], -u.c[1]), fma(u.c[0], u.c[1], -(S(8.0 / 3) * u.c[2]))}};
}

template <class S>
MYRIAD_FUNCTION point<S> along(const point<S>& u, const S& step, const point<S>& k) {
    return {{myriad::fma(step, k.c[0], u.c[0]), myriad::fma(step, k.c[1], u.c[1]), myriad::fma(step, k.c[2], u.c[2])}};
}

template <class S>
MYRIAD_FUNCTION point<S> rk4(const point<S>& u, const S& p) {
    const S half(0.5 * h), whole(h), sixth(h / 6.0), two(2.0);
    const point<S> k1 = slopes_at(u, p);
    const point<S> k2 = slopes_at(along(u, half, k1), p);
    const point<S> k3 = slopes_at(along(u, half, k2), p);
    const point<S> k4 = slopes_at(along(u, whole, k3), p);
    point<S> sum;
    MYRIAD_UNROLL
    for (int c = 0; c < n; ++c) sum.c[c] = myriad::fma(two, k3.c[c], myriad::fma(two, k2.c[c], k1.c[c])) + k4.c[c];
    return along(u, sixth, sum);
}

template <int batches>
outcome run_pack_loop(const sweep& work) {
    using S = myriad::pack<double, batches>;
    constexpr int lanes = S::lanes;
    outcome result = timed([&] {
        const std::int64_t packs = (work.instances + lanes - 1) / lanes;
#pragma omp parallel for schedule(dynamic, 1) num_threads(work.threads)
        for (std::int64_t i = 0; i < packs; ++i) {
            // The last pack is filled with copies of the last instance.
            const auto instance = [&](int lane) { return std::min(i * lanes + lane, work.instances - 1); };
            point<S> u;
            S p;
            for (int lane = 0; lane < lanes; ++lane) {
                for (int c = 0; c < n; ++c)
                    myriad::detail::set_lane(u.c[c], lane, work.states[c * work.instances + instance(lane)]);
                myriad::detail::set_lane(p, lane, work.parameters[instance(lane)]);
            }
            for (int step = 0; step < steps; ++step) u = rk4(u, p);
            for (int lane = 0; lane < lanes; ++lane) {
                for (int c = 0; c < n; ++c)
                    work.states[c * work.instances + instance(lane)] = myriad::detail::get_lane(u.c[c], lane);
                work.accepted[instance(lane)] = steps;
                work.endings[instance(lane)] = ending::completed;
            }
        }
    });
    result.lanes = lanes;
    const std::int64_t all = (work.instances + lanes - 1) / lanes * lanes;
    result.idle_share = 1 - static_cast<double>(work.instances) / static_cast<double>(all);
    return result;
}

}  // namespace
}  // namespace cpu_peers::lorenz
