// SPDX-License-Identifier: MIT
// The cases keller_miksis_methods and relief_valve_methods: the same work by methods of higher order, with their
// errors, so that times can be compared at equal error.
#include <utility>

#include "cases.hpp"
#include "reference.hpp"
#include "sweeps.hpp"

namespace gpu_ensembles {
namespace {

constexpr std::int64_t compared_phases = 4;

/// The compared instances of an ensemble of `size` after their first phases.
template <class Method, class Model>
myriad::ensemble<Model> after_first_phases(const problem<Model>& what, std::int64_t size,
                                           const myriad::device& device) {
    auto few = spread_instances(what, size);
    myriad::options options = what.options;
    options.phases = compared_phases;
    myriad::solve<Method>(device, few, options);
    return few;
}

/// The largest component's difference of each instance, over max(1, |value|).
template <class Model>
std::vector<double> differences(const myriad::ensemble<Model>& found, const myriad::ensemble<Model>& truth) {
    std::vector<double> all;
    for (std::int64_t k = 0; k < truth.size(); ++k) {
        double worst = found.status(k) == truth.status(k) ? 0 : std::nan("");
        for (int c = 0; c < myriad::detail::n_state<Model>; ++c) {
            const double value = truth.state(c)[k];
            worst = larger_or_nan(worst, std::fabs(found.state(c)[k] - value) / std::max(1.0, std::fabs(value)));
        }
        all.push_back(worst);
    }
    return all;
}

/// One method at one tolerance, called `name` in the output.
template <class Method, class Model>
measurement measure_method(const char* name, const problem<Model>& what, const myriad::ensemble<Model>& truth,
                           std::int64_t size, const measure_options& how) {
    measurement m = measure_myriad<Method>(what, size, how, [&](const auto&, measurement& of) {
        set_errors(of, differences(after_first_phases<Method>(what, size, how.device), truth));
    });
    m.implementation = name;
    return m;
}

std::vector<measurement> measure_bubbles(std::int64_t size, const measure_options& how) {
    const auto at = [](double tolerance) {
        return problem<keller_miksis>{bubble_options(64, tolerance), &fill_bubbles, &start_bubbles};
    };
    const auto truth = after_first_phases<myriad::dormand_prince_8>(at(1e-13), size, how.device);
    return {measure_method<myriad::cash_karp>("cash_karp 1e-10", at(1e-10), truth, size, how),
            measure_method<myriad::verner_7>("verner_7 1e-9", at(1e-9), truth, size, how),
            measure_method<myriad::verner_7>("verner_7 3e-10", at(3e-10), truth, size, how),
            measure_method<myriad::verner_7>("verner_7 1e-10", at(1e-10), truth, size, how),
            measure_method<myriad::dormand_prince_8>("dormand_prince_8 1e-9", at(1e-9), truth, size, how),
            measure_method<myriad::dormand_prince_8>("dormand_prince_8 1e-10", at(1e-10), truth, size, how),
            measure_method<dormand_prince_8_pi>("dormand_prince_8 pi 2e-9", at(2e-9), truth, size, how),
            measure_method<dormand_prince_8_pi>("dormand_prince_8 pi 1e-9", at(1e-9), truth, size, how),
            measure_method<dormand_prince_8_pi>("dormand_prince_8 pi 1e-10", at(1e-10), truth, size, how)};
}

std::vector<measurement> measure_valves(std::int64_t size, const measure_options& how) {
    const auto at = [](double tolerance, double event_tolerance) {
        return problem<relief_valve>{valve_options(64, tolerance, event_tolerance), &fill_valves, &start_valves};
    };
    const auto truth = after_first_phases<myriad::cash_karp>(at(1e-13, 1e-11), size, how.device);
    return {measure_method<myriad::cash_karp>("cash_karp 1e-10", at(1e-10, 1e-6), truth, size, how),
            measure_method<myriad::verner_7>("verner_7 1e-8", at(1e-8, 1e-6), truth, size, how),
            measure_method<myriad::verner_7>("verner_7 1e-9", at(1e-9, 1e-6), truth, size, how),
            measure_method<myriad::verner_7>("verner_7 1e-10", at(1e-10, 1e-6), truth, size, how),
            measure_method<myriad::dormand_prince_8>("dormand_prince_8 1e-8", at(1e-8, 1e-6), truth, size, how),
            measure_method<myriad::dormand_prince_8>("dormand_prince_8 1e-9", at(1e-9, 1e-6), truth, size, how),
            measure_method<myriad::dormand_prince_8>("dormand_prince_8 1e-10", at(1e-10, 1e-6), truth, size, how)};
}

}  // namespace

std::vector<benchmark_case> method_cases() {
    const std::string error = "of 64 instances after 4 phases, over max(1, |value|), against ";
    const double not_judged =
        std::numeric_limits<double>::infinity();  // chaotic instances, and valves that graze the seat
    return {{.name = "keller_miksis_methods",
             .work = "as keller_miksis, by method and tolerance",
             .error = error + "dormand_prince_8 at 1e-13",
             .allowed_error = not_judged,
             .sizes = {8192, 46080, 307'200},
             .measure = &measure_bubbles},
            {.name = "relief_valve_methods",
             .work = "as relief_valve, by method and tolerance",
             .error = error + "cash_karp at 1e-13, events located to 1e-11",
             .allowed_error = not_judged,
             .sizes = {8192, 30720, 768'000},
             .measure = &measure_valves}};
}

}  // namespace gpu_ensembles
