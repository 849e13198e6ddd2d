// SPDX-License-Identifier: MIT
// The options of every sweep, and the exit statuses of every example: 0 success, 1 some instances failed, 2 an error,
// with its reason on stderr, and no file was written, 3 an error after a file was written: its picture, another file or
// standard output failed.
#pragma once

#include <csignal>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "csv_file.hpp"
#include "device_option.hpp"
#include "exit_status.hpp"
#include "myriad/device.hpp"
#include "plot.hpp"

namespace examples {

/// The size of the computation.
struct sweep_size {
    std::int64_t instances = 0;
    std::int64_t transient = 0;  // phases to discard
    std::int64_t phases = 1;     // phases to keep after them
};

/// The choices made on the command line.
struct sweep_options : sweep_size {
    std::string device = "auto";
    std::string output;
    std::string picture;  // empty: none
    bool quiet = false;
};

/// What a program computes and offers on the command line.
struct study {
    std::string description;
    sweep_size full;     // as in the paper, or a few seconds on a GPU
    sweep_size small;    // a few seconds on two cores
    std::string output;  // file to write if none is named
    std::string instances_help = "Number of instances";
    std::string phases_help = "Phases to record after the transient ones";
    std::string output_help = "File to write, as comma-separated values";
    bool has_transient = true;
    std::function<void(CLI::App&)> add_options = {};  // further options of this program
};

/// A count that the command line may give; otherwise that of the study's size.
class chosen_count {
public:
    chosen_count(CLI::App& app, const std::string& names, std::int64_t least, const std::string& meaning,
                 std::int64_t full, std::int64_t small)
        : full_(full), small_(small) {
        const CLI::Range range(least, std::int64_t{100'000'000});
        const std::string standard = std::to_string(full) + "; with --small " + std::to_string(small);
        app.add_option(names, given_, meaning)->check(range.description(""))->type_name("N")->default_str(standard);
    }
    std::int64_t value(bool small) const { return given_.value_or(small ? small_ : full_); }

private:
    std::optional<std::int64_t> given_;
    std::int64_t full_, small_;
};

/// Exit status of an error, which depends on what was written before it.
inline int error_status() { return csv_file::any_is_there() ? 3 : 2; }

/// Parses the command line and calls `sweep(options, device)`, which returns the exit status; then draws the picture.
template <class Sweep>
int run_sweep(int argc, const char* const* argv, const study& offered, Sweep&& sweep) {
    CLI::App app(offered.description);
    const sweep_size &full = offered.full, &small = offered.small;
    const chosen_count instances(app, "--instances", 1, offered.instances_help, full.instances, small.instances);
    std::optional<chosen_count> transient;
    if (offered.has_transient)
        transient.emplace(app, "--transient", 0, "Phases to let pass", full.transient, small.transient);
    const chosen_count phases(app, "--phases,--recorded", 1, offered.phases_help, full.phases, small.phases);
    bool is_small = false;
    app.add_flag("--small", is_small, "A size that takes seconds on two cores");

    sweep_options options;
    options.output = offered.output;
    app.add_option("--device", options.device, device_help())->type_name("NAME")->capture_default_str();
    app.add_option("--output", options.output, offered.output_help)->type_name("FILE")->capture_default_str();
    CLI::Option* const plot = app.add_option("--plot", options.picture, "Draw a picture of it too (default: FILE.png)")
                                  ->type_name("PNG")
                                  ->expected(0, 1);
    app.add_flag("--quiet", options.quiet, "Print nothing but errors");
    if (offered.add_options) offered.add_options(app);

    // So that a limit on file size is an error that the writer reports, like a full disk, and kills no program.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        app.parse(argc, argv);
        options.instances = instances.value(is_small);
        options.transient = transient ? transient->value(is_small) : 0;
        options.phases = phases.value(is_small);
        if (plot->count() > 0 && options.picture.empty())
            options.picture = std::filesystem::path(options.output).replace_extension(".png").string();

        std::optional<plotter> picture;
        if (!options.picture.empty()) picture.emplace();
        const myriad::device device = myriad::device::parse(options.device);
        if (!options.quiet) announce(options.device, device);
        const int status = sweep(std::as_const(options), device);
        if (picture && status < 2) {
            picture->draw(MYRIAD_PLOT_SCRIPT, options.output, options.picture);
            if (!options.quiet) std::cout << "Drawn to " << options.picture << '\n';
        }
        return after_output(status, error_status());
    } catch (const CLI::ParseError& e) {
        return after_output(app.exit(e) == 0 ? 0 : 2);
    } catch (const std::bad_alloc&) {
        std::cerr << "There is not enough memory: take fewer instances, or fewer recorded phases\n";
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return error_status();
}

}  // namespace examples
