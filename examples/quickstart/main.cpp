// SPDX-License-Identifier: MIT
// The program of the README: a bifurcation diagram of 4608 values of k as comma-separated values on standard output.
// snippet: main
#include <iostream>
#include <numbers>

#include <myriad/myriad.hpp>

#include "model.hpp"

int main() {
    myriad::ensemble<duffing> sweep(4608);
    sweep.parameter(duffing::k) = Eigen::ArrayXd::LinSpaced(sweep.size(), 0.2, 0.3);
    sweep.shared(duffing::B) = 0.3;
    sweep.state(duffing::x) = -0.5;
    sweep.state(duffing::v) = -0.1;
    sweep.time_domain(0, 2 * std::numbers::pi);  // one phase: a period of the forcing

    const auto report = myriad::solve<myriad::cash_karp>(
        myriad::device::best(), sweep,
        {.phases = 256 + 32, .relative_tolerance = 1e-9, .record = {.from_phase = 256, .states = {duffing::x}}});
    std::cerr << report;

    const auto x = report.records.state(duffing::x);  // one row per instance, one column per recorded phase
    std::cout << "k,x\n";
    for (int i = 0; i < x.rows(); ++i)
        for (int phase = 0; phase < x.cols(); ++phase)
            std::cout << sweep.parameter(duffing::k)[i] << ',' << x(i, phase) << '\n';
    return std::cout.flush() ? 0 : 1;  // fails on a full disk, for example
}
// end of snippet
