// SPDX-License-Identifier: MIT
// Samples at evenly spaced times, for steps h, h/2, h/4, against CVODE at the same times: the error must decrease with
// the order of the interpolant. With step-size control, the error must be within the limit that the tolerance implies.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <vector>

#include <myriad/myriad.hpp>

#include "cvode.hpp"
#include "tests/support/problems.hpp"

namespace {

constexpr int samples = 251;
constexpr double t_end = 10;
bool all_right = true;

void say(const char* model, const char* method, const char* what, double value, bool right) {
    all_right = all_right && right;
    std::cout << (right ? "right: " : "WRONG: ") << model << ", " << method << ": " << what << ' ' << value << '\n';
}

/// The solution at the sample times, by CVODE.
template <class Model>
std::vector<std::vector<double>> reference(const Eigen::ArrayXd& times, const std::vector<double>& start,
                                           double tolerance = 1e-14) {
    validation::cvode solver(
        2,
        [](double t, const double* y, double* dy) {
            const auto slope = Model::template rhs<double>(t, myriad::vec<double, 2>{y[0], y[1]}, 0);
            dy[0] = slope[0];
            dy[1] = slope[1];
        },
        tolerance, tolerance);
    solver.start(0, start);
    std::vector<std::vector<double>> solution = {start};
    for (Eigen::Index k = 1; k < times.size(); ++k) {
        solver.advance(times[k]);
        solution.push_back(solver.state());
    }
    return solution;
}

template <class Model, class Method>
double rms_error(const std::vector<double>& start, const myriad::options& how) {
    myriad::ensemble<Model> e(1);
    for (int c = 0; c < 2; ++c) e.state(c) = start[static_cast<std::size_t>(c)];
    e.time_domain(0, t_end);
    myriad::options o = how;
    o.samples = {.states = {0, 1}, .capacity = samples, .evenly = samples};
    myriad::solve<myriad::dense<Method>>(myriad::device::cpu(1), e, o);
    if (e.samples().stored()[0] != samples) return std::nan("");
    const Eigen::ArrayXd times = e.samples().time().row(0).transpose();
    const auto solution = reference<Model>(times, start);
    double squares = 0;
    for (std::size_t k = 0; k < samples; ++k)
        for (std::size_t c = 0; c < 2; ++c)
            squares +=
                std::pow(e.samples().state(static_cast<int>(c))(0, static_cast<Eigen::Index>(k)) - solution[k][c], 2);
    return std::sqrt(squares / (2 * samples));
}

/// A bound on CVODE's own error: the difference to a solution at ten times the tolerance.
template <class Model>
double error_of_reference(const std::vector<double>& start) {
    const Eigen::ArrayXd times = Eigen::ArrayXd::LinSpaced(samples, 0, t_end);
    const auto fine = reference<Model>(times, start), coarse = reference<Model>(times, start, 1e-13);
    double squares = 0;
    for (std::size_t k = 0; k < samples; ++k)
        for (std::size_t c = 0; c < 2; ++c) squares += std::pow(fine[k][c] - coarse[k][c], 2);
    return std::sqrt(squares / (2 * samples));
}

/// Steps of length h only.
myriad::options fixed_steps(double h) {
    myriad::options o;
    o.step = o.minimum_step = o.maximum_step = h;
    o.relative_tolerance = 0;
    o.absolute_tolerance = 1e30;
    return o;
}

/// The error at steps of h/2 and h/4. The interpolant's has the given order, the steps' has order four or five; samples
/// are at other fractions of the steps for every h. `growth`: the factor by which an error of one step may have grown
/// by the end.
template <class Model, class Method>
void compare(const char* model, const char* method, const std::vector<double>& start, double order, double h,
             double growth) {
    const double coarse = rms_error<Model, Method>(start, fixed_steps(h / 2));
    const double fine = rms_error<Model, Method>(start, fixed_steps(h / 4));
    const double seen = std::log2(coarse / fine);
    const double of_reference = error_of_reference<Model>(start);
    say(model, method, "error", fine, fine > 10 * of_reference);  // else CVODE's error dominates
    say(model, method, "order", seen, seen > order - 0.3 && seen < std::max(order, 1.0 * Method::order) + 0.3);
    if constexpr (requires { Method::interpolant_order; }) {
        // Some hundred steps with errors below the tolerance; the method's own interpolant is as accurate as they are.
        // (The Hermite polynomial is not: its error is independent of the tolerance.)
        const double error = rms_error<Model, Method>(start, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-9});
        say(model, method, "error at tolerances of 1e-9", error, error <= growth * 500 * 1e-9);
    }
}

/// `first_step`: for tsitouras_5, in the range of its order and clear of CVODE's errors.
template <class Model>
void compare_all(const char* name, const std::vector<double>& start, double first_step, double growth) {
    compare<Model, myriad::runge_kutta_4>(name, "runge_kutta_4", start, 4, 1.0 / 16, growth);
    compare<Model, myriad::cash_karp>(name, "cash_karp", start, 4, 1.0 / 16, growth);
    compare<Model, myriad::tsitouras_5>(name, "tsitouras_5", start, 5, first_step, growth);
}

}  // namespace

int main() {
    compare_all<problems::van_der_pol>("van der Pol", {2, 0}, 1.0 / 16, 6.3);
    compare_all<problems::forced_duffing>("Duffing", {0.1, 0}, 1.0 / 8, 22);
    return all_right ? EXIT_SUCCESS : EXIT_FAILURE;
}
