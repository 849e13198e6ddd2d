// SPDX-License-Identifier: MIT
// Returns of Roessler's equations by CVODE, with the variational equations: section points and times of the orbit of
// period one; and where orbits of period one, two and four double their period, as a Floquet multiplier is -1. Exit
// status 0 if the library agrees, else 1.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <myriad/kernel/scalar/dual.hpp>
#include <myriad/myriad.hpp>

#include "cvode.hpp"
#include "sweep.hpp"

namespace {

using Eigen::Matrix2d, Eigen::Vector2d;

/// Inputs of the model's functions beside the state.
struct inputs {
    double c;
    std::array<double, 2> shared{roessler_sweep::a, roessler_sweep::b};
    double operator[](int) const { return c; }
};

/// A sweep over c with its records.
auto integrate(std::int64_t instances, double first, double last, std::int64_t transient, std::int64_t returns) {
    auto sweep = roessler_sweep::prepare(instances, first, last);
    auto report = myriad::solve<myriad::tsitouras_5>(myriad::device::cpu(), sweep,
                                                     roessler_sweep::integration(transient, returns));
    return std::pair(std::move(sweep), std::move(report));
}

/// A point (x, z) of the section after some returns, the time taken, and the derivative by the first point.
struct image {
    Vector2d point;
    double time;
    Matrix2d derivative;
};

image follow(double c, const Vector2d& start, int returns) {
    using dual = myriad::dual<double>;
    const inputs p{c};
    // the state and two tangents of it
    validation::cvode orbit(
        9,
        [&p](double t, const double* s, double* ds) {
            for (int k = 0; k < 2; ++k) {
                myriad::vec<dual, 3> y;
                for (int i = 0; i < 3; ++i) y[i] = dual(s[i], s[3 + 3 * k + i]);
                const auto slope = roessler::rhs<dual>(dual(t), y, p);
                for (int i = 0; i < 3; ++i) {
                    ds[i] = slope[i].value;
                    ds[3 + 3 * k + i] = slope[i].derivative;
                }
            }
        },
        1e-13, 1e-13);
    orbit.watch({-1}, [](double, const double* s, double* g) { g[0] = s[roessler::y]; });
    image at{start, 0, Matrix2d::Identity()};
    for (int r = 0; r < returns; ++r) {
        orbit.start(0, {at.point[0], 0, at.point[1], 1, 0, 0, 0, 0, 1});
        if (!orbit.advance(100)) throw std::runtime_error("the orbit does not come back");
        const auto s = orbit.state();
        const auto f = roessler::rhs<double>(0.0, {s[0], s[1], s[2]}, p);
        // neighbours arrive earlier or later
        Matrix2d map;
        for (int k = 0; k < 2; ++k) {
            const double* v = &s[static_cast<std::size_t>(3 + 3 * k)];
            map.col(k) << v[0] - f[0] * v[1] / f[1], v[2] - f[2] * v[1] / f[1];
        }
        at = {{s[0], s[2]}, at.time + orbit.t(), map * at.derivative};
    }
    return at;
}

/// The orbit of this period near `guess`, by Newton's method: `follow` from its point.
image periodic(double c, Vector2d& guess, int period) {
    for (int tries = 0; tries < 20; ++tries) {
        const image end = follow(c, guess, period);
        const Vector2d miss = end.point - guess;
        if (miss.norm() < 1e-10) return end;
        guess -= (end.derivative - Matrix2d::Identity()).lu().solve(miss);
    }
    throw std::runtime_error("no periodic orbit was found");
}

/// The c at which the attracting orbit of this period near `near` has the multiplier -1, by secants on det(M + I).
double period_doubling(double near, int period) {
    const auto [sweep, report] = integrate(1, near, near, 1000, 1);
    Vector2d point(report.records.state(roessler::x)(0, 0), report.records.state(roessler::z)(0, 0));
    const auto function = [&](double c) {
        return (periodic(c, point, period).derivative + Matrix2d::Identity()).determinant();
    };
    double before = near, f_before = function(before), now = near + 1e-3;
    for (int tries = 0; tries < 20 && std::abs(now - before) > 1e-9; ++tries) {
        const double f = function(now), next = now - f * (now - before) / (f - f_before);
        before = now;
        f_before = f;
        now = next;
    }
    return now;
}

/// Section points and return times of the orbit of period one against those of a sweep. A return takes some 150 steps
/// with errors of 1e-9 each, of states of up to 20, and is stable; the error of its time is the section's tolerance of
/// 1e-9 over the speed |x| = 6.
bool check_orbit() {
    const auto [sweep, report] = integrate(16, 4, 5, 400, 1);
    double worst_point = 0, worst_time = 0;
    Vector2d guess(-6, 0.01);
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const image exact = periodic(sweep.parameter(roessler::c)[i], guess, 1);
        worst_point = std::max({worst_point, std::abs(report.records.state(roessler::x)(i, 0) - exact.point[0]),
                                std::abs(report.records.state(roessler::z)(i, 0) - exact.point[1])});
        worst_time = std::max(worst_time, std::abs(report.records.time()(i, 0) - exact.time));
    }
    std::cout << "period one, c from 4 to 5: points differ by up to " << worst_point << ", return times by up to "
              << worst_time << '\n';
    return worst_point < 1e-6 && worst_time < 1e-6;
}

/// Beyond a period doubling at c0 the square of the splitting at first grows linearly with c: a parabola extrapolated
/// to zero must give c0, to the cube of the ratio of `width` to the distances between doublings.
bool check_doubling(double c0, int period, double width) {
    const auto [sweep, report] = integrate(9, c0 + 0.3 * width, c0 + width, 12000, 2 * period);
    const auto x = report.records.state(roessler::x);
    Eigen::MatrixXd powers(sweep.size(), 3);
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        // of the points that split, the one that splits most
        const double split = (x.row(i).rightCols(period) - x.row(i).leftCols(period)).abs().maxCoeff();
        powers.row(i) << 1, std::pow(split, 2), std::pow(split, 4);
    }
    const Eigen::VectorXd fit = powers.colPivHouseholderQr().solve(sweep.parameter(roessler::c).matrix());
    std::cout << "period " << period << " doubles at c = " << c0 << " by its multiplier, at " << fit[0]
              << " by the sweep\n";
    return std::abs(fit[0] - c0) < 1e-3 * width;
}

}  // namespace

int main() {
    try {
        std::cout.precision(8);
        bool right = check_orbit();
        const double doublings[] = {period_doubling(5.2, 1), period_doubling(7.7, 2), period_doubling(8.5, 4)};
        // distances to the next doubling decrease by Feigenbaum's 4.67
        right = check_doubling(doublings[0], 1, 0.08) && right;
        right = check_doubling(doublings[1], 2, 0.03) && right;
        right = check_doubling(doublings[2], 4, 0.008) && right;
        std::cout << "ratio of the distances " << (doublings[1] - doublings[0]) / (doublings[2] - doublings[1]) << '\n';
        std::cout << (right ? "All checks passed.\n" : "A check FAILED.\n");
        return right ? 0 : 1;
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
        return 2;
    }
}
