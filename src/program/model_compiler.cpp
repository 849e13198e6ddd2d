// SPDX-License-Identifier: MIT
// Models compiled at run time.
#include "program/model_compiler.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include <dlfcn.h>

#include "myriad/host/core/error.hpp"
#include "myriad/host/core/instruction_set.hpp"
#include "myriad/version.hpp"
#include "program/child_process.hpp"
#include "program/model_cache.hpp"

namespace myriad::programs {

namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr ? value : "";
}

void write_file(const fs::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    require(file.good(), path.string(), " cannot be written: is the disk full?");
}

// ---------------------------------------------------------------------------------------------------------------------
// The compiler
// ---------------------------------------------------------------------------------------------------------------------

std::string find_compiler() {
    if (const std::string chosen = variable("MYRIAD_CXX"); !chosen.empty()) {
        const std::string found = find_program(chosen);
        require(!found.empty(), "MYRIAD_CXX is ", chosen,
                ", and there is no such program: give the path of a C++ compiler, or unset the variable");
        return found;
    }
    for (const char* name : {"g++", "clang++"})
        if (const std::string found = find_program(name); !found.empty()) return found;
    throw error(
        "there is no C++ compiler to compile the model with: install g++ 12 or clang++ 14 or newer, or name "
        "one in the environment variable MYRIAD_CXX");
}
bool is_clang(const std::string& compiler) { return fs::path(compiler).filename().string().find("clang") == 0; }

/// What tells a file from its next version.
std::string identity(const fs::path& path) {
    std::error_code unknown;
    const fs::path place = fs::canonical(path, unknown);
    return message(place.string(), ' ', fs::file_size(place, unknown), ' ',
                   fs::last_write_time(place, unknown).time_since_epoch().count());
}

openmp::instruction_set wanted_set() {
    const std::string asked = variable("MYRIAD_INSTRUCTION_SET");
    for (const openmp::instruction_set set : host::all_instruction_sets)
        if (host::cpu_has(set) && (asked.empty() || asked == host::name_of(set))) return set;
    throw error(message("MYRIAD_INSTRUCTION_SET is ", asked, ", which this CPU lacks: unset the variable"));
}
/// Spelt out, so that machines that share a cache agree on its meaning.
const char* architecture_of(openmp::instruction_set set) {
    switch (set) {
        case openmp::instruction_set::avx512:
            return "-march=x86-64-v4";
        case openmp::instruction_set::avx2:
            return "-march=x86-64-v3";
        case openmp::instruction_set::sse2:
            return "-march=x86-64-v2";
        default:
            return "";
    }
}

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

std::vector<std::string> common_flags(const header_flags& headers) {
    std::vector<std::string> flags{"-std=c++20", "-fPIC", "-fopenmp", "-DNDEBUG"};
    flags.insert(flags.end(), headers.words.begin(), headers.words.end());
    return flags;
}
/// As those of MyriadModels.cmake.
std::vector<std::string> kernel_flags(const header_flags& headers, const std::string& compiler) {
    std::vector<std::string> flags = common_flags(headers);
    for (const char* flag : {"-O3", "-ffp-contract=off", "-fno-math-errno", "-DMYRIAD_MODEL_FILE"})
        flags.emplace_back(flag);
    const std::string architecture = architecture_of(wanted_set());
    if (!architecture.empty()) flags.push_back(architecture);
    flags.emplace_back(is_clang(compiler) ? "-Wno-pass-failed" : "--param=sra-max-scalarization-size-Ospeed=2048");
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

/// The errors in a compiler's output, the first of them.
std::string first_errors(const fs::path& output) {
    std::ifstream file(output);
    std::string found, last;
    int count = 0;
    for (std::string line; std::getline(file, line);) {
        if (!line.empty()) last = line;
        if (line.find("error: ") == std::string::npos || ++count > 5) continue;
        found += "\n  " + line;
    }
    if (found.empty() && last.empty()) return " it failed without a message";
    return found.empty() ? "\n  " + last : found;
}

void compile(const compile_request& wanted, const std::string& compiler, const header_flags& headers,
             const fs::path& folder) {
    const auto start = [&](const std::string& name, std::vector<std::string> flags, const std::string& text) {
        write_file(folder / (name + ".cpp"), text);
        flags.insert(flags.begin(), compiler);
        for (const std::string& word : {std::string("-c"), (folder / (name + ".cpp")).string(), std::string("-o"),
                                        (folder / (name + ".o")).string()})
            flags.push_back(word);
        return child_process(flags, folder / (name + ".txt"));
    };
    std::vector<std::string> host = common_flags(headers);
    host.emplace_back("-O1");
    child_process of_kernels = start("kernels", kernel_flags(headers, compiler), kernel_file(wanted));
    child_process of_host = start("host", host, host_file(wanted));
    const int kernels_failed = of_kernels.wait(), host_failed = of_host.wait();
    const auto refuse = [&](const char* output) {
        throw error(message(wanted.source.name, " does not compile (", fs::path(compiler).filename().string(),
                            "):", first_errors(folder / output)));
    };
    if (kernels_failed != 0) refuse("kernels.txt");
    if (host_failed != 0) refuse("host.txt");
    // Its own functions come first, also where another model of the same name was loaded before.
    child_process linking({compiler, "-shared", "-fopenmp", "-Wl,-Bsymbolic", folder / "host.o", folder / "kernels.o",
                           "-o", folder / "model.so"},
                          folder / "link.txt");
    if (linking.wait() != 0) refuse("link.txt");
}

// ---------------------------------------------------------------------------------------------------------------------
// What was compiled
// ---------------------------------------------------------------------------------------------------------------------

/// Loads it for the life of the process: its code may be running.
void load(const compiled_file& file) {
    void* const handle = ::dlopen(file.path().c_str(), RTLD_NOW | RTLD_LOCAL);
    require(handle != nullptr, "the compiled model cannot be loaded: ", handle != nullptr ? "" : ::dlerror());
    const auto add = reinterpret_cast<void (*)()>(::dlsym(handle, register_symbol));
    require(add != nullptr, "what was compiled holds no model: remove the cache of compiled models");
    add();
}

}  // namespace

void compile_and_load(const compile_request& wanted, const std::string& flags, compile_permission permission,
                      const std::function<void(const std::string&)>& tell,
                      const std::function<void(const std::string&)>& warn) {
    const std::string compiler = find_compiler();
    const header_flags headers = read_flags(flags);
    std::string made_from = message(MYRIAD_VERSION, '\n', identity(compiler), '\n', headers.state);
    for (const std::string& flag : kernel_flags(headers, compiler)) made_from += flag + '\n';
    made_from += kernel_file(wanted) + host_file(wanted);

    const model_cache cache;
    const std::string key = text_hash(made_from);
    if (const auto file = cache.find(key, made_from)) return load(*file);
    require(
        permission == compile_permission::given || cache.knows(wanted.source.text), wanted.source.name,
        " was never compiled by you, and what is compiled runs with all your rights: look at it, and give --compile if "
        "you trust it",
        cache.objection().empty() ? "" : message(" (", cache.objection(), ')'));
    if (!cache.objection().empty()) warn(cache.objection());
    const model_cache::workplace work(cache, key);
    if (const auto file = cache.find(key, made_from)) return load(*file);  // made by the process that held the lock
    tell(message("compiling ", wanted.source.name, " with ", wanted.method, ", by ",
                 fs::path(compiler).filename().string()));
    compile(wanted, compiler, headers, work.folder());
    load(work.seal(made_from));
    work.keep();
    cache.remember(wanted.source.text);
}

}  // namespace myriad::programs
