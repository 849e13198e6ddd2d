// SPDX-License-Identifier: MIT
// Mean times until noise has driven a particle from one well of x^4 / 4 - x^2 / 2 into the other, against the solution
// of the equation that mean first passage times satisfy.
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <myriad/myriad.hpp>

#include "bistable.hpp"

namespace {

/// The mean time from x = -1 to 1: 2 / sigma^2 times the integral over y from -1 to 1 of exp(2 V(y) / sigma^2) times
/// that over z up to y of exp(-2 V(z) / sigma^2). Gardiner, Handbook of Stochastic Methods, 3rd ed. (2004),
/// section 5.2.7.
double mean_first_passage(double sigma) {
    const auto weight = [&](double x, double sign) {
        return std::exp(sign * 2 * (x * x * x * x / 4 - x * x / 2) / (sigma * sigma));
    };
    constexpr double dx = 1e-4;
    double below = 0, mean = 0;
    for (double x = -4 + dx / 2; x < 1; x += dx) {
        below += dx * weight(x, -1);
        if (x > -1) mean += dx * weight(x, 1) * below;
    }
    return 2 / (sigma * sigma) * mean;
}

}  // namespace

int main() {
    bool well = true;
    for (const double sigma : {0.5, 0.6, 0.7}) {
        // snippet: solve
        myriad::ensemble<bistable> paths(4000);
        paths.state(bistable::x) = -1;
        paths.parameter(bistable::sigma) = sigma;
        paths.time_domain(0, 10'000);
        const auto report = myriad::solve<myriad::euler_maruyama>(
            myriad::device::best(), paths, {.step = 0.02, .seed = 1, .events = {{.stop_after = 1}}});
        const Eigen::ArrayXd times = paths.t();
        // end of snippet
        const double mean = times.mean(), error = std::sqrt((times - mean).square().sum()) / 4000;
        const double expected = mean_first_passage(sigma);
        std::printf("sigma %.1f: %.2f +- %.2f, expected %.2f\n", sigma, mean, error, expected);
        well = well && report.count(myriad::status::stopped_by_event) == paths.size() &&
               std::abs(mean - expected) < 4 * error;
    }
    return well && std::fflush(stdout) == 0 ? 0 : 1;
}
