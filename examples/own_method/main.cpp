// SPDX-License-Identifier: MIT
// Integrates pendulums with a user-defined method and compares its work and error with those of the library's: the
// periods of pendulums dropped from rest are known in closed form.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>

#include <myriad/methods.hpp>
#include <myriad/myriad.hpp>

#include "bogacki_shampine_3.hpp"
#include "models.hpp"

namespace {

/// Quarter period of a pendulum dropped from `angle`: pi / 2 over the arithmetic-geometric mean of 1 and cos(angle /
/// 2).
double quarter_period(double angle) {
    double a = 1, g = std::cos(angle / 2);
    for (int i = 0; i < 6; ++i) {
        const double mean = (a + g) / 2;
        g = std::sqrt(a * g);
        a = mean;
    }
    return std::numbers::pi / 2 / a;
}

/// Largest error of the third passage, at five quarter periods.
template <class Method>
bool integrate(const char* name, double tolerance) {
    myriad::ensemble<pendulum> swings(256);
    swings.state(pendulum::angle) = Eigen::ArrayXd::LinSpaced(swings.size(), 0.1, 2.5);
    swings.state(pendulum::speed) = 0;
    swings.accessory(pendulum::last_passage) = 0;
    swings.integer_accessory(pendulum::passages) = 0;
    swings.time_domain(0, 100);
    const auto report = myriad::solve<Method>(myriad::device::best(), swings,
                                              {.relative_tolerance = tolerance,
                                               .absolute_tolerance = tolerance,
                                               .events = {{.tolerance = 1e-12, .stop_after = 3}}});
    double worst = 0;
    for (std::int64_t i = 0; i < swings.size(); ++i) {
        const double exact = 5 * quarter_period(0.1 + 2.4 * static_cast<double>(i) / 255);
        worst = std::fmax(worst, std::abs(swings.accessory(pendulum::last_passage)[i] - exact));
    }
    std::printf("%-20s tolerance %.0e: error %.1e, %6.1f evaluations per instance\n", name, tolerance, worst,
                static_cast<double>(report.rhs_evaluations) / static_cast<double>(swings.size()));
    // a few hundred steps, each with an error below the tolerance, and errors of the period that grow no faster than
    // time
    return report.count(myriad::status::stopped_by_event) == swings.size() && worst <= 1000 * tolerance;
}

}  // namespace

int main() {
    bool well = true;
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
        well = integrate<bogacki_shampine_3>("bogacki_shampine_3", tolerance) && well;
        well = integrate<myriad::tsitouras_5>("tsitouras_5", tolerance) && well;
    }
    return well && std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? 0 : 1;
}
