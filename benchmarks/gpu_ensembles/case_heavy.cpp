// SPDX-License-Identifier: MIT
// The cases hodgkin_huxley and kuramoto_<states>: right-hand sides of many elementary functions, in double and single
// precision.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "cases.hpp"
#include "problems/hodgkin_huxley.hpp"
#include "problems/kuramoto.hpp"
#include "reference.hpp"

namespace gpu_ensembles {
namespace {

double coordinate(std::int64_t instance, std::int64_t size) {
    return static_cast<double>(instance) / static_cast<double>(std::max<std::int64_t>(size - 1, 1));
}

template <class Model>
struct heavy;
/// Currents from none to 20: at rest, or firing.
template <>
struct heavy<problems::hodgkin_huxley> {
    using model = problems::hodgkin_huxley;
    static std::string name() { return "hodgkin_huxley"; }
    static std::string work() { return "Hodgkin and Huxley's axon to t = 100 ms, current = linspace(0, 20, N)"; }
    static constexpr std::int64_t size = 131'072;

    template <class R>
    static void fill(myriad::ensemble<model, R>& instances) {
        for (std::int64_t i = 0; i < instances.size(); ++i)
            instances.parameter(model::current)[i] = static_cast<R>(20 * coordinate(i, instances.size()));
        instances.time_domain(0, R(100));
    }
    template <class R>
    static void start(myriad::ensemble<model, R>& instances) {
        constexpr double at_rest[] = {-65.013, 0.0529, 0.5961, 0.3177};
        for (int c = 0; c < model::n_state; ++c) instances.state(c) = static_cast<R>(at_rest[c]);
    }
};
/// Couplings from none to 4, and phases at random.
template <int n>
struct heavy<problems::kuramoto<n>> {
    using model = problems::kuramoto<n>;
    static std::string name() { return "kuramoto_" + std::to_string(n); }
    static std::string work() {
        return std::to_string(n) + " of Kuramoto's oscillators to t = 10, coupling = linspace(0, 4, N)";
    }
    static constexpr std::int64_t size = 32'768;

    template <class R>
    static void fill(myriad::ensemble<model, R>& instances) {
        for (std::int64_t i = 0; i < instances.size(); ++i)
            instances.parameter(model::coupling)[i] = static_cast<R>(4 * coordinate(i, instances.size()));
        for (int i = 0; i < n; ++i) instances.shared(i) = static_cast<R>(-1 + 2.0 * i / (n - 1));
        instances.time_domain(0, R(10));
    }
    template <class R>
    static void start(myriad::ensemble<model, R>& instances) {
        std::mt19937_64 engine(42);
        std::uniform_real_distribution<double> phase(0, 6.283185307179586);
        for (std::int64_t i = 0; i < instances.size(); ++i)
            for (int c = 0; c < n; ++c) instances.state(c)[i] = static_cast<R>(phase(engine));
    }
};

template <class Model, class R>
problem<Model, R> problem_of(double tolerance) {
    return {{.relative_tolerance = tolerance, .absolute_tolerance = tolerance},
            &heavy<Model>::template fill<R>,
            &heavy<Model>::template start<R>};
}

template <class Model, class R>
measurement measure_model(const char* name, double tolerance, std::int64_t size, const measure_options& how,
                          const myriad::ensemble<Model>& truth) {
    measurement m = measure_myriad<myriad::dormand_prince_5>(
        problem_of<Model, R>(tolerance), size, how, [&](const auto& found, measurement& of) {
            std::vector<double> errors;
            for (std::int64_t k = 0; k < compared; ++k) {
                double worst = 0;
                for (int c = 0; c < Model::n_state; ++c) {
                    const double is = static_cast<double>(found.state(c)[compared_instance(k, size)]);
                    const double exact = truth.state(c)[k];
                    worst = larger_or_nan(worst, std::fabs(is - exact) / std::max(1.0, std::fabs(exact)));
                }
                errors.push_back(worst);
            }
            set_errors(of, without_largest_tenth(std::move(errors)));
        });
    m.implementation = name;
    return m;
}

template <class Model>
std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    const auto exact = problem_of<Model, double>(1e-11);
    myriad::ensemble<Model> all(size), truth(compared);
    exact.fill(all);
    exact.fill(truth);
    exact.start(all);
    for (std::int64_t k = 0; k < compared; ++k) {
        const std::int64_t i = compared_instance(k, size);
        truth.parameter(0)[k] = all.parameter(0)[i];
        for (int c = 0; c < Model::n_state; ++c) truth.state(c)[k] = all.state(c)[i];
    }
    myriad::solve<myriad::dormand_prince_5>(myriad::device::cpu(), truth, exact.options);
    return {measure_model<Model, double>("myriad", 1e-6, size, how, truth),
            measure_model<Model, float>("myriad float", 1e-4, size, how, truth)};
}

template <class Model>
benchmark_case case_of() {
    return {.name = heavy<Model>::name(),
            .work = heavy<Model>::work() + " by dormand_prince_5 at 1e-6, in single precision at 1e-4",
            .error =
                "of 64 instances against 1e-11 on the CPU, in the worst component, over max(1, |value|), without "
                "the largest tenth, which are near a threshold",
            .allowed_error = 0.01,
            .sizes = {heavy<Model>::size},
            .measure = &measure<Model>};
}

}  // namespace

std::vector<benchmark_case> heavy_cases() {
    return {case_of<problems::hodgkin_huxley>(), case_of<problems::kuramoto<8>>(), case_of<problems::kuramoto<16>>(),
            case_of<problems::kuramoto<32>>()};
}

}  // namespace gpu_ensembles
