// SPDX-License-Identifier: MIT
// Periodic orbits and period doublings of the Duffing sweep against CVODE: orbits by Newton's method on the Poincare
// map, doublings where a Floquet multiplier, an eigenvalue of that map's derivative, is -1. Exit status 0 if all agree,
// else 1.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <numbers>
#include <utility>
#include <vector>

#include "cvode.hpp"
#include "sweep.hpp"

namespace {

using namespace duffing_sweep;
constexpr double period = 2 * std::numbers::pi;

struct orbit {
    double x = x_start, v = v_start, trace = 0, determinant = 0;
    /// Zero where a multiplier is -1.
    double doubling() const { return 1 + trace + determinant; }
};

/// The point after n periods, and the map's derivative by the variational equations.
std::array<double, 6> map(const orbit& from, double k, int n) {
    validation::cvode solution(
        6,
        [k](double t, const double* y, double* dy) {
            const double slope = 1 - 3 * y[0] * y[0];
            dy[0] = y[1];
            dy[1] = y[0] - y[0] * y[0] * y[0] - k * y[1] + forcing * std::cos(t);
            for (const int c : {2, 4}) {
                dy[c] = y[c + 1];
                dy[c + 1] = slope * y[c] - k * y[c + 1];
            }
        },
        1e-11, 1e-12);
    solution.start(0, {from.x, from.v, 1, 0, 0, 1});
    solution.advance(n * period);
    const auto y = solution.state();
    return {y[0], y[1], y[2], y[3], y[4], y[5]};
}

/// The orbit of n periods near a guess, by Newton's method.
orbit periodic(orbit o, double k, int n) {
    for (int i = 0; i < 12; ++i) {
        const auto y = map(o, k, n);
        o.trace = y[2] + y[5];
        o.determinant = y[2] * y[5] - y[4] * y[3];
        const double rx = y[0] - o.x, rv = y[1] - o.v;
        const double a = y[2] - 1, b = y[4], c = y[3], d = y[5] - 1, whole = a * d - b * c;
        o.x -= (d * rx - b * rv) / whole;
        o.v -= (a * rv - c * rx) / whole;
        if (std::hypot(rx, rv) < 1e-10) break;
    }
    return o;
}

/// The k at which the attracting orbit of n periods has the multiplier -1, by the secant method.
double find_doubling(double k, int n, orbit& o) {
    validation::cvode transient(
        2,
        [k](double t, const double* y, double* dy) {
            dy[0] = y[1];
            dy[1] = y[0] - y[0] * y[0] * y[0] - k * y[1] + forcing * std::cos(t);
        },
        1e-9, 1e-9);
    transient.start(0, {x_start, v_start});
    transient.advance(600 * period);
    o.x = transient.y(0);
    o.v = transient.y(1);
    o = periodic(o, k, n);
    double before = k, value_before = o.doubling();
    k -= 1e-5;
    for (int i = 0; i < 12 && std::abs(k - before) > 1e-11; ++i) {
        o = periodic(o, k, n);
        const double value = o.doubling(), next = k - value * (k - before) / (value - value_before);
        before = k;
        value_before = value;
        k = next;
    }
    return k;
}

myriad::ensemble<duffing> integrate(const Eigen::ArrayXd& k, const orbit& start, std::int64_t phases,
                                    std::int64_t recorded, myriad::phase_records<duffing, double>& records) {
    auto sweep = prepare(k);
    sweep.state(duffing::x) = start.x;
    sweep.state(duffing::v) = start.v;
    records = myriad::solve<myriad::cash_karp>(
                  myriad::device::parse("cpu"), sweep,
                  {.phases = phases,
                   .relative_tolerance = tolerance,
                   .absolute_tolerance = tolerance,
                   .record = {.from_phase = phases - recorded, .states = {duffing::x, duffing::v}}})
                  .records;
    return sweep;
}

/// The k at which the sweep's orbits of n periods split in two: the squared distance between the halves grows like the
/// distance from the bifurcation, so that k over that square is extrapolated to zero through three points.
double splitting(double near, int n, orbit start) {
    constexpr std::int64_t phases =
        6000;  // multiples of all 2 n here, so that all instances are recorded at the same place
    const Eigen::ArrayXd k = near - 1e-5 * Eigen::ArrayXd::LinSpaced(3, 1, 3);
    start.x += 1e-3;  // a splitting that starts from rounding would take long
    myriad::phase_records<duffing, double> records;
    integrate(k, start, phases, 2 * n, records);
    const auto x = records.state(duffing::x), v = records.state(duffing::v);
    const Eigen::ArrayXd s = (x.col(n - 1) - x.col(2 * n - 1)).square() + (v.col(n - 1) - v.col(2 * n - 1)).square();
    double at_zero = 0;
    for (int i = 0; i < 3; ++i) {
        double weight = 1;
        for (int j = 0; j < 3; ++j)
            if (j != i) weight *= s[j] / (s[j] - s[i]);
        at_zero += weight * k[i];
    }
    return at_zero;
}

bool check_orbits(double k_begin, double k_end, int n) {
    // Errors of a step, 1e-9 at some 100 steps per period, add up over the lifetime of a perturbation, up to ten
    // periods; their signs differ.
    constexpr double allowed = 1e-6;
    myriad::phase_records<duffing, double> records;
    const auto sweep = integrate(Eigen::ArrayXd::LinSpaced(8, k_begin, k_end), {}, 1200, n, records);
    double worst = 0;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        for (int r = 0; r < n; ++r) {
            const orbit found{records.state(duffing::x)(i, r), records.state(duffing::v)(i, r)};
            const orbit expected = periodic(found, sweep.parameter(duffing::k)[i], n);
            const double error = std::hypot(found.x - expected.x, found.v - expected.v);
            worst = std::isnan(error) ? 1 : std::max(worst, error);
        }
    }
    std::cout << "orbits of " << n << " periods, k from " << k_begin << " to " << k_end << ": within " << worst << '\n';
    return worst < allowed;
}

}  // namespace

int main() {
    bool right = check_orbits(0.2155, 0.224, 3);
    right = check_orbits(0.298, 0.3, 5) && right;
    constexpr double allowed = 2e-7;  // a tenth of the spacing of the 46080 values of k
    std::cout.precision(10);
    for (const auto& [n, k] : {std::pair{3, 0.2105}, {4, 0.265}, {5, 0.2965}}) {
        orbit o;
        const double expected = find_doubling(k, n, o), found = splitting(expected, n, o);
        std::cout << "doubling of " << n << " periods: multiplier -1 at k = " << expected << ", splits at " << found
                  << '\n';
        right = std::abs(found - expected) < allowed && right;
    }
    std::cout << (right ? "All checks passed.\n" : "A check FAILED.\n");
    return right ? 0 : 1;
}
