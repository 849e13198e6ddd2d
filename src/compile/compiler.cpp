// SPDX-License-Identifier: MIT
// The choice of the compiler, its flags and messages. The build defines the flags, from cmake/MyriadKernelFlags.cmake.
#include "compile/compiler.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <utility>

#include "myriad/version.hpp"

namespace myriad::compiling {

namespace {

namespace fs = std::filesystem;

std::string file_name(const std::string& path) { return fs::path(path).filename().string(); }

/// What tells a file from its next version.
std::string identity_of(const std::string& program) {
    std::error_code unknown;
    const fs::path place = fs::canonical(program, unknown);
    return message(place.string(), ' ', fs::file_size(place, unknown), ' ',
                   fs::last_write_time(place, unknown).time_since_epoch().count());
}

/// Whether a word is the name of a C++ compiler: g++, clang++-14, /usr/bin/c++.
bool is_compiler(const std::string& word) {
    const std::size_t end = word.rfind("++");
    if (end == std::string::npos || end == 0 || std::strchr("gc", word[end - 1]) == nullptr) {
        return false;
    }
    const std::string version = word.substr(end + 2);
    return version.empty() ||
           (version.size() > 1 && version[0] == '-' && version.find_first_not_of("0123456789.", 1) == version.npos);
}
std::string kind_of(const std::string& program) {
    return file_name(program).find("clang") != std::string::npos ? "clang++" : "g++";
}
bool is_new_enough(std::vector<std::string> command, const std::string& kind) {
    command.emplace_back("-dumpversion");
    const std::string told = output_of(command);
    int major = 0;
    std::from_chars(told.data(), told.data() + told.size(), major);
    return major >= (kind == "g++" ? MYRIAD_OLDEST_GNU : MYRIAD_OLDEST_CLANG);
}

/// The compiler that a variable of the environment names: a program, maybe with arguments, and maybe behind one that
/// calls it, as in "ccache g++ -fno-plt".
compiler named_compiler(const std::string& chosen, const char* name) {
    std::vector<std::string> words{chosen};
    if (find_program(chosen).empty()) {  // a path may have blanks
        try {
            words = words_of(chosen);
        } catch (const error& why) {
            throw error(message(name, " is '", chosen, "', which is no command: ", why.what()));
        }
    }
    const std::string program = words.empty() ? "" : find_program(words[0]);
    require(!program.empty(), name, " is '", chosen, "', and there is no such program", host::cure,
            "give a C++ compiler (g++ ", MYRIAD_OLDEST_GNU, ", clang++ ", MYRIAD_OLDEST_CLANG,
            " or newer) by its path, maybe with arguments, or unset the variable");
    std::string called = program, arguments;
    for (std::size_t i = words.size(); i-- > 1;) {
        if (words[i][0] != '-' && is_compiler(words[i]) && !find_program(words[i]).empty())
            called = find_program(words[i]);
        arguments.insert(0, ' ' + words[i]);
    }
    words[0] = program;
    return {words, kind_of(called), identity_of(called) + arguments};
}

}  // namespace

error no_compiler(std::string_view also) {
    return error(statement_of("there is no C++ compiler to compile the model with", host::cure, "install g++ ",
                              MYRIAD_OLDEST_GNU, " or clang++ ", MYRIAD_OLDEST_CLANG, " or newer, ", also,
                              "or name a compiler in the environment variable MYRIAD_CXX"));
}

std::optional<compiler> find_compiler(const std::string& zig) {
    if (const std::string chosen = variable("MYRIAD_CXX"); !chosen.empty()) return named_compiler(chosen, "MYRIAD_CXX");
    if (const std::string chosen = variable("CXX"); !chosen.empty()) {
        // Meant for all programs: one that cannot compile models is passed over.
        compiler named = named_compiler(chosen, "CXX");
        if (std::any_of(named.command.begin(), named.command.end(), is_compiler) &&
            is_new_enough(named.command, named.kind))
            return named;
    }
    for (const char* const name : {"g++", "clang++"}) {
        const std::string program = find_program(name);
        if (!program.empty() && is_new_enough({program}, name)) return compiler{{program}, name, identity_of(program)};
    }
    if (!find_program(zig).empty()) return compiler{{zig, "c++"}, "zig", identity_of(zig)};
    return {};
}

std::string compiler::name() const { return file_name(command.front()); }

std::vector<std::string> compiler::kernel_flags(openmp::instruction_set set) const {
    std::vector<std::string> flags = words_of("-std=c++20 -fPIC -DNDEBUG " MYRIAD_KERNEL_FLAGS);
    for (const std::string& flag : words_of(kind == "g++" ? MYRIAD_KERNEL_FLAGS_GNU : MYRIAD_KERNEL_FLAGS_CLANG))
        flags.push_back(flag);
    // Spelt out, so that machines that share a cache agree on its meaning.
    constexpr std::pair<openmp::instruction_set, const char*> architectures[] = {
        {openmp::instruction_set::avx512, MYRIAD_ARCHITECTURE_AVX512},
        {openmp::instruction_set::avx2, MYRIAD_ARCHITECTURE_AVX2},
        {openmp::instruction_set::sse2, MYRIAD_ARCHITECTURE_SSE2}};
    for (const auto& [known, name] : architectures) {
        std::string architecture = name;
        if (kind == "zig") std::replace(architecture.begin(), architecture.end(), '-', '_');
        if (known == set) flags.push_back("-march=" + architecture);
    }
    return flags;
}

openmp::instruction_set wanted_instruction_set() {
    const std::string asked = variable("MYRIAD_INSTRUCTION_SET");
    std::string names;
    for (const openmp::instruction_set set : host::all_instruction_sets) {
        const bool has = host::cpu_has(set);
        if (has && (asked.empty() || asked == host::name_of(set))) return set;
        if (has) names += message(names.empty() ? "" : ", ", host::name_of(set));
    }
    throw error(statement_of("MYRIAD_INSTRUCTION_SET is '", asked, "': this CPU has ", names, host::cure,
                             "name one of them, or unset the variable"));
}

std::string made_from(const compiler& by, const std::vector<std::string>& flags, std::string_view headers,
                      std::string_view sources) {
    std::string text = message(MYRIAD_VERSION, '\n', by.identity, '\n', headers, '\n');
    for (const std::string& flag : flags) text += flag + '\n';
    text += sources;
    return text;
}

namespace {

/// The length of the character of UTF-8 that begins there; 0 if none does.
std::size_t character_at(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
    const unsigned first = byte(at), second = byte(at + 1);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xc2 && first < 0xe0   ? 2
                               : first >= 0xe0 && first < 0xf0 ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(at + i) & 0xc0) != 0x80) return 0;
    // What has a shorter form, surrogates, and what is beyond the last character.
    const bool is_wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                          (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
    return is_wrong ? 0 : length;
}

}  // namespace

std::string in_utf8(std::string_view text) {
    std::string made;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t length = character_at(text, at);
        made += length > 0 ? text.substr(at, length) : std::string_view("\xef\xbf\xbd");
        at += std::max<std::size_t>(length, 1);
    }
    return made;
}

std::vector<std::string> error_lines(const std::string& output, std::size_t most) {
    std::vector<std::string> found;
    std::string last;
    std::istringstream lines(in_utf8(output));
    for (std::string line; std::getline(lines, line);) {
        if (!line.empty()) last = line;
        if (line.find("error:") != std::string::npos && found.size() < most) found.push_back(line);
    }
    if (found.empty()) found.push_back(last.empty() ? "it failed without a message" : last);
    return found;
}
std::string first_error(const std::string& output) {
    std::string line = error_lines(output, 1).front();
    if (const std::size_t at = line.find("error:"); at != std::string::npos)
        line.erase(0, at + std::string_view("error:").size());
    line.erase(0, line.find_first_not_of(" \t"));
    line.erase(line.find_last_not_of(" \t\r") + 1);
    return line;
}

// ---------------------------------------------------------------------------------------------------------------------
// Prepared headers
// ---------------------------------------------------------------------------------------------------------------------

prepared_header::prepared_header(const compiler& by, std::vector<std::string> flags, std::string header,
                                 std::string_view state)
    : by_(by), flags_(std::move(flags)), header_(std::move(header)) {
    const char* const suffix = by.kind == "g++" ? ".hpp.gch" : by.kind == "clang++" ? ".pch" : nullptr;
    if (suffix != nullptr) name_ = text_hash(made_from(by, flags_, state, header_)) + suffix;
}

std::vector<std::string> prepared_header::arguments(const compiled_cache& cache) const {
    const std::string path = name_.empty() ? "" : cache.find_file(name_);
    if (path.empty()) return {};
    if (by_.kind == "clang++") return {"-include-pch", path};
    return {"-include", path.substr(0, path.size() - std::strlen(".gch"))};
}

bool prepared_header::make(compiled_cache& cache, const signal_check& check) const {
    if (name_.empty()) return false;
    if (!cache.find_file(name_).empty()) return true;
    return !cache
                .make_file(name_,
                           [&](const fs::path& folder) {
                               std::vector<std::string> words = by_.command;
                               words.insert(words.end(), flags_.begin(), flags_.end());
                               for (const std::string& word : {std::string("-x"), std::string("c++-header"), header_,
                                                               std::string("-o"), (folder / "model.so").string()})
                                   words.push_back(word);
                               child_process(words, folder / "said.txt").wait(check);
                           })
                .empty();
}

}  // namespace myriad::compiling
