// SPDX-License-Identifier: MIT
// What every sweep does around `solve`: progress, the report, and the exit status.
#pragma once

#include <cstdint>
#include <iostream>

#include "command_line.hpp"
#include "myriad/myriad.hpp"

namespace examples {

/// `myriad::solve`, with progress on stderr and the report on stdout, unless quiet.
template <class Method, class Model, class R>
myriad::report<Model, R> integrate(const sweep_options& chosen, const myriad::device& device,
                                   myriad::ensemble<Model, R>& sweep, myriad::options options) {
    if (!chosen.quiet) {
        std::cerr << "Integrating " << sweep.size() << " instances over ";
        if (chosen.transient > 0) std::cerr << chosen.transient << " + ";
        std::cerr << options.phases - chosen.transient << " phases\n";
    }
    if (!chosen.quiet) options.progress = myriad::progress_line();
    auto report = myriad::solve<Method>(device, sweep, options);
    if (!chosen.quiet) std::cout << report;
    return report;
}

/// Prints where the results are and which instances failed. Returns the exit status: 0, or 1 if some failed. The status
/// `expected`, a finding of the study, is no failure.
template <class Model, class R>
int conclude(const sweep_options& chosen, const myriad::report<Model, R>& report,
             myriad::status expected = myriad::status::success) {
    if (!chosen.quiet) std::cout << "Written to " << chosen.output << '\n';
    const std::int64_t failed = report.failed() - (expected == myriad::status::success ? 0 : report.count(expected));
    if (failed == 0) return 0;
    std::cerr << failed << " of " << report.instances << " instances failed, the first of them instance "
              << report.first_failed << ": " << myriad::name_of(report.first_status) << " at t = " << report.first_t
              << "; what they did not complete is nan in " << chosen.output << '\n';
    return 1;
}

}  // namespace examples
