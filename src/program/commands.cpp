// SPDX-License-Identifier: MIT
// The commands of the program.
#include "program/commands.hpp"

#include <algorithm>
#include <cctype>
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

#include "compile/child_process.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/options/option_table.hpp"
#include "myriad/host/report/progress.hpp"
#include "myriad/kernel/methods/method_list.hpp"
#include "myriad/program.hpp"
#include "myriad/study/export.hpp"
#include "myriad/study/file_system.hpp"
#include "myriad/study/metadata.hpp"
#include "myriad/study/stop_signals.hpp"
#include "myriad/study/store.hpp"
#include "myriad/study/study.hpp"
#include "myriad/version.hpp"
#include "program/model_compiler.hpp"
#include "program/model_source.hpp"
#include "program/study_file.hpp"

namespace myriad::programs {

namespace {

namespace fs = std::filesystem;

/// Files that belong to the program: the flags for models, and the script that draws.
std::string data_file(const char* name) {
    std::error_code unknown;
    const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
    return (program.parent_path() / MYRIAD_PROGRAM_DATA / name).lexically_normal().string();
}

std::string read_file(const std::string& path) {
    std::error_code unknown;
    const fs::file_status status = fs::status(path, unknown);
    if (fs::is_directory(status)) throw input_error(path + ": is a folder: give a file");
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw input_error(path + ": is a device or a pipe, which cannot be read again: give a file");
    const std::optional<std::string> text =
        fs::exists(status) ? studies::read_text(studies::file_system::real(), path) : std::nullopt;
    if (!text) throw input_error(path + ": there is no such file");
    return *text;
}

/// For errors that are the input's, with exit status 2.
template <class Function>
auto as_input(Function&& function) {
    try {
        return function();
    } catch (const studies::file_error&) {
        throw;
    } catch (const input_error&) {
        throw;
    } catch (const error& e) {
        throw input_error(e.what());
    }
}

store open_store(const std::string& folder) {
    return as_input([&] { return store::open(folder); });
}

std::vector<device> devices_of(const std::vector<std::string>& names) {
    return as_input([&] {
        std::vector<device> all;
        for (const std::string& name : names) all.push_back(device::parse(name));
        return all;
    });
}

void tell(const std::string& text) { std::cerr << text << '\n'; }

// ---------------------------------------------------------------------------------------------------------------------
// Models
// ---------------------------------------------------------------------------------------------------------------------

const program_model* registered_model(std::string_view name) {
    for (const program_model& m : registered_models())
        if (plain_name(m.names.model()) == plain_name(name)) return &m;
    return nullptr;
}
const program_method* method_of(const program_model& model, std::string_view name, studies::element real) {
    // The last one: what was compiled now, if a program has the same.
    for (auto m = model.methods.rbegin(); m != model.methods.rend(); ++m)
        if (m->real == real && m->name == plain_name(name)) return &*m;
    return nullptr;
}

/// The text that follows a key's place.
input_error wrong_at(const text_place& place, const std::string& text) { return input_error(position(place) + text); }

/// The name of the method, dense where samples are wanted.
std::string method_wanted(const study_file::model_choice& wanted) {
    const bool is_dense = plain_name(wanted.method).starts_with("dense<");
    return wanted.samples && !is_dense ? "dense<" + wanted.method + '>' : wanted.method;
}

const program_model& find_model(const study_file::model_choice& wanted) {
    if (wanted.model.empty())
        throw wrong_at(wanted.model_place, "no model is named: write model = \"...\", or give --model");
    const program_model* const model = registered_model(wanted.model);
    if (model == nullptr) {
        std::vector<std::string> names;
        for (const program_model& m : registered_models()) names.push_back(plain_name(m.names.model()));
        throw wrong_at(wanted.model_place, message("model: this program has no model \"", wanted.model, '"',
                                                   names.empty() ? ": name its header, header = \"model.hpp\""
                                                                 : suggestion(wanted.model, names)));
    }
    return *model;
}
const program_method& find_method(const program_model& model, const study_file::model_choice& wanted) {
    const std::string name = method_wanted(wanted);
    const program_method* const method = method_of(model, name, wanted.real);
    if (method != nullptr) return *method;
    // A study that names none takes the only one that the program has.
    if (wanted.method_place.line == 0 && !wanted.samples && model.methods.size() == 1 &&
        model.methods.front().real == wanted.real)
        return model.methods.front();
    std::vector<std::string> names;
    for (const program_method& m : model.methods)
        names.push_back(m.name + (m.real == studies::element::f32 ? " (float)" : ""));
    throw wrong_at(wanted.method_place,
                   message("method: ", plain_name(model.names.model()), " was not compiled for ", name,
                           wanted.real == studies::element::f32 ? " (float)" : "", suggestion(name, names)));
}

/// The names of the structs that a header defines, also by another name for one.
std::vector<std::string> structs_of(const std::string& text) {
    std::vector<std::string> names;
    const auto is_of_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    const std::string_view all = text;
    for (const std::string_view word : {"struct", "class", "using"}) {
        for (std::size_t at = 0; (at = all.find(word, at)) != all.npos;) {
            const bool begins = at == 0 || !is_of_name(all[at - 1]);
            at += word.size();
            const std::size_t begin = std::min(all.find_first_not_of(" \t\r\n", at), all.size());
            std::size_t end = begin;
            while (end < all.size() && is_of_name(all[end])) ++end;
            std::string_view rest = all.substr(end);
            rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
            // What follows tells a definition from a template's parameter, a declaration, and a word in a comment.
            const bool defines = word == "using" ? rest.starts_with('=')
                                                 : rest.starts_with('{') || rest.starts_with("final") ||
                                                       (rest.starts_with(':') && !rest.starts_with("::"));
            if (begins && begin > at && end > begin && defines) names.emplace_back(all.substr(begin, end - begin));
        }
    }
    return names;
}

/// Compiles a model's header and registers it.
void compile_model(const study_file::model_choice& wanted, const model_source& source, compile_permission permission,
                   bool quiet) {
    const std::string name = wanted.model.substr(0, wanted.model.find('<'));
    const std::vector<std::string> structs = structs_of(source.text);
    const std::string last = name.substr(name.rfind(':') == std::string::npos ? 0 : name.rfind(':') + 1);
    if (wanted.model == name && std::find(structs.begin(), structs.end(), last) == structs.end())
        throw wrong_at(wanted.model_place,
                       message("model: ", source.name, " defines no \"", wanted.model, '"', suggestion(last, structs)));
#define METHOD_NAME(method) #method,
    constexpr const char* methods[] = {MYRIAD_METHODS(METHOD_NAME)};
#undef METHOD_NAME
    const std::string method = plain_name(wanted.method);
    const bool is_plain = method.find_first_of("<:") == std::string::npos;
    if (is_plain && std::find(std::begin(methods), std::end(methods), method) == std::end(methods) &&
        source.text.find(method) == std::string::npos)
        throw wrong_at(wanted.method_place,
                       message("method: there is no method \"", wanted.method, '"',
                               suggestion(method, std::vector<std::string>(std::begin(methods), std::end(methods)))));
    try {
        compile_and_load(
            {source, wanted.model, method_wanted(wanted), wanted.real}, data_file("model_flags.txt"), permission,
            [&](const std::string& text) {
                if (!quiet) tell(text);
            },
            &tell);
    } catch (const error& e) {
        throw wrong_at(wanted.header_place, e.what());
    }
}

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

/// Says how much of the results is not there yet. Throws `error` if all of it is asked for.
void tell_missing(const studies::results& from, bool require_complete) {
    const std::string missing = studies::missing_text(from);
    if (missing.empty()) return;
    if (require_complete) throw error(missing + ": nothing is written; `myriad resume` goes on with the study");
    tell("incomplete: " + missing);
}

void export_results(const studies::results& from, const std::string& path, const std::string& variable) {
    const std::string kind = fs::path(path).extension().string();
    if (kind != ".npy" && !variable.empty())
        throw input_error("--variable is for NPY files, which hold one variable: others hold all");
    if (kind == ".nc") return export_netcdf(from, path);
    if (kind == ".csv") return export_csv(from, path);
    if (kind != ".npy") throw input_error(path + ": the name must end in .nc (netCDF), .csv or .npy");
    if (variable.empty()) throw input_error("an NPY file holds one variable: name it by --variable");
    as_input([&] {
        for (const studies::coordinate& c : from.content().coordinates)
            if (c.name == variable) return;
        from.content().find(variable);
    });
    export_npy(from, variable, path);
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

// ---------------------------------------------------------------------------------------------------------------------
// Results
// ---------------------------------------------------------------------------------------------------------------------

std::string text_of(const studies::attribute& a) {
    const auto joined = [](const auto& list) {
        std::string all;
        for (const auto value : list) all += message(all.empty() ? "" : ", ", value);
        return message('[', all, ']');
    };
    if (const auto* const text = std::get_if<std::string>(&a.value)) return *text;
    if (const auto* const number = std::get_if<double>(&a.value)) return studies::exact_text(*number);
    if (const auto* const number = std::get_if<std::int64_t>(&a.value)) return std::to_string(*number);
    if (const auto* const list = std::get_if<std::vector<double>>(&a.value)) return joined(*list);
    return joined(std::get<std::vector<std::int64_t>>(a.value));
}

std::string shape_text(const studies::layout& content, const studies::variable& v) {
    std::string text;
    const auto add = [&](const std::string& name, std::int64_t length) {
        text += message(text.empty() ? "" : ", ", name, " = ", length);
    };
    if (v.extent == studies::along::instances)
        for (const studies::dimension& d : content.axes) add(d.name, d.length);
    for (const studies::dimension& d : v.inner) add(d.name, d.length);
    return text.empty() ? "one value" : text;
}

int info(const std::string& folder, bool verify, bool as_json) {
    store there = open_store(folder);
    const studies::layout& content = there.content();
    if (as_json) {
        std::cout << studies::contents_json(content);
        return 0;
    }
    const studies::store_progress now = there.progress();
    std::cout << there.folder() << '\n'
              << message("done: ", now.chunks, " of ", now.all_chunks, " chunks, ", now.instances, " of ",
                         now.all_instances, " instances; ", now.seconds, " s of computing\n");
    for (const auto& [name, count] : now.statuses) std::cout << message("  ", name, ": ", count, '\n');
    if (now.damaged > 0)
        tell(message("damaged: the records of ", now.damaged, " chunks, which are not counted: --verify says which"));
    for (const std::string& device : there.devices()) std::cout << "device: " << device << '\n';
    for (const studies::arithmetic& a : there.arithmetics())
        std::cout << message("computed by: ", a.text(), ", on ", a.host, '\n');
    std::cout << "variables:\n";
    for (const studies::variable& v : content.variables)
        if (v.extent != studies::along::chunks)
            std::cout << message("  ", v.name, ": ", studies::name_of(v.type), ", ", shape_text(content, v), '\n');
    std::cout << "study:\n";
    for (const studies::attribute& a : studies::attributes_of(content.description)) {
        std::string text = text_of(a);
        if (text.size() > 200) text = text.substr(0, 200) + " ...";
        std::cout << message("  ", a.name, ": ", text, '\n');
    }
    if (!verify) return now.damaged > 0 ? 1 : 0;
    const std::vector<studies::damage> damaged = there.verify();
    for (const studies::damage& d : damaged)
        tell(message("damaged: ", d.chunk >= 0 ? message("chunk ", d.chunk, ", ") : "", d.variable, ": ", d.reason));
    if (damaged.empty()) std::cout << "all checksums are right\n";
    return damaged.empty() ? 0 : 1;
}

/// A Python that can draw: the first on the PATH may not be the one that the system's packages are for.
std::string find_python(bool reads_files) {
    // As plot.py does: no modules from the folder it is run in or from PYTHONPATH, but those that the user installed.
    const std::string imports = message("import site; site.addsitedir(site.getusersitepackages()); import matplotlib",
                                        reads_files ? ", netCDF4" : "");
    for (const char* python : {"python3", "/usr/bin/python3"})
        if (compiling::child_process({python, "-I", "-c", imports}, "/dev/null").wait() == 0) return python;
    throw error(message("pictures need a Python 3 with matplotlib", reads_files ? " and netCDF4" : "",
                        ": install it (Debian, Ubuntu: apt-get install python3-matplotlib",
                        reads_files ? " python3-netcdf4), or draw the folder of the results" : ")"));
}

/// Runs the script that draws, with all arguments of the command, which it knows.
int plot(const std::vector<std::string>& arguments) {
    const std::string script = data_file("plot.py");
    if (!fs::is_regular_file(script)) throw error("this program draws nothing, as " + script + " is missing");
    const bool reads_files = std::any_of(arguments.begin(), arguments.end(),
                                         [](const std::string& word) { return fs::is_regular_file(word); });
    std::vector<std::string> words{find_python(reads_files), "-I", "-B", script,
                                   "--reader=" + fs::read_symlink("/proc/self/exe").string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const int status = compiling::child_process(words).wait();
    return status == 0 || status == 2 ? status : 1;
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
