// SPDX-License-Identifier: MIT
// Error against work: evaluations, and time on one core relative to CVODE in the same run.
#include <algorithm>
#include <cmath>

#include "measures.hpp"

namespace validation {
namespace {

constexpr int repetitions = 3, times_over = 16;
// A run takes milliseconds, so that on a machine that others use too a few of them may all be disturbed.
constexpr double seconds_of_repetitions = 0.3;

double median_error(const outcome& o, const references& r, std::size_t instances) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < instances; ++i) errors.push_back(distance(o.instances[i].end, r.known[i].end));
    return median(errors);
}

outcome by_cvode(const problem& p, double tolerance) {
    outcome out;
    for (const instance& i : p.instances) {
        out.instances.push_back(p.by_cvode(i, {tolerance, 0}));
        out.evaluations.push_back(static_cast<double>(out.instances.back().evaluations));
        out.seconds += out.instances.back().seconds;
    }
    return out;
}

}  // namespace

void measure_work(session& s, const problem& p, const references& r) {
    // a GPU's time for so few instances means nothing
    if (!p.by_odeint || s.device.which() != myriad::device::kind::cpu) return;
    const std::size_t size = p.instances.size();
    double unit = 0;
    const auto add = [&](const std::string& who, double setting, auto&& run, double instances) {
        outcome best = run();
        double spent = best.seconds;
        for (int k = 1; k < repetitions || (!s.quick() && spent < seconds_of_repetitions); ++k) {
            const outcome again = run();
            spent += again.seconds;
            if (again.seconds < best.seconds) best = again;
        }
        if (unit == 0) unit = best.seconds / instances;
        const subject about{p.name, who, "double", "cpu:1", setting};
        s.rows.add(about, "work: median error", median_error(best, r, size));
        s.rows.add(about, "work: evaluations per instance", best.sum(best.evaluations) / instances);
        s.rows.add(about, "work: time per instance over CVODE's at 1e-6", best.seconds / instances / unit);
    };
    const auto count = static_cast<double>(size);
    std::vector<double> tolerances = {1e-6, 1e-4, 1e-5, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11};
    if (s.quick()) tolerances = {1e-6, 1e-9};
    for (const double tolerance : tolerances) {
        add(
            "CVODE", tolerance, [&] { return by_cvode(p, tolerance); }, count);
        add(
            "odeint cash_karp", tolerance, [&] { return p.by_odeint(p, tolerance); }, count);
    }
    const problem many = p.repeated(times_over);
    for (const method_entry& m : p.methods) {
        if (m.precision != "double") continue;
        for (std::size_t k = 0; k < tolerances.size(); ++k) {
            myriad::options o;
            double setting = tolerances[k];
            if (m.adaptive()) {
                o.relative_tolerance = o.absolute_tolerance = setting;
                o.max_steps = 10'000'000;
            } else {
                o.step = setting = p.fixed_step * 4 / std::exp2(static_cast<double>(k));
            }
            add(
                m.name, setting, [&] { return m.run(many, o, myriad::device::cpu(1)); }, count * times_over);
        }
    }
}

}  // namespace validation
