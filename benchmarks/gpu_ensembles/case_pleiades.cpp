// SPDX-License-Identifier: MIT
// The case pleiades: seven stars in a plane, as one model and as coupled units.
#include "cases.hpp"
#include "pleiades.hpp"
#include "reference.hpp"

namespace gpu_ensembles {
namespace {

template <class Model>
void fill(myriad::ensemble<Model>& instances) {
    instances.parameter(0) = Eigen::ArrayXd::LinSpaced(instances.size(), 0.5, 2);
    instances.time_domain(0, 3);
}
template <class Model>
void start(myriad::ensemble<Model>& instances) {
    constexpr double at[star::n_unit_state][stars] = {
        {3, 3, -1, -3, 2, -2, 2}, {3, -3, 2, 0, 0, -4, 4}, {0, 0, 0, 0, 0, 1.75, -1.5}, {0, 0, 0, -1.25, 1, 0, 0}};
    for (int i = 0; i < stars; ++i)
        for (int c = 0; c < star::n_unit_state; ++c) instances.state(i * star::n_unit_state + c) = at[c][i];
}
template <class Model>
problem<Model> problem_of(double tolerance, std::int64_t max_steps) {
    return {{.relative_tolerance = tolerance, .absolute_tolerance = tolerance, .max_steps = max_steps},
            &fill<Model>,
            &start<Model>};
}

/// The compared instances at t = 3, by the CPU at 1e-12.
myriad::ensemble<pleiades> reference(std::int64_t size) {
    const auto what = problem_of<pleiades>(1e-12, 1'000'000);
    auto truth = spread_instances(what, size);
    myriad::solve<myriad::dormand_prince_8>(myriad::device::cpu(), truth, what.options);
    return truth;
}

template <class Model, class Method>
measurement measure_model(const char* name, std::int64_t size, const measure_options& how,
                          const myriad::ensemble<pleiades>& truth) {
    const auto what = problem_of<Model>(1e-6, 20'000);
    measurement m = measure_myriad<Method>(what, size, how, [&](const auto& found, measurement& of) {
        std::vector<double> errors;
        for (std::int64_t k = 0; k < compared; ++k) {
            const std::int64_t i = compared_instance(k, size);
            double worst = 0;
            for (int c = 0; c < Model::n_state; ++c)
                worst = larger_or_nan(worst, std::fabs(found.state(c)[i] - truth.state(c)[k]));
            // One that meets another star too closely to end is no error.
            if (found.status(i) != myriad::status::max_steps) errors.push_back(worst);
        }
        set_errors(of, without_largest_tenth(std::move(errors)));
    });
    m.implementation = name;
    return m;
}
std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    const auto truth = reference(size);
    return {measure_model<pleiades, myriad::tsitouras_5>("whole tsitouras_5", size, how, truth),
            measure_model<pleiades_units, myriad::tsitouras_5>("units tsitouras_5", size, how, truth),
            measure_model<pleiades, myriad::dormand_prince_8>("whole dormand_prince_8", size, how, truth),
            measure_model<pleiades_units, myriad::dormand_prince_8>("units dormand_prince_8", size, how, truth)};
}

}  // namespace

benchmark_case pleiades_case() {
    return {
        .name = "pleiades",
        .work = "seven stars in a plane, 28 states, to t = 3 at 1e-6, at most 20 000 steps, m1 = linspace(0.5, 2, N)",
        .error =
            "of 64 instances against dormand_prince_8 at 1e-12 on the CPU, in the worst component, without the "
            "largest tenth, of stars that nearly collide",
        .allowed_error = 0.05,
        .sizes = {131'072},
        .measure = &measure};
}

}  // namespace gpu_ensembles
