// SPDX-License-Identifier: MIT
// The pollution model, 1024 instances on one core, by rodas_5p and by CVODE's BDF at several tolerances: CSV with the
// CPU time per instance and the error, and what CVODE takes for the error of each line of Myriad's.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "cvode_bdf.hpp"
#include "problems/pollution.hpp"

namespace {

using model = problems::pollution;
constexpr int n = model::n_state, instances = 1024, repetitions = 3;

/// As in gpu_ensembles: the rate of the first reaction over two decades.
std::vector<double> rates() {
    std::vector<double> k1;
    for (int i = 0; i < instances; ++i) k1.push_back(3.5e-2 * std::pow(100.0, i / (instances - 1.0)));
    return k1;
}

std::vector<double> by_myriad(double relative, double absolute, const std::vector<double>& k1) {
    static myriad::ensemble<model> all(instances);
    for (int c = 0; c < n; ++c) all.state(c) = model::start[c];
    for (int i = 0; i < instances; ++i) all.parameter(model::k1)[i] = k1[static_cast<std::size_t>(i)];
    all.time_domain(0, model::t_end);
    all.restart();
    const auto report = myriad::solve<myriad::rodas_5p>(
        myriad::device::cpu(1), all, {.relative_tolerance = relative, .absolute_tolerance = absolute});
    if (report.failed() > 0) throw std::runtime_error("instances failed");
    std::vector<double> states;
    for (int i = 0; i < instances; ++i)
        for (int c = 0; c < n; ++c) states.push_back(all.state(c)[i]);
    return states;
}

std::vector<double> by_cvode(stiff_peers::factors which, double relative, double absolute,
                             const std::vector<double>& k1) {
    std::vector<double> states;
    for (int i = 0; i < instances; ++i) states.insert(states.end(), model::start, model::start + n);
    stiff_peers::integrate_by_cvode(which, relative, absolute, k1, states);
    return states;
}

/// The median over instances of the largest difference of a component.
double median_error(const std::vector<double>& states, const std::vector<double>& exact) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < instances; ++i) {
        double worst = 0;
        for (std::size_t c = i * n; c < (i + 1) * n; ++c) worst = std::max(worst, std::abs(states[c] - exact[c]));
        errors.push_back(worst);
    }
    std::nth_element(errors.begin(), errors.begin() + instances / 2, errors.end());
    return errors[instances / 2];
}

struct point {
    double error, milliseconds;  // per instance
};

/// The least CPU time of several runs.
template <class Run>
point measure(Run&& run, const std::vector<double>& exact) {
    point p{median_error(run(), exact), HUGE_VAL};
    for (int i = 0; i < repetitions; ++i) {
        const std::clock_t begin = std::clock();
        run();
        p.milliseconds =
            std::min(p.milliseconds, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / instances);
    }
    return p;
}

/// Time for that error, between measured points straight in the logarithms; 0 if none reached it.
double time_at(const std::vector<point>& points, double error) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].error > error) continue;
        if (i == 0) return points[0].milliseconds;
        const double share = std::log(points[i - 1].error / error) / std::log(points[i - 1].error / points[i].error);
        return points[i - 1].milliseconds * std::pow(points[i].milliseconds / points[i - 1].milliseconds, share);
    }
    return 0;
}

int run() {
    const auto k1 = rates();
    // Far below the errors that are compared, by the method that is not measured with it.
    const auto exact = by_cvode(stiff_peers::factors::dense, 1e-13, 1e-16, k1);
    const auto own_exact = by_myriad(1e-11, 1e-14, k1);
    const double between = median_error(own_exact, exact);
    std::printf("# pollution, %d instances, one core; the references of CVODE and Myriad differ by %.1e\n", instances,
                between);
    std::puts("implementation,relative_tolerance,median_error,cpu_ms_per_instance,times_as_long_as_myriad");
    std::vector<point> dense, sparse;
    for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
        for (const auto which : {stiff_peers::factors::dense, stiff_peers::factors::klu}) {
            if (!stiff_peers::is_built(which)) continue;
            const bool is_dense = which == stiff_peers::factors::dense;
            const point p = measure([&] { return by_cvode(which, tolerance, 1e-2 * tolerance, k1); }, exact);
            (is_dense ? dense : sparse).push_back(p);
            std::printf("%s,%g,%.2e,%.5f,\n", is_dense ? "cvode_dense" : "cvode_klu", tolerance, p.error,
                        p.milliseconds);
            std::fflush(stdout);
        }
    }
    for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7}) {
        const point p = measure([&] { return by_myriad(tolerance, 1e-2 * tolerance, k1); }, exact);
        std::printf("myriad,%g,%.2e,%.5f,1\n", tolerance, p.error, p.milliseconds);
        for (const auto* peer : {&dense, &sparse}) {
            const double time = time_at(*peer, p.error);
            if (time > 0)
                std::printf("%s,,%.2e,%.5f,%.1f\n", peer == &dense ? "cvode_dense" : "cvode_klu", p.error, time,
                            time / p.milliseconds);
        }
        std::fflush(stdout);
    }
    return between < 1e-9 ? 0 : 1;
}

}  // namespace

int main() {
    try {
        return run();
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
        return 2;
    }
}
