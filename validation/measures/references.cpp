// SPDX-License-Identifier: MIT
// The references: CVODE at two tolerances, whose difference gives its error, next to closed forms and quadruple
// precision.
#include <algorithm>
#include <cmath>

#include "measures.hpp"

namespace validation {

references measure_references(session& s, const problem& p) {
    constexpr double fine = 3e-14, coarse = 3e-13;
    const std::size_t size = p.instances.size();
    references r;
    r.known.resize(size);
    r.error.resize(size);
    r.conditions.resize(size);
    std::vector<double> by_itself(size), to_exact(size, 0), growth(size), events(size, 0);
    for_each_in_parallel(size, [&](std::size_t i) {
        const instance& from = p.instances[i];
        const std::int64_t samples = p.sampled.empty() ? 0 : p.samples;
        solution known = p.by_cvode(from, {fine, samples});
        by_itself[i] = distance(p.by_cvode(from, {coarse, 0}).end, known.end);
        r.error[i] = by_itself[i];
        r.conditions[i] = p.conditions(from);
        growth[i] = r.conditions[i].end;
        if (p.exactly) {
            const solution exact = p.exactly(from, samples);
            to_exact[i] = distance(known.end, exact.end);
            for (const int a : p.event_times) {
                const auto k = static_cast<std::size_t>(a);
                if (k < exact.accessory.size())
                    events[i] = larger(events[i], std::abs(known.accessory[k] - exact.accessory[k]));
            }
            if (p.closed_form_error == 0) {
                for (std::size_t c = 0; c < exact.end.size(); ++c) {
                    if (std::isnan(exact.end[c])) continue;
                    known.end[c] = exact.end[c];
                }
                const auto open = [](double x) { return std::isnan(x); };
                if (std::none_of(exact.end.begin(), exact.end.end(), open)) r.error[i] = 0;
                if (!exact.accessory.empty()) known.accessory = exact.accessory;
                if (!exact.samples.empty()) {
                    for (std::size_t k = 0; k < known.samples.size(); ++k)
                        for (std::size_t c = 0; c < p.sampled.size(); ++c)
                            known.samples[k][c] = exact.samples[k][static_cast<std::size_t>(p.sampled[c])];
                }
            }
        }
        r.known[i] = std::move(known);
    });
    const subject about{p.name, "CVODE", "double", "cpu", fine};
    s.rows.add(about, "growth of errors, largest", largest(growth));
    s.rows.add(about, "growth of errors, median", median(growth));
    s.rows.add(about, "reference against itself at ten times the tolerance", largest(by_itself));
    if (!p.exactly) return r;
    // CVODE's error is its own estimate and somewhat more, as errors of steps add up differently at each tolerance
    double growth_there = 0;
    for (std::size_t i = 0; i < size; ++i)
        if (to_exact[i] > 0) growth_there = larger(growth_there, growth[i]);
    const double allowed =
        std::max(10 * largest(by_itself), 1e4 * fine * std::max(1.0, growth_there)) + p.closed_form_error;
    s.rows.add(about, "reference against closed form or quadruple precision", largest(to_exact),
               bounds::at_most(allowed),
               p.closed_form_error > 0 ? "error of the collocation"
                                       : "ten times CVODE's difference from itself, or ten thousand steps");
    if (!p.event_times.empty() && largest(events) > 0)
        s.rows.add(about, "event times against closed form", largest(events), bounds::at_most(allowed),
                   "as for the end state");
    return r;
}

}  // namespace validation
