// SPDX-License-Identifier: MIT
// The three studies: Keller-Miksis bubbles, relief valves, and Robertson's reaction with spread rate constants.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/gpu_ensembles/sweeps.hpp"
#include "study.hpp"

namespace methods {
namespace {

using gpu_ensembles::problem;

const std::vector<double> six_to_twelve{1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};

template <class Model>
std::string unexpected_failures(const myriad::ensemble<Model>& e, myriad::status expected) {
    const auto failed = std::count_if(e.statuses(), e.statuses() + e.size(),
                                      [&](myriad::status s) { return myriad::is_failure(s) && s != expected; });
    return failed == 0 ? "" : std::to_string(failed) + " instances failed";
}

// Few periods and phases, as some bubbles and valves are chaotic: an error would grow until it tells nothing of the
// method.
constexpr int periods = 2, sections = 4;

// The event tolerance follows that of steps, down to the limit set by the rounding of velocities around ten.
problem<relief_valve> valves(double tolerance) {
    return {gpu_ensembles::valve_options(sections, tolerance, std::max(tolerance, 1e-13)), &gpu_ensembles::fill_valves,
            &gpu_ensembles::start_valves};
}

// ---------------------------------------------------------------------------------------------------------------------
// Robertson
// ---------------------------------------------------------------------------------------------------------------------

// Final values of a and b with the usual constants at t = 1e11; c is of order one.
const std::vector<double> concentrations{1e-8, 1e-14, 1};
constexpr double t_end = 1e5;

/// Rate constants between a third and three times the usual ones, distributed evenly in the logarithms: multiples of
/// the powers of 1/g, g^4 = g + 1 (Roberts' sequence), modulo one.
void fill_reactions(myriad::ensemble<robertson>& instances) {
    constexpr std::array<double, 3> usual{0.04, 3e7, 1e4};
    constexpr double g = 1.2207440846057596;
    for (std::size_t c = 0; c < usual.size(); ++c) {
        const double stride = std::pow(g, -static_cast<double>(c + 1));
        for (std::int64_t i = 0; i < instances.size(); ++i) {
            const double at = std::fmod(0.5 + stride * static_cast<double>(i), 1);
            instances.parameter(static_cast<int>(c))[i] = usual[c] * std::pow(10, 2 * at - 1);
        }
    }
    instances.time_domain(0, t_end);
}

void start_reactions(myriad::ensemble<robertson>& instances) {
    instances.state(robertson::a) = 1;
    instances.state(robertson::b) = 0;
    instances.state(robertson::c) = 0;
}

problem<robertson> reactions(double tolerance) {
    std::vector<double> absolute = concentrations;
    for (double& a : absolute) a *= tolerance;
    return {{.relative_tolerance = tolerance, .absolute_tolerance = absolute, .step = 1e-6},
            &fill_reactions,
            &start_reactions};
}

/// The columns of the Jacobian sum to zero, and so do the stages, except for rounding: that of each addition to the
/// state, half an ulp of at most one in three components, and that of the stages, magnified a hundred times by the
/// coefficients and proportional to the changes of the state, three in all.
std::string wrong_reactions(const myriad::ensemble<robertson>& e, double tolerance) {
    std::ostringstream what;
    what << unexpected_failures(e, myriad::status::success);
    double excess = 0, least = 0;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        const double a = e.state(robertson::a)[i], b = e.state(robertson::b)[i], c = e.state(robertson::c)[i];
        const double allowed =
            (300 + 1.5 * static_cast<double>(e.accepted_steps()[i])) * std::numeric_limits<double>::epsilon();
        excess = std::max(excess, std::fabs(a + b + c - 1) / allowed);
        for (const auto& [value, scale] :
             {std::pair(a, concentrations[0]), std::pair(b, concentrations[1]), std::pair(c, concentrations[2])})
            least = std::min(least, value / (tolerance * scale));
    }
    if (!(excess <= 1)) what << " a sum is off by " << excess << " times what rounding allows";
    if (!(least >= -1)) what << " a concentration is negative by " << -least << " absolute tolerances";
    return what.str();
}

}  // namespace

study<keller_miksis> keller_miksis_study() {
    return {.name = "keller_miksis",
            .work = std::to_string(periods) + " periods from (1, 0), f1 = geomspace(20 kHz, 1000 kHz, N) at 1.5 bar",
            .on_cpu = 1024,
            .on_gpu = 46080,
            .tolerances = six_to_twelve,
            .reference = "dormand_prince_8",
            .reference_tolerance = 1e-14,
            .scale = {1, 1},
            .at =
                [](double tolerance) {
                    return problem<keller_miksis>{gpu_ensembles::bubble_options(periods, tolerance),
                                                  &gpu_ensembles::fill_bubbles, &gpu_ensembles::start_bubbles};
                },
            .complaint = [](const auto& e, double) { return unexpected_failures(e, myriad::status::success); }};
}

study<relief_valve> relief_valve_study() {
    return {
        .name = "relief_valve",
        .work = std::to_string(sections) +
                " phases between falls of the velocity through zero, with impacts, from (0.2, 0, 0), q = "
                "linspace(0.2, 10, N), events to the tolerance of steps",
        .on_cpu = 1024,
        .on_gpu = 30720,
        .tolerances = six_to_twelve,
        .reference = "dormand_prince_8",
        .reference_tolerance = 1e-14,
        .scale = {1, 1, 1},
        .at = &valves,
        .complaint = [](const auto& e, double) { return unexpected_failures(e, myriad::status::event_accumulation); }};
}

study<relief_valve> closely_watched_valve_study() {
    study<relief_valve> s = relief_valve_study();
    s.name = "relief_valve_watched";
    s.work += ", which are looked at " + std::to_string(often) + " times a step";
    s.at = [](double tolerance) {
        auto what = valves(tolerance);
        what.options.sub_samples = often;
        return what;
    };
    return s;
}

study<robertson> robertson_study() {
    return {.name = "robertson",
            .work =
                "from (1, 0, 0) to t = 1e5, rate constants (0.04, 3e7, 1e4) each times 0.1 to 10, absolute tolerances "
                "(1e-8, 1e-14, 1) times the relative one",
            .on_cpu = 10000,
            .on_gpu = 1'000'000,
            .tolerances = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12},
            .reference = "rodas_5p",
            .reference_tolerance = 1e-13,
            .scale = concentrations,
            .at = &reactions,
            .complaint = &wrong_reactions};
}

}  // namespace methods
