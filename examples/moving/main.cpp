// SPDX-License-Identifier: MIT
// A sweep over mu by Myriad, as a table. odeint.cpp and scipy_side.py do the same with other packages.
#include <cstdio>

#include <myriad/myriad.hpp>

#include "model.hpp"

int main() {
    // snippet: sweep
    myriad::ensemble<van_der_pol> sweep(1024);
    sweep.parameter(van_der_pol::mu).setLinSpaced(0.5, 4.0);
    sweep.state(van_der_pol::x) = 1;
    sweep.state(van_der_pol::v) = 0;
    sweep.time_domain(0, 20);

    const auto report = myriad::solve<myriad::dormand_prince_5>(
        myriad::device::best(), sweep, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-8});
    const auto x = sweep.state(van_der_pol::x);  // at t = 20, one value for each mu
    // end of snippet
    if (report.failed() > 0) return 1;

    std::puts("mu,x,v");
    for (Eigen::Index i = 0; i < sweep.size(); ++i)
        std::printf("%.17g,%.17g,%.17g\n", sweep.parameter(van_der_pol::mu)[i], x[i], sweep.state(van_der_pol::v)[i]);
    return std::fflush(stdout) == 0 ? 0 : 1;
}
