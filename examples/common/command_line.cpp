// SPDX-License-Identifier: MIT
#include "command_line.hpp"

#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>

#include "csv_file.hpp"
#include "device_option.hpp"
#include "plot.hpp"

namespace examples {
namespace {

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

template <class Value>
constexpr bool is_list = false;
template <class Element>
constexpr bool is_list<std::vector<Element>> = true;

template <class Value>
void add(CLI::App& app, const own_option& offered, Value& variable) {
    CLI::Option* const option = app.add_option(offered.name, variable, offered.meaning);
    if (!offered.type_name.empty()) option->type_name(offered.type_name);
    if constexpr (is_list<Value>) {
        option->delimiter(',');
        if (!variable.empty()) option->capture_default_str();
    } else {
        option->capture_default_str();
    }
    if (const auto* range = std::get_if<own_option::range>(&offered.allowed)) {
        using bound = std::conditional_t<std::is_integral_v<Value>, std::int64_t, double>;
        const CLI::Range within(static_cast<bound>(range->front()), static_cast<bound>(range->back()));
        option->check(within.description(""));
    } else if (const auto* names = std::get_if<own_option::names>(&offered.allowed)) {
        option->check(CLI::IsMember(*names).description(""));
    }
}
void add(CLI::App& app, const own_option& offered, bool& variable) {
    app.add_flag(offered.name, variable, offered.meaning);
}

/// Exit status of an error, which depends on what was written before it.
int error_status() { return csv_file::any_is_there() ? 3 : 2; }

}  // namespace

int run_sweep(int argc, const char* const* argv, const study& offered,
              const std::function<int(const sweep_options&, const myriad::device&)>& sweep) {
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
    for (const own_option& option : offered.options)
        std::visit([&](auto* variable) { add(app, option, *variable); }, option.variable);

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
            picture->draw(plot_script, options.output, options.picture);
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
