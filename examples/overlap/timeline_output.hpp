// SPDX-License-Identifier: MIT
// The timeline as a table and as a summary.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "../common/command_line.hpp"
#include "../common/csv_file.hpp"
#include "timeline.hpp"

/// A table of all intervals. Solver objects are numbered device by device.
inline void write_timeline(examples::csv_file& file, const std::vector<interval>& all,
                           const examples::sweep_options& chosen, const std::vector<myriad::device>& devices,
                           std::int64_t solvers) {
    using myriad::message;
    file.comment(message("Duffing sweep of ", chosen.instances, " instances over ", chosen.phases,
                         " phases: which solver object did what with which chunk, and when"));
    for (std::size_t d = 0; d < devices.size(); ++d)
        file.comment(message("device ", d, ": ", devices[d].name(), ", ", devices[d].description()));
    file.comment(
        "step: 0 fill, 1 upload, 2 integrate, 3 download, 4 write to a file; begin, end: seconds of the host's "
        "clock; kernel_seconds: the GPU's own time for the integration");
    file.row("solver", "device", "chunk", "step", "begin", "end", "kernel_seconds");
    for (const interval& i : all)
        file.row(i.solver, i.solver / solvers, i.chunk, static_cast<int>(i.what), i.begin, i.end, i.kernel_seconds);
    file.commit();
}

/// Prints how much overlapped.
inline void print_shares(const std::vector<interval>& all, const std::vector<myriad::device>& devices,
                         std::int64_t solvers) {
    double last = 0, sum = 0;
    for (const interval& i : all) {
        last = std::max(last, i.end);
        sum += i.end - i.begin;
    }
    const auto percent = [&](double seconds) { return std::to_string(100 * seconds / last).substr(0, 4) + " %"; };
    std::cout << last << " s, in which steps of " << sum << " s were done: two or more at once for "
              << percent(seconds_with(all, 2)) << " of the time\n";
    for (std::size_t d = 0; d < devices.size(); ++d) {
        std::vector<interval> integrations;
        double kernels = 0;
        for (const interval& i : all) {
            if (i.what != step::integrate || i.solver / solvers != static_cast<std::int64_t>(d)) continue;
            integrations.push_back(i);
            kernels += i.kernel_seconds;
        }
        std::cout << devices[d].name() << " integrated for " << percent(seconds_with(integrations, 1));
        if (kernels > 0) std::cout << "; its kernels took " << kernels << " s";
        std::cout << '\n';
    }
}
