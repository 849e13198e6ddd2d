// SPDX-License-Identifier: MIT
// Solver objects that take turns: while one integrates, others are downloaded, written to a file and refilled, on one
// device or several; with a timeline of the overlap.
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "../common/command_line.hpp"
#include "../common/csv_file.hpp"
#include "chunked_sweep.hpp"
#include "timeline_output.hpp"

namespace {

struct {
    std::vector<std::string> devices;
    std::int64_t solvers = 2, chunks = 16;
    bool check = false;
} own;

/// The devices of --devices, else that of --device.
std::vector<myriad::device> chosen_devices(const myriad::device& one) {
    std::vector<myriad::device> devices;
    if (own.devices == std::vector<std::string>{"all"}) {
        for (const myriad::device& d : myriad::devices())
            if (d.which() == myriad::device::kind::cuda) devices.push_back(d);
    } else {
        for (const std::string& name : own.devices) devices.push_back(myriad::device::parse(name));
    }
    if (devices.empty()) devices.push_back(one);
    return devices;
}

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const auto devices = chosen_devices(device);
    examples::csv_file file(chosen.output);
    chunked_sweep sweep(chosen, devices, own.solvers, own.chunks);
    const auto all = sweep.run();
    if (!chosen.quiet) print_shares(all, devices, own.solvers);
    write_timeline(file, all, chosen, devices, own.solvers);
    if (!chosen.quiet) std::cout << "Written to " << chosen.output << " and " << sweep.tables() << '\n';
    if (sweep.failed() > 0) std::cerr << sweep.failed() << " instances failed\n";
    if (!own.check) return sweep.failed() > 0 ? 1 : 0;

    // snippet: whole
    myriad::ensemble<duffing> whole(chosen.instances);
    duffing_sweep::fill(whole, 0, chosen.instances, chosen.instances);
    for (int c = 0; c < duffing::n_accessory; ++c) whole.accessory(c) = 0.0;
    myriad::solve<myriad::cash_karp>(devices.front(), whole, duffing_sweep::integration(chosen.phases));
    duffing_sweep::results expected(chosen.instances);
    expected.take(whole, 0, chosen.instances);
    const bool same = sweep.results() == expected;
    // end of snippet
    if (!same) std::cerr << "The chunks do not have the bits of one call of solve over all of them\n";
    if (same && !chosen.quiet) std::cout << "The chunks have the bits of one call of solve over all of them\n";
    return same && sweep.failed() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(
        argc, argv,
        {.description = "Solver objects that take turns over chunks of the Duffing sweep",
         .full = {.instances = 2'097'152, .phases = 192},
         .small = {.instances = 8000, .phases = 8},
         .output = "results/overlap.csv",
         .phases_help = "Phases to integrate, periods of the forcing",
         .has_transient = false,
         .options = {{"--devices", &own.devices, "Devices to spread over, as cuda:0,cuda:1, or all: every GPU",
                      "NAMES"},
                     {"--solvers", &own.solvers, "Solver objects on each device", "N",
                      examples::own_option::range{1, 16}},
                     {"--chunks", &own.chunks, "Parts of the sweep", "N", examples::own_option::range{1, 100'000}},
                     {"--check", &own.check, "Integrate it in one call of solve too, and compare the bits"}}},
        run);
}
