// SPDX-License-Identifier: MIT
// The commands of the program.
#include "program/commands.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/options/option_table.hpp"
#include "myriad/host/report/progress.hpp"
#include "myriad/program.hpp"
#include "myriad/study/run/stop_signals.hpp"
#include "myriad/study/store/file_system.hpp"
#include "myriad/study/store/metadata.hpp"
#include "myriad/study/store/store.hpp"
#include "myriad/study/study.hpp"
#include "myriad/version.hpp"
#include "program/program_files.hpp"
#include "program/result_commands.hpp"
#include "program/wanted_model.hpp"

namespace myriad::programs {

namespace {

namespace fs = std::filesystem;

std::vector<device> devices_of(const std::vector<std::string>& names) {
    return as_input([&] {
        std::vector<device> all;
        for (const std::string& name : names) all.push_back(device::parse(name));
        return all;
    });
}

// ---------------------------------------------------------------------------------------------------------------------
// Models
// ---------------------------------------------------------------------------------------------------------------------

void show_list(const std::string& what, const std::vector<std::string>& names) {
    if (names.empty()) return;
    std::string line = message("  ", what, ':');
    line.resize(std::max<std::size_t>(line.size() + 1, 22), ' ');
    for (std::size_t i = 0; i < names.size(); ++i) line += message(i > 0 ? ", " : "", names[i]);
    std::cout << line << '\n';
}

void show_model(const program_model& model) {
    std::cout << plain_name(model.names.model()) << '\n';
    constexpr std::pair<studies::component_kind, const char*> kinds[] = {
#define MYRIAD_KIND_AND_PLURAL(kind, plural, ...) {studies::component_kind::kind, #plural},
        MYRIAD_VALUE_KINDS(MYRIAD_KIND_AND_PLURAL)
#undef MYRIAD_KIND_AND_PLURAL
    };
    for (const auto& [kind, plural] : kinds) {
        std::string what = plural;
        std::replace(what.begin(), what.end(), '_', ' ');
        std::vector<std::string> names;
        for (const studies::component& c : model.names.all())
            if (c.kind == kind) names.push_back(c.name.empty() ? std::to_string(c.number) : c.name);
        show_list(what, names);
    }
    std::vector<std::string> events;
    for (std::size_t e = 0; e < model.events.size(); ++e)
        events.push_back(model.events[e].empty() ? std::to_string(e) : model.events[e]);
    show_list("events", events);
    std::vector<std::string> methods;
    for (const program_method& m : model.methods)
        methods.push_back(m.name + (m.real == studies::element::f32 ? " (float)" : ""));
    show_list("methods", methods);
}

// ---------------------------------------------------------------------------------------------------------------------
// Studies
// ---------------------------------------------------------------------------------------------------------------------

/// What the command line says of a run.
struct run_request {
    std::string file, folder, model, header;
    std::vector<std::string> devices;
    std::string exported;
    bool only_check = false, checksums = false, any_arithmetic = false, quiet = false, compiles = false;
    compile_permission permission() const {
        return compiles ? compile_permission::given : compile_permission::not_given;
    }
};

/// Files of the program in the folder of results.
std::string kept_study(const std::string& folder) { return folder + "/myriad/study.toml"; }
std::string kept_model(const std::string& folder) { return folder + "/myriad/model.hpp"; }

void keep_file(const std::string& path, const std::string& text) {
    studies::file_system& files = studies::file_system::real();
    if (fs::is_regular_file(path) && studies::read_text(files, path) == text) return;
    studies::write_text(files, message(path, ".part-", ::getpid()), path, text);
}

/// A header as `kept_model` has it.
model_source kept_source(const std::string& path) {
    model_source source{"model.hpp", read_file(path)};
    const std::size_t begin = source.text.find('"'), end = source.text.find('"', begin + 1);
    if (source.text.starts_with("#line 1 \"") && end != std::string::npos)
        source.name = source.text.substr(begin + 1, end - begin - 1);
    return source;
}

/// A path that a file names, which is from the folder of that file.
std::string beside(const std::string& file, const std::string& path) {
    return (fs::path(file).parent_path() / path).lexically_normal().string();
}

/// The number of instances of a study that is done, if none of them could be integrated; else 0.
std::int64_t all_invalid(const std::string& folder) {
    const studies::store_progress now = open_store(folder).progress();
    const auto found = std::find_if(now.statuses.begin(), now.statuses.end(),
                                    [](const auto& of) { return of.first == "invalid_input"; });
    return found != now.statuses.end() && found->second == now.all_instances ? now.all_instances : 0;
}

/// Runs a study; the header is there already when it goes on.
int run_study(const run_request& asked, study_file& file, const std::string& text, const std::string& folder,
              study_file::model_choice wanted, const std::optional<model_source>& header) {
    if (header) compile_model(wanted, *header, asked.permission(), asked.quiet);
    const program_model& model = find_model(wanted);
    any_study study(find_method(model, wanted).make());
    file.set_up(study, model, devices_of(asked.devices));
    if (header) study.note("source of the model", header->digest());
    studies::store_options options = file.store_options();
    if (asked.checksums) options.check = studies::resume_check::checksums;
    if (asked.any_arithmetic) options.others = studies::other_arithmetic::warn;
    if (asked.only_check) {
        try {
            study.check();
        } catch (const error& e) {
            throw file.placed_error(e);
        }
        std::cout << study.size() << " instances\n";
        return 0;
    }
    study.store(folder, options);
    study.stop_on_signals = true;
    if (!asked.quiet) study.progress = progress_line();
    try {
        study.check();
    } catch (const studies::file_error&) {
        throw;
    } catch (const error& e) {
        throw file.placed_error(e);
    }
    keep_file(kept_study(folder), text);
    if (header) keep_file(kept_model(folder), header->text);

    const study_result result = [&] {
        try {
            return study.run();
        } catch (const error& e) {
            throw error(file.told(e));
        }
    }();
    std::cout << result << "results: " << folder << '\n';
    if (!result.complete) {
        const int signal = studies::stop_signals::last();
        tell(message("stopped: `myriad resume ", folder, "` goes on"));
        return signal > 0 ? 128 + signal : 1;
    }
    if (!asked.exported.empty()) export_results(result.results(), asked.exported, "");
    if (const std::int64_t count = all_invalid(folder); count > 0) {
        tell(message("all ", count,
                     " instances are invalid_input, and none was integrated: initial values, parameters "
                     "and times must be finite; t_end may be infinite if there are options.phase_length, or an event "
                     "or a hook that ends the phase"));
        return 2;
    }
    return 0;
}

/// The options that a study may have, by the table of options.
void show_options() {
    for (const host::option_row& r : host::option_rows()) {
        if (r.effect == host::option_effect::call) continue;
        std::string facts = r.type;
        if (r.type == "choice") {
            facts.clear();
            for (const std::string& c : r.choices) facts += (facts.empty() ? "" : " | ") + c;
        }
        if (!r.range.empty()) facts += " in " + r.range;
        if (!r.unit.empty()) facts += ", unit: " + r.unit;
        if (!r.initial.empty()) facts += ", default: " + r.initial;
        std::cout << r.name << " (" << facts << ")\n    " << r.meaning << '\n';
    }
}

int run(run_request asked) {
    asked.compiles = asked.compiles || !asked.only_check;
    const std::string text = read_file(asked.file);
    study_file file(asked.file, text);
    study_file::model_choice wanted = file.model();
    const auto choose = [](std::string& to, const std::string& given, const text_place& place, const char* what) {
        if (given.empty()) return;
        if (!to.empty() && to != given)
            throw wrong_at(place, message(what, " is ", to, ", and --", what, " is ", given, ": give one of them"));
        to = given;
    };
    choose(wanted.model, asked.model, wanted.model_place, "model");
    std::optional<model_source> header;
    if (!wanted.header.empty() && !asked.header.empty())
        throw wrong_at(wanted.header_place, "header is given here and as --header: give one of them");
    const std::string path = asked.header.empty() ? beside(asked.file, wanted.header) : asked.header;
    if (!wanted.header.empty() || !asked.header.empty()) {
        try {
            header = read_model_source(path);
        } catch (const error& e) {
            throw wrong_at(wanted.header_place, e.what());
        }
        if (wanted.model.empty())
            throw wrong_at(wanted.header_place, "no model of the header is named: write model = \"...\"");
    }
    std::string folder = asked.folder;
    if (folder.empty() && !file.folder().empty()) folder = beside(asked.file, file.folder());
    if (folder.empty()) folder = fs::path(asked.file).stem().string();
    return run_study(asked, file, text, folder, wanted, header);
}

int resume(const run_request& asked) {
    const store there = open_store(asked.folder);
    const std::string folder = there.folder();
    const std::string path = kept_study(folder);
    if (!fs::is_regular_file(path))
        throw input_error(message("the folder ", folder,
                                  " was not made by `myriad run`: start the program that made it "
                                  "again, which goes on"));
    const std::string text = read_file(path);
    study_file file(path, text);
    study_file::model_choice wanted = file.model();
    if (wanted.model.empty()) {
        for (const studies::attribute& a : studies::attributes_of(there.content().description))
            if (a.name == "model") wanted.model = std::get<std::string>(a.value);
    }
    std::optional<model_source> header;
    if (fs::is_regular_file(kept_model(folder))) header = kept_source(kept_model(folder));
    return run_study(asked, file, text, folder, wanted, header);
}

int list(const std::vector<std::string>& files, const run_request& asked) {
    for (const std::string& path : files) {
        study_file::model_choice wanted;
        std::string header = path;
        std::optional<study_file> file;
        if (fs::path(path).extension() == ".toml") {
            file.emplace(path, read_file(path));
            wanted = file->model();
            header = wanted.header.empty() ? "" : beside(path, wanted.header);
        }
        if (!asked.model.empty()) wanted.model = asked.model;
        if (!header.empty()) {
            const model_source source = as_input([&] { return read_model_source(header); });
            if (wanted.model.empty()) throw input_error(path + ": name the model in it, by --model");
            compile_model(wanted, source, asked.permission(), false);
        }
        show_model(find_model(wanted));
    }
    if (!files.empty()) return 0;
    for (const program_model& m : registered_models()) show_model(m);
    if (registered_models().empty())
        std::cout
            << "This program has no models of its own: `myriad list model.hpp --model NAME --compile` shows those of "
               "a header, and `header = \"model.hpp\"` in a study's file compiles them.\n";
    return 0;
}

int parse_and_run(int argc, const char* const* argv) {
    CLI::App app("Parameter studies of ordinary differential equations, as files describe them");
    app.set_version_flag("--version", MYRIAD_VERSION);
    app.require_subcommand(1);
    app.footer("Exit status: 0 done, 1 a failure, 2 bad input, 130 and 143 stopped by SIGINT and SIGTERM.");
    run_request asked;
    std::vector<std::string> files;
    std::string target, variable;
    bool verify = false, as_json = false, require_complete = false;
    int status = 0;

    CLI::App* const list_command = app.add_subcommand("list", "Show models and their components");
    list_command->add_option("FILE", files, "Studies or headers of models; none: the models of this program");
    list_command->add_option("--model", asked.model, "The model of a header");
    const auto add_compile_option = [&](CLI::App* command) {
        command->add_flag("--compile", asked.compiles,
                          "Compile the model's header and run its code though you never did before: you trust it");
    };
    add_compile_option(list_command);
    list_command->callback([&] { status = list(files, asked); });

    app.add_subcommand("options", "Show what [options] of a study may have")->callback([&] { show_options(); });

    const auto add_run_options = [&](CLI::App* command) {
        command
            ->add_option("--device", asked.devices, "Where to compute, instead of what the file says; may be repeated")
            ->type_name("NAME");
        command->add_option("--export", asked.exported, "When all is done, write a file: .nc or .csv")
            ->type_name("FILE");
        command->add_flag("--any-arithmetic", asked.any_arithmetic,
                          "Go on where another instruction set, compiler or library began");
        command->add_flag("--quiet", asked.quiet, "Show no progress");
    };
    CLI::App* const run_command = app.add_subcommand("run", "Run a study, or go on with it");
    run_command->add_option("STUDY", asked.file, "File that describes the study, in TOML")->required();
    run_command->add_option("--store", asked.folder, "Folder of the results, instead of what the file says")
        ->type_name("FOLDER");
    run_command->add_option("--model", asked.model, "Its model, if the file names none")->type_name("NAME");
    run_command->add_option("--header", asked.header, "The model's header, if the file names none")->type_name("FILE");
    run_command->add_flag("--check", asked.only_check, "Only say whether the file is right, and how many instances");
    add_compile_option(run_command);
    add_run_options(run_command);
    run_command->callback([&] { status = run(asked); });

    CLI::App* const resume_command = app.add_subcommand("resume", "Go on with the study in a folder");
    resume_command->add_option("FOLDER", asked.folder, "Folder of the results")->required();
    resume_command->add_flag("--checksums", asked.checksums, "Read all that is there, and do what is damaged again");
    add_compile_option(resume_command);
    add_run_options(resume_command);
    resume_command->callback([&] { status = resume(asked); });

    CLI::App* const info_command = app.add_subcommand("info", "Show what is in a folder of results");
    info_command->add_option("FOLDER", asked.folder, "Folder of the results")->required();
    auto* const verify_flag = info_command->add_flag("--verify", verify, "Compare all checksums too");
    info_command->add_flag("--json", as_json, "Show only the axes and arrays, for scripts")->excludes(verify_flag);
    info_command->callback([&] { status = info(asked.folder, verify, as_json); });

    CLI::App* const export_command = app.add_subcommand("export", "Write results as one file");
    export_command->add_option("FOLDER", asked.folder, "Folder of the results")->required();
    export_command->add_option("FILE", target, "File to write: .nc (netCDF-4), .csv or .npy")->required();
    export_command->add_option("--variable", variable, "The variable of an NPY file")->type_name("NAME");
    export_command->add_flag("--require-complete", require_complete, "Write nothing unless all is computed");
    export_command->callback([&] {
        const store there = open_store(asked.folder);
        tell_missing(there, require_complete);
        export_results(there, target, variable);
    });

    CLI::App* const plot_command = app.add_subcommand("plot", "Draw diagrams over one or two parameters");
    plot_command->prefix_command()->set_help_flag();  // of the script
    plot_command->callback([&] { status = plot(plot_command->remaining()); });

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    return status;
}

}  // namespace

int run_program(int argc, const char* const* argv) {
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is an error that writers report
    int status = 1;
    try {
        status = parse_and_run(argc, argv);
    } catch (const input_error& e) {
        tell(e.what());
        status = 2;
    } catch (const error& e) {
        tell(in_words_of_files(e.said()));
    } catch (const std::exception& e) {
        tell(e.what());
    }
    if (std::cout.flush() && std::fflush(stdout) == 0) return status;
    tell("standard output cannot be written");
    return status == 0 ? 1 : status;
}

}  // namespace myriad::programs
