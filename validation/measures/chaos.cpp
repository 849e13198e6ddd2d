// SPDX-License-Identifier: MIT
// Chaotic solutions, of which only statistics can be compared: the largest Lyapunov exponent of Lorenz' equations with
// its published value, and the maxima of the Duffing oscillator with those that CVODE finds. The bound is four standard
// errors of the mean over the instances.
#include <cmath>
#include <numbers>

#include <myriad/myriad.hpp>

#include "../problems/duffing.hpp"
#include "../problems/lorenz.hpp"
#include "../problems/problems.hpp"
#include "measures.hpp"

namespace validation {
namespace {

struct statistic {
    double mean = 0, standard_error = 0;
    explicit statistic(const std::vector<double>& values) {
        const auto n = static_cast<double>(values.size());
        for (const double v : values) mean += v / n;
        double squares = 0;
        for (const double v : values) squares += (v - mean) * (v - mean);
        standard_error = std::sqrt(squares / (n - 1) / n);
    }
};

void measure_lyapunov(session& s) {
    constexpr int instances = 64, transient = 50;
    const int phases = s.quick() ? 400 : 2000;  // each one unit of time long
    myriad::ensemble<lorenz_tangent> e(instances);
    for (int i = 0; i < instances; ++i) {
        const double start[] = {1 + 0.1 * i, 2, 20, 1, 0, 0};
        for (int c = 0; c < lorenz_tangent::n_state; ++c) e.state(c)[i] = start[c];
    }
    e.parameter(lorenz_tangent::rho) = 28.0;
    e.time_domain(0, 1);
    myriad::options o;
    o.relative_tolerance = o.absolute_tolerance = 1e-9;
    o.phases = transient;
    myriad::solve<myriad::tsitouras_5>(s.device, e, o);
    const Eigen::ArrayXd before = e.accessory(lorenz_tangent::growth);
    o.phases = phases;
    const auto report = myriad::solve<myriad::tsitouras_5>(s.device, e, o);
    std::vector<double> exponents;
    for (int i = 0; i < instances; ++i)
        exponents.push_back((e.accessory(lorenz_tangent::growth)[i] - before[i]) / phases);
    const statistic seen(exponents);
    const subject about{"lorenz rho = 28", "tsitouras_5", "double", s.device_name(), 1e-9};
    s.rows.add(about, "failed instances", static_cast<double>(report.failed()), bounds::at_most(0),
               "every instance has a solution");
    s.rows.add(about, "largest Lyapunov exponent, standard error", seen.standard_error, bounds::at_most(0.003),
               "a third of a percent, or the comparison says little");
    s.rows.add(about, "largest Lyapunov exponent", seen.mean,
               bounds::within(0.9055 - 0.0003 - 4 * seen.standard_error, 0.9055 + 0.0003 + 4 * seen.standard_error),
               "0.9055(3) and four standard errors");
}

void measure_maxima(session& s) {
    problem p = duffing_problem();
    const double t_end = (s.quick() ? 60 : 300) * 2 * std::numbers::pi / 1.2;
    const std::size_t size = 64;
    p.instances.clear();
    for (std::size_t i = 0; i < size; ++i)
        p.instances.push_back({{-1 + 2 * static_cast<double>(i) / 63, 0}, {0.3}, t_end});
    std::vector<solution> known(size);
    for_each_in_parallel(size, [&](std::size_t i) { known[i] = p.by_cvode(p.instances[i], {1e-9, 0}); });
    const auto mean_maximum = [](const solution& r) {
        return r.accessory[duffing::maxima_sum] / r.count[duffing::maxima];
    };
    const auto maxima = [](const solution& r) { return 1.0 * r.count[duffing::maxima]; };
    const auto rises = [](const solution& r) { return 1.0 * r.count[duffing::rises]; };
    for (const method_entry& m : p.methods) {
        if (!m.adaptive() || m.precision != "double") continue;
        myriad::options o;
        o.relative_tolerance = o.absolute_tolerance = 1e-9;
        o.events = p.events;
        const outcome run = m.run(p, o, s.device);
        subject about = s.about(p, m, 1e-9);
        about.problem = "duffing, chaotic";
        const auto compare = [&](const char* what, auto&& take) {
            std::vector<double> here, there;
            for (std::size_t i = 0; i < size; ++i) {
                here.push_back(take(run.instances[i]));
                there.push_back(take(known[i]));
            }
            const statistic a(here), b(there);
            const double allowed = 4 * std::hypot(a.standard_error, b.standard_error);
            s.rows.add(about, what, a.mean, bounds::within(b.mean - allowed, b.mean + allowed),
                       "CVODE's mean and four standard errors of the difference");
        };
        compare("mean of the maxima", mean_maximum);
        compare("maxima per instance", maxima);
        compare("rises through zero per instance", rises);
    }
}

}  // namespace

void measure_chaos(session& s) {
    measure_lyapunov(s);
    measure_maxima(s);
}

}  // namespace validation
