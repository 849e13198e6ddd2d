// SPDX-License-Identifier: MIT
// Errors over a range of tolerances, and their bounds: every accepted step adds an error below the tolerance, since the
// solution is more accurate than the one whose error is estimated (or a few tolerances, where stability and not
// accuracy bounds the steps), and a rounding; each event adds its location error; and each of these may have grown by
// the problem's conditioning when it is measured.
#include <algorithm>
#include <cmath>
#include <string>

#include "measures.hpp"

namespace validation {
namespace {

/// The value whose ratio to its bound is largest.
struct worst {
    double value = 0, bound = bounds::infinite;
    void add(double v, double b) {
        const double ratio = v / b;
        if (std::isnan(value) || std::isnan(bound) || (ratio <= value / bound && bound < bounds::infinite)) return;
        value = v;
        bound = b;
    }
};

constexpr const char* of_tolerance =
    "growth of errors x (steps x (tolerance + rounding) + events x their tolerance) + error of the reference";
constexpr const char* of_halving =
    "twice the difference from half the step + growth of errors x roundings + error of the reference";

/// The other backend's results, or its recorded ones.
void compare_backends(session& s, const problem& p, const method_entry& m, double setting, const char* other,
                      const std::vector<double>& allowed, const outcome& here,
                      const std::map<std::size_t, recorded_result>& there) {
    worst end;
    double steps_here = 0, steps_there = 0, other_counts = 0;
    for (const auto& [i, result] : there) {
        if (i >= here.instances.size()) continue;
        end.add(distance(here.instances[i].end, result.end), allowed[i]);
        steps_here += here.accepted[i];
        steps_there += result.steps;
        other_counts += here.instances[i].count != result.count;
    }
    const std::string name = std::string("against ") + other;
    s.rows.add(s.about(p, m, setting), name + ": end state", end.value, bounds::at_most(end.bound),
               "both are within the bound on the error, so their difference is within twice that");
    s.rows.add(s.about(p, m, setting), name + ": instances with other event counts", other_counts, bounds::at_most(0),
               "no event is close to being missed");
    s.rows.add(s.about(p, m, setting), name + ": steps", steps_here / steps_there, bounds::within(0.97, 1.03),
               "step sizes that differ in the fifth digit gain or lose a step here and there");
}

std::map<std::size_t, recorded_result> as_recorded(const outcome& o) {
    std::map<std::size_t, recorded_result> results;
    for (std::size_t i = 0; i < o.instances.size(); ++i)
        results[i] = {o.accepted[i], o.instances[i].end, o.instances[i].accessory, o.instances[i].count};
    return results;
}

/// One run; returns the median error of the end states. `finer`: for fixed steps, the same run with steps half as long,
/// whose difference gives the error: 15/16 of it for order four, and at least half of it.
double measure_run(session& s, const problem& p, const method_entry& m, const references& r, const char* kind,
                   double setting, double tolerance, myriad::options o, const outcome* finer = nullptr) {
    const subject about = s.about(p, m, setting);
    const outcome plain = m.run(p, o, s.device);
    const std::size_t size = p.instances.size();
    const double located = p.events_per_instance * p.event_tolerance();

    worst end, event, accessory, invariant;
    std::vector<double> errors, twice(size);
    double failed = 0, other_counts = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const solution& is = plain.instances[i];
        const solution& known = r.known[i];
        const conditioning& c = r.conditions[i];
        failed += myriad::is_failure(plain.status[i]);
        const double made = plain.accepted[i] * (p.error_of_a_step * tolerance + m.eps) + located + r.error[i];
        const double error = distance(is.end, known.end);
        errors.push_back(error);
        const solution& half = finer == nullptr ? is : finer->instances[i];
        end.add(error, std::max(1.0, c.end) * made + 2 * distance(is.end, half.end));
        twice[i] = 2 * std::max(1.0, c.path) * made;
        if (!known.count.empty()) other_counts += is.count != known.count;
        for (std::size_t a = 0; a < known.accessory.size(); ++a) {
            const bool time =
                std::find(p.event_times.begin(), p.event_times.end(), static_cast<int>(a)) != p.event_times.end();
            // a time is itself rounded too
            (time ? event : accessory)
                .add(std::abs(is.accessory[a] - known.accessory[a]),
                     std::max(1.0, c.accessory[a]) * made + m.eps * std::abs(known.accessory[a]) +
                         2 * std::abs(is.accessory[a] - half.accessory[a]));
        }
        if (p.invariants) {
            const auto before = p.invariants(p.instances[i], p.instances[i].state),
                       after = p.invariants(p.instances[i], is.end);
            invariant.add(distance(after, before), std::max(1.0, c.invariant) * made +
                                                       2 * distance(after, p.invariants(p.instances[i], half.end)));
        }
    }
    const char* const reason = finer == nullptr ? of_tolerance : of_halving;
    s.rows.add(about, "failed instances", failed, bounds::at_most(0), "every instance has a solution");
    s.rows.add(about, "end state, worst", end.value, bounds::at_most(end.bound), reason);
    s.rows.add(about, "end state, largest", largest(errors));
    s.rows.add(about, "end state, median", median(errors));
    if (!p.event_times.empty()) s.rows.add(about, "event times", event.value, bounds::at_most(event.bound), reason);
    if (accessory.bound < bounds::infinite)
        s.rows.add(about, "accessories", accessory.value, bounds::at_most(accessory.bound), reason);
    if (!r.known[0].count.empty())
        s.rows.add(about, "instances with other event counts", other_counts, bounds::at_most(0),
                   "no event is close to being missed");
    if (p.invariants) s.rows.add(about, "invariants", invariant.value, bounds::at_most(invariant.bound), reason);
    s.rows.add(about, "accepted steps", plain.sum(plain.accepted));
    s.rows.add(about, "rejected steps", plain.sum(plain.rejected));
    s.rows.add(about, "evaluations", plain.sum(plain.evaluations));

    if (s.record != nullptr) s.record->add(run_name(p, m, kind, setting), plain);
    if (s.compare != nullptr) {
        const auto* there = s.compare->find(run_name(p, m, kind, setting));
        if (there != nullptr) compare_backends(s, p, m, setting, "recorded results", twice, plain, *there);
    }
    if (s.device.which() == myriad::device::kind::cuda)
        compare_backends(s, p, m, setting, "the CPU", twice, plain, as_recorded(m.run(p, o, myriad::device::cpu())));

    if (p.sampled.empty()) return median(errors);
    o.samples = {.states = p.sampled, .capacity = p.samples, .evenly = p.samples};
    const outcome sampled = m.run(p, o, s.device);
    worst samples, moved;
    for (std::size_t i = 0; i < size; ++i) {
        moved.add(distance(sampled.instances[i].end, plain.instances[i].end), 1e-300);
        const double bound = r.conditions[i].path * (plain.accepted[i] * (tolerance + m.eps) + located + r.error[i]);
        double error = sampled.instances[i].samples.size() == r.known[i].samples.size() ? 0 : unknown;
        for (std::size_t k = 0; k < sampled.instances[i].samples.size(); ++k)
            error = larger(error, distance(sampled.instances[i].samples[k], r.known[i].samples[k]));
        samples.add(error, bound);
    }
    // For others, the order is measured with fixed steps.
    s.rows.add(about, "samples", samples.value,
               m.adaptive() && m.samples_keep_tolerance() ? bounds::at_most(samples.bound) : bounds::none(),
               "as for the end state, as the interpolant is as accurate as the steps");
    s.rows.add(about, "change of the end state by samples", moved.value, bounds::at_most(moved.bound),
               "samples change no bit of the steps");
    return median(errors);
}

}  // namespace

void measure_tolerances(session& s, const problem& p, const method_entry& m, const references& r) {
    myriad::options o;
    o.events = p.events;
    if (m.takes_long_steps() && !o.events.empty()) o.sub_samples = 16;
    const bool is_float = m.precision == "float";
    if (is_float)
        for (auto& e : o.events) e.tolerance = 1e-5;
    if (!m.adaptive()) {
        o.step = p.fixed_step;
        myriad::options half = o;
        half.step = o.step / 2;
        const outcome finer = m.run(p, half, s.device);
        measure_run(s, p, m, r, "h", o.step, 0, o, &finer);
        return;
    }
    o.step = 1e-2;             // the first one, as in the recorded results
    o.max_steps = 10'000'000;  // which low orders need at tight tolerances
    std::vector<double> tolerances = {1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11};
    if (s.quick()) tolerances = {1e-5, 1e-8, 1e-11};
    if (is_float) tolerances = {1e-3, 1e-4, 1e-5};
    std::vector<double> logarithms_of_tolerance, logarithms_of_error;
    problem local = p;
    local.events = o.events;
    for (const double tolerance : tolerances) {
        o.relative_tolerance = o.absolute_tolerance = tolerance;
        const double error = measure_run(s, local, m, r, "tolerance", tolerance, tolerance, o);
        s.rows.add(s.about(p, m, tolerance), "median error over tolerance", error / tolerance);
        if (is_float || error < 100 * median(r.error) || error < 1e-12) continue;
        // There steps of high order are as long as the times in which the solution changes, and errors a matter of
        // luck.
        if (m.takes_long_steps() && tolerance == tolerances.front()) continue;
        logarithms_of_tolerance.push_back(std::log10(tolerance));
        logarithms_of_error.push_back(std::log10(error));
    }
    if (!p.error_follows_tolerance || logarithms_of_error.size() < 2) return;
    // The two loosest tolerances alone, where the reference's error hides the others, say little of the order.
    if (logarithms_of_tolerance.front() - logarithms_of_tolerance.back() < 1.5) return;
    // The step is proportional to tolerance^(1/(q+1)), q the order of the estimate, and the error to step^p.
    const double slope = (logarithms_of_error.back() - logarithms_of_error.front()) /
                         (logarithms_of_tolerance.back() - logarithms_of_tolerance.front());
    // Stiffness reduces the order of Rosenbrock methods, of rodas_5p to three (Prothero and Robinson's problem).
    const double least = std::min(m.order, p.stiff ? 3 : m.order) / (m.embedded_order + 1.0),
                 most = (m.order + 1) / (m.embedded_order + 1.0);
    s.rows.add(
        s.about(p, m, 0), "exponent of the tolerance in the error", slope, bounds::within(least - 0.2, most + 0.2),
        "order (or one more, where its error constant is small) over order of the estimate plus one; a fifth for "
        "errors of one sign that meet errors of the other");
}

}  // namespace validation
