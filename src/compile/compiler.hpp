// SPDX-License-Identifier: MIT
// The C++ compiler that compiles models at run time, for the program `myriad` and for the Python package: which one,
// its flags, its prepared headers and its messages. Host code only.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compile/child_process.hpp"
#include "compile/compiled_cache.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/core/instruction_set.hpp"

namespace myriad::compiling {

/// A C++ compiler: the command, what it is, and what tells it from others and from its own updates.
struct compiler {
    std::vector<std::string> command;  ///< a program, maybe with arguments
    std::string kind;                  ///< "g++", "clang++" or "zig"
    std::string identity;

    /// Of its program, without folders.
    std::string name() const;
    /// The flags for kernels, for an instruction set.
    std::vector<std::string> kernel_flags(openmp::instruction_set set) const;
};

/// The compiler to use: what $MYRIAD_CXX or $CXX names, g++ or clang++ on the PATH, or the compiler of the package
/// ziglang, whose program is `zig`, if that is not empty.
std::optional<compiler> find_compiler(const std::string& zig = "");
/// What is thrown where there is none; `also` is what else may be done, with a comma behind it.
error no_compiler(std::string_view also = "");

/// The instruction set of $MYRIAD_INSTRUCTION_SET, or the best of this CPU.
openmp::instruction_set wanted_instruction_set();

/// The text that stands for all that a result depends on, of these parts.
std::string made_from(const compiler& by, const std::vector<std::string>& flags, std::string_view headers,
                      std::string_view sources);

/// A text in which whatever is not UTF-8, as of a source in another encoding, is replaced by U+FFFD.
std::string in_utf8(std::string_view text);

/// The lines of a compiler's output that name errors, at most so many; the last line if none does.
std::vector<std::string> error_lines(const std::string& output, std::size_t most);
/// The first of them without the place.
std::string first_error(const std::string& output);

/// A header in the compiler's own form, which halves the time that a model takes to compile. It is made once for a
/// compiler, its flags, and the state of the headers, and kept in the user's folder of compiled models.
class prepared_header {
public:
    prepared_header(const compiler& by, std::vector<std::string> flags, std::string header, std::string_view state);
    /// What the compiler is called with to use it; nothing where it is not made yet, or not trusted.
    std::vector<std::string> arguments(const compiled_cache& cache) const;
    /// Makes it, unless it is there; returns whether it is.
    bool make(compiled_cache& cache, const signal_check& check) const;

private:
    compiler by_;
    std::vector<std::string> flags_;
    std::string header_, name_;
};

}  // namespace myriad::compiling
