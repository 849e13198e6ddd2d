// SPDX-License-Identifier: MIT
// The case brownian_motion: a stochastic equation whose work is its random numbers, in double and single precision.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "cases.hpp"
#include "problems/geometric_brownian_motion.hpp"
#include "reference.hpp"

namespace gpu_ensembles {
namespace {

using model = problems::geometric_brownian_motion;

template <class R>
void fill(myriad::ensemble<model, R>& instances) {
    instances.shared(model::mu) = R(1.5);
    instances.shared(model::sigma) = R(0.01);
    instances.time_domain(0, 1);
}

template <class R>
void start(myriad::ensemble<model, R>& instances) {
    for (int c = 0; c < model::n_state; ++c) instances.state(c) = R(0.1);
}

template <class R>
measurement measure_precision(const char* name, std::int64_t size, const measure_options& how) {
    const problem<model, R> what{{.step = 1.0 / 256, .seed = 1}, &fill<R>, &start<R>};
    measurement m = measure_myriad<myriad::euler_maruyama>(what, size, how, [&](const auto& found, measurement& of) {
        myriad::ensemble<model, R> few(compared);
        what.fill(few);
        what.start(few);
        myriad::solve<myriad::euler_maruyama>(myriad::device::cpu(), few, what.options);
        std::vector<double> errors(compared, 0.0);
        for (std::int64_t k = 0; k < compared; ++k)
            for (int c = 0; c < model::n_state; ++c) {
                const double is = static_cast<double>(found.state(c)[k]), right = static_cast<double>(few.state(c)[k]);
                auto& worst = errors[static_cast<std::size_t>(k)];
                worst = larger_or_nan(worst, std::fabs(is - right) / right);
            }
        set_errors(of, std::move(errors));
    });
    m.implementation = name;
    return m;
}

std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    return {measure_precision<double>("myriad", size, how), measure_precision<float>("myriad float", size, how)};
}

}  // namespace

benchmark_case noise_case() {
    return {.name = "brownian_motion",
            .work =
                "geometric Brownian motion of 3 states, mu = 1.5, sigma = 0.01, from 0.1 to t = 1, 256 steps by "
                "euler_maruyama",
            .error = "relative difference of the first 64 paths from the same on the CPU",
            .allowed_error = 1e-4,
            .sizes = {8'388'608},
            .measure = &measure};
}

}  // namespace gpu_ensembles
