// SPDX-License-Identifier: MIT
// The options of every sweep, and the exit statuses of every example: 0 success, 1 some instances failed, 2 an error,
// with its reason on stderr, and no file was written, 3 an error after a file was written: its picture, another file or
// standard output failed.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "exit_status.hpp"
#include "myriad/device.hpp"

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

/// A further option of one program. Its default is what the variable holds; elements of a list are separated by commas.
struct own_option {
    using range = std::array<double, 2>;  // least and most
    using names = std::vector<std::string>;

    std::string name;  // as in "--points"
    std::variant<bool*, int*, std::int64_t*, double*, std::string*, std::vector<double>*,
                 std::vector<std::string>*>
        variable;  // a flag if it is a bool
    std::string meaning;
    std::string type_name = "";  // what the help calls a value; empty: the name of its type
    std::variant<std::monostate, range, names> allowed = {};
};

/// The names that a table gives a meaning.
template <class Meaning>
own_option::names names_of(const std::map<std::string, Meaning>& table) {
    own_option::names names;
    for (const auto& [name, meaning] : table) names.push_back(name);
    return names;
}

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
    std::vector<own_option> options = {};
};

/// Parses the command line and calls `sweep(options, device)`, which returns the exit status; then draws the picture.
int run_sweep(int argc, const char* const* argv, const study& offered,
              const std::function<int(const sweep_options&, const myriad::device&)>& sweep);

/// The script that draws the results of this program.
extern const char* const plot_script;

}  // namespace examples
