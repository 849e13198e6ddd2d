// SPDX-License-Identifier: MIT
// The case duffing_events: the sweep of examples/duffing, with two events per period, hooks and accessories, for many
// instances, for fewer, and for so few that a GPU waits for each step.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cases.hpp"
#include "examples/duffing/sweep.hpp"
#include "reference.hpp"

namespace gpu_ensembles {
namespace {

void fill(myriad::ensemble<duffing>& instances) {
    instances.parameter(duffing::k) = duffing_sweep::k_grid(instances.size());
    instances.shared(duffing::B) = duffing_sweep::forcing;
    instances.time_domain(0, 2 * std::numbers::pi);
}

void start(myriad::ensemble<duffing>& instances) {
    instances.state(duffing::x) = duffing_sweep::x_start;
    instances.state(duffing::v) = duffing_sweep::v_start;
    for (int c = 0; c < duffing::n_accessory; ++c) instances.accessory(c) = 0.0;
    instances.integer_accessory(duffing::zeros) = 0;
}

problem<duffing> phases(std::int64_t count, double tolerance) {
    return {{.phases = count,
             .relative_tolerance = tolerance,
             .absolute_tolerance = tolerance,
             .step = 1e-2,
             .phase_step = myriad::phase_step::restart,
             .events = {{.direction = myriad::direction::falling, .tolerance = duffing_sweep::event_tolerance},
                        {.tolerance = duffing_sweep::event_tolerance}}},
            &fill,
            &start};
}

/// Accessories that hooks set at the events of the fourth period (the first has none): the differences from the CPU
/// with tolerances of 1e-13 and, for events, 1e-12.
template <class Method>
std::vector<double> errors_at_events(const problem<duffing>& what, std::int64_t size, const myriad::device& device) {
    const auto four_periods = [&]<class By>(By, const myriad::device& where, double tolerance, double event_tolerance) {
        auto few = spread_instances(what, size);
        myriad::options options = what.options;
        options.phases = 4;
        options.relative_tolerance = options.absolute_tolerance = tolerance;
        for (auto& event : options.events) event.tolerance = event_tolerance;
        myriad::solve<By>(where, few, options);
        return few;
    };
    const auto here =
        four_periods(Method{}, device, what.options.relative_tolerance[0], duffing_sweep::event_tolerance);
    const auto there = four_periods(myriad::cash_karp{}, myriad::device::cpu(), 1e-13, 1e-12);
    std::vector<double> errors;
    for (std::int64_t k = 0; k < compared; ++k) {
        double worst =
            here.integer_accessory(duffing::zeros)[k] == there.integer_accessory(duffing::zeros)[k] ? 0 : std::nan("");
        for (const auto c : {duffing::x_local_max, duffing::v_second_zero})
            worst = larger_or_nan(worst, std::fabs(here.accessory(c)[k] - there.accessory(c)[k]));
        errors.push_back(worst);
    }
    return errors;
}

std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    const auto by = [&]<class Method>(Method, const char* name, double tolerance) {
        const auto what = phases(size >= 100'000 ? 64 : 1024, tolerance);
        measurement m = measure_myriad<Method>(what, size, how, [&](const auto&, measurement& of) {
            set_errors(of, errors_at_events<Method>(what, size, how.device));
        });
        m.implementation = name;
        return m;
    };
    return {by(myriad::cash_karp{}, "myriad", duffing_sweep::tolerance), by(myriad::verner_7{}, "verner_7 3e-9", 3e-9)};
}

}  // namespace

benchmark_case duffing_events_case() {
    return {
        .name = "duffing_events",
        .work =
            "the Duffing oscillator of examples/duffing, two events located in every period, hooks and accessories, "
            "Cash-Karp, tolerances 1e-9, of events 1e-6, k = linspace(0.2, 0.3, N); 64 periods of 737280 instances, "
            "1024 of the others",
        .error =
            "of the largest maximum and of the velocity at the second zero, which events located in the fourth "
            "period, of 64 instances against the CPU with tolerances of 1e-13",
        .allowed_error = 1e-6,
        .sizes = {256, 46080, 737'280},
        .measure = &measure};
}

}  // namespace gpu_ensembles
