// SPDX-License-Identifier: MIT
// Models compiled at run time.
#include "program/model_compiler.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "compile/child_process.hpp"
#include "compile/compiled_cache.hpp"
#include "compile/compiler.hpp"
#include "compile/loaded_library.hpp"
#include "myriad/host/core/error.hpp"

namespace myriad::programs {

namespace {

namespace fs = std::filesystem;
using compiling::child_process;
using compiling::compiler;

/// Where the library's headers are.
struct header_flags {
    std::vector<std::string> words;
    std::string state;  ///< changes with the headers
};
header_flags read_flags(const std::string& path) {
    std::ifstream file(path);
    require(file.good(), "this program compiles no headers, as ", path,
            " is missing: `myriad` does, or link the model with the program");
    header_flags made;
    for (std::string line; std::getline(file, line);) {
        if (line.empty()) continue;
        if (line[0] == '-') {
            made.words.push_back(line);
            continue;
        }
        const fs::path folder = (fs::path(path).parent_path() / line).lexically_normal();
        // Compilers look there by themselves, in an order that C++'s own headers rely on.
        const std::string name = fs::weakly_canonical(folder).string();
        if (name != "/usr/include" && name != "/usr/local/include") {
            made.words.emplace_back("-isystem");
            made.words.push_back(folder.string());
        }
        std::error_code unknown;
        std::uintmax_t bytes = 0;
        std::int64_t newest = 0;
        for (fs::recursive_directory_iterator at(folder / "myriad", unknown), end; !unknown && at != end;
             at.increment(unknown)) {
            if (!at->is_regular_file(unknown)) continue;
            bytes += at->file_size(unknown);
            newest = std::max<std::int64_t>(newest, at->last_write_time(unknown).time_since_epoch().count());
        }
        made.state += message(folder.string(), ' ', bytes, ' ', newest, '\n');
    }
    return made;
}

/// The flags of the file with kernels; OpenMP has the threads.
std::vector<std::string> kernel_flags(const compiler& by, const header_flags& headers) {
    std::vector<std::string> flags = by.kernel_flags(compiling::wanted_instruction_set());
    flags.insert(flags.end(), {"-fopenmp", "-DNDEBUG", "-DMYRIAD_MODEL_FILE"});
    flags.insert(flags.end(), headers.words.begin(), headers.words.end());
    return flags;
}
std::vector<std::string> host_flags(const header_flags& headers) {
    std::vector<std::string> flags{"-std=c++20", "-fPIC", "-fopenmp", "-DNDEBUG", "-O1"};
    flags.insert(flags.end(), headers.words.begin(), headers.words.end());
    return flags;
}

// ---------------------------------------------------------------------------------------------------------------------
// The files that are compiled
// ---------------------------------------------------------------------------------------------------------------------

/// Types of the model's file or of the library.
void check_type(const std::string& name, const char* what) {
    const bool is_type = std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("_:<>, ", c) != nullptr;
    });
    require(is_type && !name.empty(), "the ", what, " \"", name, "\" is no name of a type in C++");
}
std::string types_of(const compile_request& wanted) {
    check_type(wanted.model, "model");
    check_type(wanted.method, "method");
    return message("namespace myriad_compiled {\nusing namespace myriad;\n#line 1 \"model\"\nusing model = ",
                   wanted.model, ";\n#line 1 \"method\"\nusing method = ", wanted.method, ";\n}\n");
}
const char* suffix_of(const compile_request& wanted) { return wanted.real == studies::element::f32 ? "_FLOAT" : ""; }

std::string kernel_file(const compile_request& wanted) {
    return message("#include <myriad/instantiate.hpp>\n", wanted.source.text, types_of(wanted), "MYRIAD_INSTANTIATE",
                   suffix_of(wanted), "(myriad_compiled::model, myriad_compiled::method)\n");
}
constexpr const char* register_symbol = "myriad_register_compiled_model";
std::string host_file(const compile_request& wanted) {
    const char* const real = wanted.real == studies::element::f32 ? "float" : "double";
    return message("#include <myriad/program.hpp>\n", wanted.source.text, types_of(wanted), "extern \"C\" void ",
                   register_symbol, "() { myriad::programs::register_model<myriad_compiled::model, ", real,
                   ", myriad_compiled::method>(); }\n");
}

void compile(const compile_request& wanted, const compiler& by, const header_flags& headers, std::string_view made_from,
             const fs::path& folder) {
    const auto start = [&](const std::string& name, const std::vector<std::string>& arguments) {
        std::vector<std::string> words = by.command;
        words.insert(words.end(), arguments.begin(), arguments.end());
        return child_process(words, folder / (name + ".txt"));
    };
    const auto start_file = [&](const std::string& name, std::vector<std::string> flags, const std::string& text) {
        const std::string file = folder / name;
        compiling::write_file(file + ".cpp", text);
        flags.insert(flags.end(), {"-c", file + ".cpp", "-o", file + ".o"});
        return start(name, flags);
    };
    const auto finish = [&](child_process& run, const char* name, const char* result) {
        const int status = run.wait();
        if (status == 0 || (status == child_process::unknown && fs::is_regular_file(folder / result))) return;
        std::string lines;
        for (const std::string& line : compiling::error_lines(compiling::read_file(folder / name), 5))
            lines += "\n  " + line;
        throw error(message(wanted.source.name, " does not compile (", by.name(), "):", lines));
    };
    child_process of_kernels = start_file("kernels", kernel_flags(by, headers), kernel_file(wanted));
    child_process of_host =
        start_file("host", host_flags(headers), host_file(wanted) + compiling::digest_line(made_from));
    finish(of_kernels, "kernels.txt", "kernels.o");
    finish(of_host, "host.txt", "host.o");
    // Its own functions come first, also where another model of the same name was loaded before.
    child_process linking = start("link", {"-shared", "-fopenmp", "-Wl,-Bsymbolic", folder / "host.o",
                                           folder / "kernels.o", "-o", folder / "model.so"});
    finish(linking, "link.txt", "model.so");
}

// ---------------------------------------------------------------------------------------------------------------------
// What was compiled
// ---------------------------------------------------------------------------------------------------------------------

void load(const std::string& path, std::string_view made_from) {
    compiling::loaded_library loaded(path, made_from);
    const auto add = reinterpret_cast<void (*)()>(loaded.find(register_symbol));
    require(add != nullptr, "what was compiled holds no model: remove the cache of compiled models");
    loaded.keep();
    add();
}

}  // namespace

void compile_and_load(const compile_request& wanted, const std::string& flags, compile_permission permission,
                      const std::function<void(const std::string&)>& tell,
                      const std::function<void(const std::string&)>& warn) {
    const std::optional<compiler> by = compiling::find_compiler();
    if (!by) throw compiling::no_compiler();
    const header_flags headers = read_flags(flags);
    const std::string made_from =
        compiling::made_from(*by, kernel_flags(*by, headers), headers.state, kernel_file(wanted) + host_file(wanted));
    compiling::compiled_cache cache;
    const auto make = [&](const fs::path& folder) {
        require(permission == compile_permission::given || cache.knows(wanted.source.text), wanted.source.name,
                " was never compiled by you, and what is compiled runs with all your rights: look at it, and give "
                "--compile if you trust it",
                cache.objection().empty() ? "" : message(" (", cache.objection(), ')'));
        if (!cache.objection().empty()) warn(cache.objection());
        tell(message("compiling ", wanted.source.name, " with ", wanted.method, ", by ", by->name()));
        compile(wanted, *by, headers, made_from, folder);
    };
    const auto load_it = [&](const std::string& path) { load(path, made_from); };
    if (!cache.obtain(made_from, make, load_it)) cache.remember(wanted.source.text);
}

}  // namespace myriad::programs
