// SPDX-License-Identifier: MIT
// The case brownian_motion: a stochastic equation whose work is its random numbers, in double and single precision.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "cases.hpp"
#include "problems/geometric_brownian_motion.hpp"
#include "problems/stress_response.hpp"
#include "reference.hpp"

namespace gpu_ensembles {
namespace {

using problems::geometric_brownian_motion, problems::stress_response;

template <class R>
void fill(myriad::ensemble<geometric_brownian_motion, R>& instances) {
    instances.shared(geometric_brownian_motion::mu) = R(1.5);
    instances.shared(geometric_brownian_motion::sigma) = R(0.01);
    instances.time_domain(0, 1);
}
template <class R>
void start(myriad::ensemble<geometric_brownian_motion, R>& instances) {
    for (int c = 0; c < geometric_brownian_motion::n_state; ++c) instances.state(c) = R(0.1);
}
/// The product of 32 values of S and D between 0.1 and 100 with a few of the others, the first of which is the fastest.
template <class R>
void fill(myriad::ensemble<stress_response, R>& instances) {
    const std::vector<double> tau{0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100}, n{2, 3, 4},
        v0{0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2}, eta{0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1};
    std::vector<double> decades(32);
    for (std::size_t k = 0; k < decades.size(); ++k)
        decades[k] = std::pow(10.0, -1 + 3 * static_cast<double>(k) / static_cast<double>(decades.size() - 1));
    for (std::int64_t i = 0; i < instances.size(); ++i) {
        auto rest = static_cast<std::size_t>(i);
        const auto put = [&](int parameter, const std::vector<double>& values) {
            instances.parameter(parameter)[i] = static_cast<R>(values[rest % values.size()]);
            rest /= values.size();
        };
        put(stress_response::S, decades), put(stress_response::D, decades), put(stress_response::tau, tau);
        put(stress_response::v0, v0), put(stress_response::n, n), put(stress_response::eta, eta);
    }
    instances.time_domain(0, 1000);
}
template <class R>
void start(myriad::ensemble<stress_response, R>& instances) {
    for (int c = 0; c < stress_response::n_state; ++c) instances.state(c) = instances.parameter(stress_response::v0);
}

/// Relative differences of the first paths from the same on the CPU.
template <class Model, class R>
measurement measure_precision(const char* name, double step, std::int64_t size, const measure_options& how) {
    const problem<Model, R> what{{.step = step, .seed = 1}, &fill<R>, &start<R>};
    measurement m = measure_myriad<myriad::euler_maruyama>(what, size, how, [&](const auto& found, measurement& of) {
        myriad::ensemble<Model, R> few(compared);
        what.fill(few);
        what.start(few);
        myriad::solve<myriad::euler_maruyama>(myriad::device::cpu(), few, what.options);
        std::vector<double> errors(compared, 0.0);
        for (std::int64_t k = 0; k < compared; ++k)
            for (int c = 0; c < Model::n_state; ++c) {
                const double is = static_cast<double>(found.state(c)[k]), right = static_cast<double>(few.state(c)[k]);
                auto& worst = errors[static_cast<std::size_t>(k)];
                worst = larger_or_nan(worst, std::fabs(is - right) / std::fabs(right));
            }
        set_errors(of, std::move(errors));
    });
    m.implementation = name;
    return m;
}
template <class Model>
std::vector<measurement> measure(double step, std::int64_t size, const measure_options& how) {
    return {measure_precision<Model, double>("myriad", step, size, how),
            measure_precision<Model, float>("myriad float", step, size, how)};
}

}  // namespace

std::vector<benchmark_case> noise_cases() {
    const char* const error = "relative difference of the first 64 paths from the same on the CPU";
    return {
        {.name = "brownian_motion",
         .work = "geometric Brownian motion of 3 states, mu = 1.5, sigma = 0.01, from 0.1 to t = 1, 256 steps by "
                 "euler_maruyama",
         .error = error,
         .allowed_error = 1e-4,
         .sizes = {8'388'608},
         .measure =
             [](std::int64_t size, const measure_options& how) {
                 return measure<geometric_brownian_motion>(1.0 / 256, size, how);
             }},
        {.name = "stress_response",
         .work =
             "a bacterial stress response's Langevin equation, 4 states and 8 Wiener processes, to t = 1000, 10 000 "
             "steps by euler_maruyama",
         .error = error,
         .allowed_error = 1e-2,
         .sizes = {1'720'320},
         .measure = [](std::int64_t size, const measure_options& how) {
             return measure<stress_response>(0.1, size, how);
         }}};
}

}  // namespace gpu_ensembles
