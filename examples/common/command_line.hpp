// SPDX-License-Identifier: MIT
// The options that every sweep has, and the exit statuses of every example: 0 all is well, 1 some instances failed,
// 2 an error, with its reason on stderr, and no file was written.
#pragma once

#include <csignal>
#include <cstdint>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include <CLI/CLI.hpp>

#include "myriad/device.hpp"

namespace examples {

struct sweep_options {
    std::int64_t instances = 0;
    std::int64_t transient = 0;  // phases to let pass
    std::int64_t recorded = 0;   // phases to keep
    std::string device = "auto";
    std::string output;
    bool quiet = false;
};

/// What `--device` may be, in this program.
inline std::string device_help() {
    const bool with_cuda = myriad::host::if_defined(&myriad::cuda::list_devices) != nullptr;
    return with_cuda ? "Where to compute: auto (a GPU if there is one), cpu, cpu:THREADS, cuda or cuda:NUMBER"
                     : "Where to compute: auto, cpu or cpu:THREADS (built without the CUDA backend)";
}

/// Says where the sweep is computed and, if a GPU would have been taken, why there is none.
inline void announce(const std::string& wanted, const myriad::device& device) {
    std::cerr << "Computing on " << device.name();
    if (device.which() == myriad::device::kind::cuda) {
        std::cerr << " (" << device.description() << ')';
    } else if (wanted == "auto") {
        std::cerr << "; no GPU: " << myriad::device::no_gpu();
    }
    std::cerr << '\n';
}

/// Parses the command line over the given defaults and calls `sweep(options, device)`, which returns the exit status.
template <class Sweep>
int run_sweep(int argc, const char* const* argv, const std::string& description, sweep_options options, Sweep&& sweep) {
    CLI::App app(description);
    const auto add_count = [&app](const char* name, std::int64_t& count, std::int64_t least, const char* meaning) {
        const CLI::Range range(least, std::int64_t{100'000'000});
        app.add_option(name, count, meaning)->check(range.description(""))->type_name("N")->capture_default_str();
    };
    add_count("--instances", options.instances, 1, "Number of instances");
    add_count("--transient", options.transient, 0, "Phases to let pass");
    add_count("--recorded", options.recorded, 1, "Phases to record after them");
    app.add_option("--device", options.device, device_help())->type_name("NAME")->capture_default_str();
    app.add_option("--output", options.output, "File to write, as comma-separated values")
        ->type_name("FILE")
        ->capture_default_str();
    app.add_flag("--quiet", options.quiet, "Print nothing but errors");
    // So that a limit on the size of files is an error that the writer reports, like a full disk, and no sudden death.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        app.parse(argc, argv);
        const myriad::device device = myriad::device::parse(options.device);
        if (!options.quiet) announce(options.device, device);
        const int status = sweep(options, device);
        if (!std::cout.flush()) throw std::runtime_error("standard output cannot be written");
        return status;
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::bad_alloc&) {
        std::cerr << "There is not enough memory: take fewer instances, or fewer recorded phases\n";
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return 2;
}

}  // namespace examples
