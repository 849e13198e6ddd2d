// SPDX-License-Identifier: MIT
// Studies: a grid with random starts whose results go to a folder and to a netCDF file, and instances that a function
// generates, reduced to sums.
#include <cmath>
#include <cstdint>
#include <exception>
#include <iostream>
#include <numbers>
#include <span>
#include <vector>

#include <myriad/study.hpp>

#include "../quickstart/model.hpp"

namespace {

void run_grid() {
    // snippet: grid
    myriad::study<duffing, myriad::cash_karp> sweep;
    sweep.axis("k", myriad::linspace(0.2, 0.3, 200));  // two axes: a grid of 200 times 9 instances,
    sweep.axis("x", myriad::linspace(-1, 1, 9));       // the last axis varying fastest
    sweep.axis("v", myriad::normal(0, 0.1));           // a value of its own for each instance
    sweep.set("B", 0.3);                               // the same for all
    sweep.time_domain(0, 2 * std::numbers::pi);
    sweep.options = {.phases = 68, .relative_tolerance = 1e-9, .record = {.from_phase = 64, .states = {duffing::x}}};
    sweep.keep.end = {"v"};  // beside what is recorded, the last value of v
    sweep.reduce(myriad::histogram_of("x", myriad::linspace(-2, 2, 101)));
    sweep.store("duffing_study");  // where results are kept while it runs, and where it goes on if it is run again
    sweep.devices = {myriad::device::best()};
    sweep.progress = myriad::progress_line();
    const myriad::study_result result = sweep.run();

    std::cout << result;
    myriad::export_netcdf(result.results(), "duffing_study.nc");
    // end of snippet
}

void run_generated() {
    // snippet: generated
    myriad::study<duffing, myriad::cash_karp> study;
    study.repeat(1000);
    study.set("B", 0.3);
    study.time_domain(0, 2 * std::numbers::pi);
    study.generate("circle, version 1", [](std::int64_t first, myriad::ensemble<duffing>& instances) {
        for (std::int64_t i = 0; i < instances.size(); ++i) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(first + i) / 1000;
            instances.state(duffing::x)[i] = std::cos(angle);
            instances.state(duffing::v)[i] = std::sin(angle);
        }
        instances.parameter(duffing::k) = 0.25;
    });
    study.keep.status = false;  // nothing is kept of every instance,
    study.reduce(myriad::mean_of("x_end"));
    study.reduce(myriad::sum_of("energy", {"x_end", "v_end"}, 2,  // but sums of potential and kinetic energy
                                [](const myriad::chunk_columns& chunk, std::span<double> sums) {
                                    const auto x = chunk.values<double>("x_end"), v = chunk.values<double>("v_end");
                                    for (std::size_t i = 0; i < x.size(); ++i) {
                                        if (myriad::is_failure(chunk.status(static_cast<std::int64_t>(i)))) continue;
                                        sums[0] += x[i] * x[i] * (x[i] * x[i] / 4 - 0.5);
                                        sums[1] += v[i] * v[i] / 2;
                                    }
                                }));
    const myriad::study_result result = study.run();

    const std::vector<double> energy = result.values("energy");
    std::cout << "mean of x: " << result.values("x_end_mean")[0] << ", mean energy: " << (energy[0] + energy[1]) / 1000
              << '\n';
    // end of snippet
}

}  // namespace

int main() try {
    run_grid();
    run_generated();
    return std::cout.flush() ? 0 : 1;
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
}
