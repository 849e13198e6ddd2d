// SPDX-License-Identifier: MIT
// Order and error constant with fixed steps, on all instances, for methods with step-size control too. These are the
// tight checks: a coefficient wrong in its fourth digit breaks a low order condition, so that the error decreases with
// the first or second power of the step, or not at all, once it is at a ten-thousandth of its proper size. Some
// coefficients do not enter low orders (a[1][0] of Cash-Karp's method); one step shows those.
#include <algorithm>
#include <cmath>

#include "measures.hpp"

namespace validation {
namespace {

/// Per instance: the Euclidean norm of the difference of two end states, and that of all their samples.
struct differences {
    std::vector<double> end, samples;

    differences(const std::vector<solution>& a, const std::vector<solution>& b) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            double at_end = 0, along = 0;
            for (std::size_t c = 0; c < a[i].end.size(); ++c) at_end += std::pow(a[i].end[c] - b[i].end[c], 2);
            for (std::size_t k = 0; k < a[i].samples.size() && k < b[i].samples.size(); ++k)
                for (std::size_t c = 0; c < a[i].samples[k].size(); ++c)
                    along += std::pow(a[i].samples[k][c] - b[i].samples[k][c], 2);
            end.push_back(std::sqrt(at_end));
            samples.push_back(std::sqrt(along));
        }
    }
};

}  // namespace

void measure_step(session& s, const problem& p, const method_entry& m) {
    if (p.one_step.empty() || m.precision != "double" || m.implicit) return;
    problem single = p;
    single.instances.resize(1);
    single.instances[0].t_end = p.one_step_length;
    const auto end = m.run(single, fixed_steps(single, p.one_step_length), s.device).instances[0].end;
    const auto known = p.one_step.find(m.name);
    const double error = known == p.one_step.end() ? unknown : distance(end, known->second);
    s.rows.add(s.about(p, m, p.one_step_length), "one step against published coefficients", error,
               bounds::at_most(50 * eps_double), "a rounding of values below e in each of a dozen terms and stages");
}

void measure_order(session& s, const problem& p, const method_entry& m, const references& r) {
    if (p.longest_step == 0 || m.precision != "double") return;
    const problem smooth = without_events(p);  // events would shorten steps
    std::vector<double> growths;
    for (const conditioning& c : r.conditions) growths.push_back(c.end);
    const double growth = median(growths), error_of_reference = median(r.error);
    struct level {
        double h;
        std::vector<solution> instances;
        differences error;
    };
    std::vector<level> levels;
    const std::size_t least_levels = m.takes_long_steps() ? 2 : 3;
    double h = (m.takes_long_steps() ? 2 : 1) * p.longest_step;
    for (int k = 0; k < 8; ++k, h /= 2) {
        myriad::options o = fixed_steps(smooth, h);
        if (!p.sampled.empty()) o.samples = {.states = p.sampled, .capacity = p.samples, .evenly = p.samples};
        const outcome run = m.run(smooth, o, s.device);
        const level now{h, run.instances, {run.instances, r.known}};
        const double error = median(now.error.end);
        s.rows.add(s.about(p, m, h), "end state with fixed steps, median", error);
        // Roundings of n steps add up to about sqrt(n) eps and grow; close to that, the error tells nothing of the
        // method. The reference's error is taken from the run at ten times its tolerance, and so is well above its own.
        const double steps = p.instances[0].t_end / h;
        const double floor = std::max(30 * std::sqrt(steps) * eps_double * growth, 3 * error_of_reference);
        if (!levels.empty() && !(error > floor)) break;
        levels.push_back(now);
    }
    if (levels.size() < least_levels) {
        // Errors of order nine reach rounding within one halving where the longest step is short for them; timed_circle
        // and the order of the error estimate show it.
        if (m.order >= 9) {
            s.rows.add(s.about(p, m, h), "order, too few steps above rounding", unknown);
        } else {
            s.rows.add(s.about(p, m, h), "order", unknown, bounds::within(m.order, m.order),
                       "too few steps above rounding");
        }
        return;
    }
    const level &fine = levels.back(), &coarse = levels[levels.size() - 2];
    const subject about = s.about(p, m, fine.h);
    const double order = std::log2(median_ratio(coarse.error.end, fine.error.end));
    // Observed with high orders: 6.1 for seven on Duffing's oscillator (8.4 at twice the step) and 7.4 for eight on van
    // der Pol's; where every instance has a closed form, at most half an order.
    const double below = error_of_reference == 0 ? 0.5 : 1.2;
    s.rows.add(
        about, "order", order,
        m.takes_long_steps() ? bounds::within(m.order - below, m.order + 2.5)
                             : bounds::within(m.order - 0.2, m.order + 1.2),
        "error = C h^order (1 + O(h)); above it where C is small against the next terms, h larger for high orders");
    // The difference of two step sizes gives the error of the finer one, up to a term in h.
    const differences halving(coarse.instances, fine.instances);
    s.rows.add(about, "error over its prediction by halved steps",
               median_ratio(fine.error.end, halving.end) * (std::exp2(order) - 1), bounds::within(0.8, 1.25),
               "the limit is the reference");
    if (p.sampled.empty()) return;
    const double interpolant = m.interpolant_order > 0 ? m.interpolant_order + 1 : 4;
    const double least = std::min(interpolant, 1.0 * m.order);
    s.rows.add(about, "order of samples", std::log2(median_ratio(coarse.error.samples, fine.error.samples)),
               bounds::within(least - (m.takes_long_steps() ? below + 0.1 : 0.3),
                              std::max(interpolant, 1.0 * m.order) + (m.takes_long_steps() ? 2.5 : 1.2)),
               "that of the interpolant inside a step, or of the steps, whichever error is larger");
}

}  // namespace validation
