// SPDX-License-Identifier: MIT
// Order of the error estimate, from the step size that the controller proposes after one step of given length. This
// detects a wrong weight of the embedded solution, which no solution shows.
#include <algorithm>
#include <cmath>

#include "measures.hpp"

namespace validation {

void measure_estimate(session& s, const problem& p, const method_entry& m) {
    if (p.longest_step == 0 || !m.adaptive() || m.precision != "double") return;
    problem one_step = without_events(p);
    // With tolerance 1 the estimate is (0.9 h / h_next)^(q+1), to the 1e-4 of the controller's power.
    const auto estimate = [&](double h) {
        for (auto& i : one_step.instances) i.t_end = h;
        myriad::options o;
        o.step = h;
        o.absolute_tolerance = 1;
        o.relative_tolerance = 1e-30;
        o.growth_limit = 1e30;
        o.events = one_step.events;
        const outcome run = m.run(one_step, o, s.device);
        double squares = 0;
        for (std::size_t i = 0; i < run.next_step.size(); ++i)
            squares += std::pow(0.9 * h / run.next_step[i], 2 * (m.embedded_order + 1));
        return std::sqrt(squares / static_cast<double>(run.next_step.size()));
    };
    double h = (m.takes_long_steps() ? 2 : 1) * p.longest_step, coarse = estimate(h), order = unknown;
    for (int k = 0; k < 8; ++k) {
        const double fine = estimate(h / 2);
        s.rows.add(s.about(p, m, h / 2), "error estimate, root mean square", fine);
        if (!(fine > (m.takes_long_steps() ? 1e3 : 1e4) * eps_double * h))
            break;  // only roundings of h f, which cancel in the estimate
        order = std::log2(coarse / fine);
        coarse = fine;
        h /= 2;
    }
    s.rows.add(s.about(p, m, h), "order of the error estimate", order,
               m.takes_long_steps() ? bounds::within(m.embedded_order + 0.2, m.embedded_order + 2)
                                    : bounds::within(m.embedded_order + 0.7, m.embedded_order + 1.3),
               "estimate = C h^(q+1) (1 + O(h)), h larger for high orders");
}

}  // namespace validation
