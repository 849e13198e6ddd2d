// SPDX-License-Identifier: MIT
// Finds and reads the program's files.
#include "program/program_files.hpp"

#include <filesystem>
#include <iostream>
#include <optional>

namespace myriad::programs {

namespace fs = std::filesystem;

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

store open_store(const std::string& folder) {
    return as_input([&] { return store::open(folder); });
}

void tell(const std::string& text) { std::cerr << text << '\n'; }

}  // namespace myriad::programs
