// SPDX-License-Identifier: MIT
// Compares the references of the benchmark `methods` with CVODE: Adams for bubbles and valves, BDF for Robertson's
// reaction. Usage: validate_method_references [INSTANCES]. Exit status 0 if they agree, 1 if not, 2 for an error.
#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "benchmarks/methods/study.hpp"
#include "cvode.hpp"
#include "oracle.hpp"

namespace {

using namespace methods;
using validation::multistep;

/// The parameters of one instance, as a right-hand side reads them.
template <class Model>
struct parameters_of {
    parameters_of(const myriad::ensemble<Model>& e, std::int64_t instance) {
        for (int c = 0; c < myriad::detail::n_parameter<Model>; ++c) values.push_back(e.parameter(c)[instance]);
    }
    double operator[](int c) const { return values[static_cast<std::size_t>(c)]; }
    std::vector<double> values;
};

/// The state of the given instance at t by CVODE, with the model's own right-hand side.
template <class Model>
std::vector<double> by_cvode(const myriad::ensemble<Model>& e, std::int64_t instance, const std::vector<double>& start,
                             double t, multistep family, double tolerance, double absolute_tolerance) {
    constexpr auto n = static_cast<std::size_t>(myriad::detail::n_state<Model>);
    const parameters_of<Model> p(e, instance);
    const auto f = [&p](double time, const double* y, double* dy) {
        myriad::vec<double, myriad::detail::n_state<Model>> state;
        for (int c = 0; c < myriad::detail::n_state<Model>; ++c) state[c] = y[c];
        const auto slope = Model::template rhs<double>(time, state, p);
        for (int c = 0; c < myriad::detail::n_state<Model>; ++c) dy[c] = slope[c];
    };
    validation::cvode solution(n, f, tolerance, absolute_tolerance, family);
    solution.start(0, start);
    solution.advance(t);
    return solution.state();
}

/// The distance of two states, as the study measures errors.
double distance(const std::vector<double>& scale, const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0;
    for (std::size_t c = 0; c < scale.size(); ++c)
        worst = std::max(worst, std::fabs(a[c] - b[c]) / std::max(scale[c], std::fabs(b[c])));
    return worst;
}

template <class Model>
std::vector<double> state_of(const myriad::ensemble<Model>& e, std::int64_t i) {
    std::vector<double> s;
    for (int c = 0; c < myriad::detail::n_state<Model>; ++c) s.push_back(e.state(c)[i]);
    return s;
}

bool judge(const std::string& name, std::int64_t instances, double difference, double allowed) {
    const bool right = difference <= allowed && allowed < 1e-6;
    std::cout << name << ": largest difference of " << instances << " instances from CVODE " << difference
              << ", allowed " << allowed << (right ? "" : " WRONG") << '\n';
    return right;
}

/// CVODE runs twice, at its tolerance and at ten times that. If this at least doubles its error, the finer solution is
/// nearer to the truth than to the coarser one, and so must the reference be.
template <class Reference, class Model>
bool check(const study<Model>& of, std::int64_t count, const std::vector<double>& start, double t, multistep family,
           double tolerance, double absolute_tolerance) {
    const auto reference = integrated<Reference>(of, of.on_cpu, count, of.reference_tolerance);
    double difference = 0, allowed = 0;
    for (std::int64_t i = 0; i < count; ++i) {
        const auto fine = by_cvode(reference, i, start, t, family, tolerance, absolute_tolerance);
        const auto coarse = by_cvode(reference, i, start, t, family, 10 * tolerance, 10 * absolute_tolerance);
        difference = std::max(difference, distance(of.scale, state_of(reference, i), fine));
        allowed = std::max(allowed, distance(of.scale, coarse, fine));
    }
    return judge(of.name, count, difference, allowed);
}

/// Impacts make an error grow, by the same factor as a shift of the seat by 1e-6. A thousand steps of CVODE at 1e-12
/// then err by 1e-9 times that growth. An instance in which the shift adds or removes an impact tells nothing.
bool check_valves(std::int64_t count) {
    constexpr double shift = 1e-6, error = 1000 * 1e-12;
    const auto of = closely_watched_valve_study();
    const auto phases = of.at(of.reference_tolerance).options.phases;
    const auto reference = integrated<myriad::dormand_prince_8>(of, of.on_cpu, count, of.reference_tolerance);
    double worst = 0;
    std::int64_t compared = 0;
    for (std::int64_t i = 0; i < count; ++i) {
        const double q = reference.parameter(relief_valve::q)[i];
        const auto here = follow_valve(q, static_cast<int>(phases), 0),
                   there = follow_valve(q, static_cast<int>(phases), shift);
        if (here.impacts.size() < static_cast<std::size_t>(phases) || here.impacts != there.impacts) continue;
        ++compared;
        const double growth = std::max(1.0, distance(of.scale, there.state.back(), here.state.back()) / shift);
        worst = std::max(worst, distance(of.scale, state_of(reference, i), here.state.back()) / growth);
    }
    std::cout << "(over the growth of errors) ";
    return judge(of.name, compared, worst, error) && 2 * compared > count;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::int64_t count = argc > 1 ? std::stoll(argv[1]) : 16;
        bool right =
            check<myriad::dormand_prince_8>(keller_miksis_study(), count, {1, 0}, 2, multistep::adams, 1e-12, 1e-12);
        right = check_valves(count) && right;
        right =
            check<myriad::rodas_5p>(robertson_study(), count, {1, 0, 0}, 1e5, multistep::bdf, 1e-10, 1e-22) && right;
        std::cout << (right ? "All references agree with CVODE.\n" : "A check FAILED.\n");
        return right ? 0 : 1;
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return 2;
}
