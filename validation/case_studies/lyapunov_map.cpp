// SPDX-License-Identifier: MIT
// The Lyapunov exponents of the forced Duffing oscillator against CVODE: one by one where the motion is regular, on
// average where it is chaotic; and the sum of both against the damping. Exit status 0 if all is well, else 1.
#include <cmath>
#include <cstdint>
#include <iostream>
#include <vector>

#include <myriad/myriad.hpp>

#include "../../examples/common/phases.hpp"
#include "cvode.hpp"
#include "lyapunov_map_spectrum.hpp"
#include "sweep.hpp"

namespace {

using namespace lyapunov_map;
constexpr std::int64_t transient = 60, summed = 100;

struct point {
    double k, B, x = x_start;
    double operator[](int i) const { return i == forced_duffing::k ? k : B; }
};

myriad::ensemble<library_tangent> by_myriad(const std::vector<point>& points) {
    auto sweep = by_library(static_cast<std::int64_t>(points.size()), transient);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        sweep.parameter(forced_duffing::k)[row] = points[i].k;
        sweep.parameter(forced_duffing::B)[row] = points[i].B;
        sweep.state(forced_duffing::x)[row] = points[i].x;
    }
    myriad::solve<myriad::dormand_prince_8>(myriad::device::parse("cpu"), sweep,
                                            examples::smooth_phases(transient + summed, tolerance));
    return sweep;
}

/// Begins with the same tangent, and normalises it after each period.
double by_cvode(const point& p, double tolerance) {
    validation::cvode oscillator(
        4,
        [&p](double t, const double* s, double* ds) {
            const auto slope = hand_tangent::rhs<double>(t, {s[0], s[1], s[2], s[3]}, p);
            for (int c = 0; c < 4; ++c) ds[c] = slope[c];
        },
        tolerance, tolerance);
    const auto first = by_library(1, 0);
    std::vector<double> s{p.x, v_start, first.state(library_tangent::tangent(0))[0],
                          first.state(library_tangent::tangent(1))[0]};
    double growth = 0;
    for (std::int64_t phase = 0; phase < transient + summed; ++phase) {
        oscillator.start(0, s);
        oscillator.advance(period);
        s = oscillator.state();
        const double length = std::hypot(s[2], s[3]);
        s[2] /= length;
        s[3] /= length;
        if (phase >= transient) growth += std::log(length);
    }
    return growth / (static_cast<double>(summed) * period);
}

bool told(bool right, const char* what) {
    std::cout << (right ? "right: " : "WRONG: ") << what << '\n';
    return right;
}

/// A decaying tangent forgets its past. Per unit of time some ten steps err by 1e-9 each, CVODE's by less, in the
/// tangent and, through 6 x a, in its rate: 1e-7 with a margin of five.
bool regular() {
    const std::vector<point> points{{0.2, 0}, {0.4, 0}, {0.25, 0.1}, {0.45, 0.2}, {0.2, 0.6}, {0.3, 0.7}, {0.35, 0.75}};
    const auto lambda = myriad::exponents(by_myriad(points));
    double worst = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double expected = by_cvode(points[i], 1e-11), found = lambda(static_cast<Eigen::Index>(i), 0);
        std::cout << "k = " << points[i].k << ", B = " << points[i].B << ": " << found << ", CVODE " << expected
                  << '\n';
        worst = std::max(worst, std::abs(found - expected));
        if (!(expected < -0.01 && std::isfinite(found))) worst = 1;
    }
    std::cout << "largest difference " << worst << '\n';
    return told(worst < 1e-7, "exponents of regular motion are those of CVODE");
}

/// Mean and its standard error.
struct estimate {
    double mean = 0, error = 0;
    explicit estimate(const Eigen::ArrayXd& values) : mean(values.mean()) {
        const auto n = static_cast<double>(values.size());
        error = std::sqrt((values - mean).square().sum() / (n * (n - 1)));
    }
};

/// Chaotic solutions differ between methods but have the same mean. Four standard errors: exceeded by chance once in 16
/// 000, and nothing here is random.
bool chaotic() {
    const auto starts = [](int n) {
        std::vector<point> points;
        for (int i = 0; i < n; ++i) points.push_back({0.25, 0.3, 0.9 + 0.2 * i / n});
        return points;
    };
    const auto few = starts(16);
    Eigen::ArrayXd expected(16);
    for (std::size_t i = 0; i < few.size(); ++i) expected[static_cast<Eigen::Index>(i)] = by_cvode(few[i], 1e-8);
    const Eigen::ArrayXd all = myriad::exponents(by_myriad(starts(512))).col(0);
    const estimate found(all), known(expected);
    std::cout << "k = 0.25, B = 0.3: " << found.mean << " +- " << found.error << " (least " << all.minCoeff()
              << "), CVODE " << known.mean << " +- " << known.error << '\n';
    return told(all.minCoeff() > 0 && expected.minCoeff() > 0, "all of these solutions are chaotic") &
           told(std::abs(found.mean - known.mean) < 4 * std::hypot(found.error, known.error),
                "their mean exponent is that of CVODE");
}

/// The divergence is -k everywhere, so that the exponents add up to -k, whatever the motion.
bool sums() {
    constexpr std::int64_t n = 64;
    myriad::ensemble<duffing_spectrum> sweep(n);
    sweep.parameter(forced_duffing::k).setLinSpaced(k_first, k_last);
    sweep.parameter(forced_duffing::B).setLinSpaced(B_first, B_last);
    sweep.state(forced_duffing::x) = x_start;
    sweep.state(forced_duffing::v) = v_start;
    myriad::initial_tangents(sweep);
    sweep.shared_integer(duffing_spectrum::transient_phases) = transient;
    sweep.time_domain(0, period);
    myriad::solve<myriad::tsitouras_5>(myriad::device::parse("cpu"), sweep,
                                       examples::smooth_phases(transient + summed, tolerance));
    const auto lambda = myriad::exponents(sweep);
    const double worst = (lambda.rowwise().sum() + sweep.parameter(forced_duffing::k)).abs().maxCoeff();
    std::cout << "largest exponents from " << lambda.col(0).minCoeff() << " to " << lambda.col(0).maxCoeff()
              << "; sums wrong by up to " << worst << '\n';
    // Twenty steps per unit of time, each with an error of 1e-9 in both tangents, which in chaos align with each other.
    return told(worst < 2e-7, "the sum of both exponents is minus the damping") &
           told(lambda.col(0).minCoeff() < 0 && lambda.col(0).maxCoeff() > 0.1, "of regular and of chaotic solutions");
}

}  // namespace

int main() {
    const bool right = regular() & chaotic() & sums();
    return right ? 0 : 1;
}
