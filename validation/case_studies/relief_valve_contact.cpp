// SPDX-License-Identifier: MIT
// The relief valve by CVODE: the flow at which its oscillation grazes the seat, and the cycle of a valve that bounces,
// rests and opens, by the example's criterion for rest and by one that lets it bounce for longer. Exit status 0 if the
// library agrees, else 1.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <vector>

#include <myriad/myriad.hpp>

#include "cvode.hpp"
#include "sweep.hpp"

namespace {

namespace valves = relief_valve_sweep;
using valves::beta, valves::delta, valves::restitution;

/// Inputs of the model's functions beside the state.
struct inputs {
    double q;
    std::vector<double> shared{valves::kappa, delta, beta, restitution, valves::rest_band};
    double operator[](int) const { return q; }
};

validation::cvode::function slope_of(const inputs& p) {
    return [p](double t, const double* s, double* ds) {
        const auto slope = relief_valve::rhs<double>(t, {s[0], s[1], s[2]}, p);
        std::copy(&slope[0], &slope[0] + 3, ds);
    };
}

/// The smallest displacement in the oscillation of a valve without a seat.
double smallest_displacement(double q) {
    validation::cvode valve(3, slope_of({q}), 1e-12, 1e-12);
    valve.watch({1}, [](double, const double* s, double* g) { g[0] = s[relief_valve::v]; });
    valve.start(0, {4, 0, 12});
    for (int minima = 0; minima < 200; ++minima)
        if (!valve.advance(valve.t() + 100)) throw std::runtime_error("the valve does not oscillate");
    return valve.y(relief_valve::y);
}

/// From one opening to the next.
struct cycle {
    double y_max = 0, u_contact = 0, period = 0;
    int impacts = 0;
};

/// None if the pressure lifts the valve before it has come to rest. `slowest`: as in the model; `share`: the fraction
/// of the time until opening that the omitted bounces may take, 1/20 in the model.
std::optional<cycle> follow(double q, double slowest, double share) {
    validation::cvode valve(3, slope_of({q}), 1e-13, 1e-15);
    valve.watch({-1, -1}, [](double, const double* s, double* g) {
        g[0] = s[relief_valve::v];
        g[1] = s[relief_valve::y];
    });
    valve.start(0, {0, 0, delta});
    cycle found;
    double highest = 0;
    for (;;) {
        if (!valve.advance(valve.t() + 100)) throw std::runtime_error("the valve neither rises nor falls");
        if (valve.found()[1] == 0) {
            if (found.impacts > 0 && valve.y(0) > highest) return {};  // bounces that accumulate get ever lower
            highest = valve.y(0);
            if (found.impacts == 0) found.y_max = highest;
            continue;
        }
        ++found.impacts;
        const double speed = -restitution * valve.y(1), closing = delta - valve.y(2);
        if (closing <= 0) return {};
        const double opens_in = closing / (beta * q), bounces = 4 * speed / ((1 - restitution) * closing);
        if (speed < slowest && bounces < share * opens_in) {
            found.u_contact = valve.y(2);
            found.period = valve.t() + opens_in;
            return found;
        }
        valve.start(valve.t(), {0, speed, valve.y(2)});
    }
}

/// The last point, to within `width`, at which the condition holds.
template <class Condition>
double last_true(double low, double high, double width, Condition&& condition) {
    while (high - low > width) (condition((low + high) / 2) ? low : high) = (low + high) / 2;
    return (low + high) / 2;
}

/// Valves near the grazing flow: those below by 2e-3 or more have impacts, those above have none. Transients have
/// decayed after 1000 oscillations.
bool check_grazing() {
    const double grazing = last_true(7.5, 7.6, 1e-7, [](double q) { return smallest_displacement(q) < 0; });
    auto sweep = valves::prepare(24, grazing - 0.0235, grazing + 0.0225);
    auto options = valves::integration(1100);
    options.record = {.from_phase = 1000, .integer_accessories = {relief_valve::impacts}};
    const auto report = myriad::solve<myriad::cash_karp>(myriad::device::cpu(), sweep, options);
    const auto impacts = report.records.integer_accessory(relief_valve::impacts);
    int wrong = 0;
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        wrong += (impacts(i, 99) > impacts(i, 0)) != (sweep.parameter(relief_valve::q)[i] < grazing);
    std::cout << "the oscillation grazes the seat at q = " << grazing << "; " << wrong << " of " << sweep.size()
              << " valves nearby have impacts on its wrong side\n";
    return wrong == 0;
}

/// Cycles of valves that rest, and the effect of the omitted bounces. u, about ten, has steps with errors of 1e-10 and
/// is awaited at the rate beta q, at least 0.04: 1e-8 in time. The last bounce shifts by 100 times as much, as its
/// closing force is small.
bool check_cycles() {
    using model = relief_valve_contact;
    auto sweep = valves::prepare_contact(6, 0.002, 0.017);
    auto options = valves::integration_with_contact(300);
    options.record = {.accessories = {model::y_max, model::u_contact, model::t_contact, model::time_at_rest},
                      .integer_accessories = {model::impacts},
                      .time = true};
    const auto report = myriad::solve<myriad::cash_karp>(myriad::device::cpu(), sweep, options);
    const auto& r = report.records;
    double worst = 0, worst_u = 0, left_out = 0, bound = 0;
    bool right = true;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const double q = sweep.parameter(model::q)[i];
        const auto expected = follow(q, valves::slowest, 1.0 / 20),
                   longer = follow(q, valves::slowest / 100, 1.0 / 2000);
        if (!expected || !longer) throw std::runtime_error("a valve does not come to rest");
        // the last two phases with a rest, and the time at which it ended
        std::vector<std::int64_t> phases;
        std::vector<double> opened;
        double t = 0;
        for (std::int64_t k = 0; k < r.phases(); t += r.time()(i, k++)) {
            if (r.accessory(model::time_at_rest)(i, k) == 0) continue;
            phases.push_back(k);
            opened.push_back(t + r.accessory(model::t_contact)(i, k) + r.accessory(model::time_at_rest)(i, k));
        }
        const std::size_t n = phases.size();
        if (n < 3) throw std::runtime_error("a valve of the sweep does not rest");
        const auto impacts = r.integer_accessory(model::impacts);
        right = right && impacts(i, phases[n - 1]) - impacts(i, phases[n - 2]) == expected->impacts;
        worst = std::max({worst, std::abs(opened[n - 1] - opened[n - 2] - expected->period),
                          std::abs(r.accessory(model::y_max)(i, phases[n - 1]) - expected->y_max)});
        worst_u = std::max(worst_u, std::abs(r.accessory(model::u_contact)(i, phases[n - 1]) - expected->u_contact));
        // the bound of docs/case_studies/relief_valve.md
        const double closing = delta - expected->u_contact;
        const double speed = std::min(valves::slowest, closing * closing * (1 - restitution) / (80 * beta * q));
        const double limit =
            0.74 * std::sqrt(delta) * std::pow(speed, 3) / (q * closing * closing * (1 - std::pow(restitution, 3)));
        right = right && std::abs(longer->period - expected->period) < limit + 1e-11;
        left_out = std::max(left_out, std::abs(longer->period - expected->period));
        bound = std::max(bound, limit);
    }
    std::cout << "cycles with a rest: periods and maxima differ from CVODE's by up to " << worst << ", u at contact by "
              << worst_u << "; bounces left out move the opening by up to " << left_out << ", bound " << bound << '\n';
    return right && worst < 1e-8 && worst_u < 1e-6;
}

/// The largest flow at which the valve rests in every cycle.
bool check_end_of_rests() {
    using model = relief_valve_contact;
    const double end = last_true(0.0195, 0.021, 1e-7, [](double q) { return follow(q, 1e-4, 1.0 / 20).has_value(); });
    auto sweep = valves::prepare_contact(20, end - 2e-4, end + 1.8e-4);
    auto options = valves::integration_with_contact(400);
    options.record = {.from_phase = 300, .accessories = {model::time_at_rest}};
    const auto report = myriad::solve<myriad::cash_karp>(myriad::device::cpu(), sweep, options);
    double last = 0;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        if (!(report.records.accessory(model::time_at_rest).row(i) > 0).any()) break;
        last = sweep.parameter(model::q)[i];
    }
    std::cout << "valves rest in every cycle up to q = " << end << ", in the sweep up to " << last << '\n';
    return std::abs(last - end) < 3e-5;  // one and a half steps
}

}  // namespace

int main() {
    try {
        std::cout.precision(8);
        const bool grazes = check_grazing(), rests = check_cycles(), ends = check_end_of_rests();
        std::cout << (grazes && rests && ends ? "All checks passed.\n" : "A check FAILED.\n");
        return grazes && rests && ends ? 0 : 1;
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
        return 2;
    }
}
