// SPDX-License-Identifier: MIT
// Reads results for their users.
#include "program/result_commands.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <variant>

#include "compile/child_process.hpp"
#include "myriad/study/export/export.hpp"
#include "myriad/study/plan/component_names.hpp"
#include "myriad/study/store/metadata.hpp"
#include "program/program_files.hpp"

namespace myriad::programs {

namespace fs = std::filesystem;

namespace {

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

}  // namespace

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

}  // namespace myriad::programs
