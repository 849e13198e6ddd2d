// SPDX-License-Identifier: MIT
// The case van_der_pol_grid: a grid of x0 by mu, as one model and as coupled units, in double and single precision.
#include "cases.hpp"
#include "reference.hpp"
#include "van_der_pol.hpp"

namespace gpu_ensembles {
namespace {

constexpr std::int64_t side(std::int64_t size) {
    std::int64_t n = 1;
    while ((n + 1) * (n + 1) <= size) ++n;
    return n;
}
/// The coordinate from 0 to 1 of one of so many values; beyond the grid they begin again.
double coordinate(std::int64_t number, std::int64_t values) {
    return static_cast<double>(number % values) / static_cast<double>(std::max<std::int64_t>(values - 1, 1));
}
template <class Model, class R>
void fill(myriad::ensemble<Model, R>& instances) {
    const std::int64_t n = side(instances.size());
    for (std::int64_t i = 0; i < instances.size(); ++i)
        instances.parameter(0)[i] = static_cast<R>(1 + 2 * coordinate(i, n));
    instances.time_domain(0, 20);
}
template <class Model, class R>
void start(myriad::ensemble<Model, R>& instances) {
    const std::int64_t n = side(instances.size());
    for (std::int64_t i = 0; i < instances.size(); ++i)
        instances.state(0)[i] = static_cast<R>(1 + coordinate(i / n, n));
    instances.state(1) = R(0);
}
template <class Model, class R>
problem<Model, R> problem_of(double relative, double absolute) {
    return {{.relative_tolerance = relative, .absolute_tolerance = absolute}, &fill<Model, R>, &start<Model, R>};
}

template <class Model, class R, class Method = myriad::dormand_prince_5>
measurement measure_model(const char* name, std::int64_t size, const measure_options& how,
                          const myriad::ensemble<van_der_pol>& truth) {
    measurement m =
        measure_myriad<Method>(problem_of<Model, R>(1e-3, 1e-6), size, how, [&](const auto& found, measurement& of) {
            std::vector<double> errors;
            for (std::int64_t k = 0; k < compared; ++k) {
                double worst = 0;
                for (int c = 0; c < Model::n_state; ++c) {
                    const double is = static_cast<double>(found.state(c)[compared_instance(k, size)]);
                    worst = larger_or_nan(worst, std::fabs(is - truth.state(c)[k]));
                }
                errors.push_back(worst);
            }
            set_errors(of, without_largest_tenth(std::move(errors)));
        });
    m.implementation = name;
    return m;
}
std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    const auto exact = problem_of<van_der_pol, double>(1e-12, 1e-12);
    myriad::ensemble<van_der_pol> all(size), truth(compared);
    exact.fill(all);
    exact.start(all);
    for (std::int64_t k = 0; k < compared; ++k) {
        const std::int64_t i = compared_instance(k, size);
        truth.parameter(0)[k] = all.parameter(0)[i];
        for (int c = 0; c < van_der_pol::n_state; ++c) truth.state(c)[k] = all.state(c)[i];
    }
    truth.time_domain(0, 20);
    myriad::solve<myriad::dormand_prince_5>(myriad::device::cpu(), truth, exact.options);
    return {measure_model<van_der_pol, double>("whole", size, how, truth),
            measure_model<van_der_pol_units, double>("units", size, how, truth),
            measure_model<van_der_pol, float>("whole float", size, how, truth),
            measure_model<van_der_pol_units, float>("units float", size, how, truth),
            measure_model<van_der_pol, double, myriad::cash_karp>("whole cash_karp", size, how, truth),
            measure_model<van_der_pol, float, myriad::cash_karp>("whole float cash_karp", size, how, truth)};
}

}  // namespace

benchmark_case van_der_pol_case() {
    return {.name = "van_der_pol_grid",
            .work =
                "van der Pol oscillators to t = 20 by dormand_prince_5 at 1e-3 and 1e-6, x0 from 1 to 2 by mu from 1 "
                "to 3",
            .error =
                "of 64 instances against dormand_prince_5 at 1e-12 on the CPU, in the worst component, without the "
                "largest tenth, in the middle of a jump",
            .allowed_error = 0.2,
            .sizes = {1'048'576},
            .measure = &measure};
}

}  // namespace gpu_ensembles
