// SPDX-License-Identifier: MIT
// Texts in files and in the environment, and their hashes. Host code only.
#pragma once

#include <filesystem>
#include <ios>
#include <string>
#include <string_view>

namespace myriad::compiling {

/// FNV-1a of a text, as 16 hexadecimal digits.
std::string text_hash(std::string_view text);

/// Writes a file, or with `std::ios::app` what is behind its text. Throws `error` if that fails.
void write_file(const std::filesystem::path& path, const std::string& text, std::ios::openmode mode = std::ios::trunc);
/// The text of a file; empty if it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// A variable of the environment; empty if it is not set.
std::string variable(const char* name);

}  // namespace myriad::compiling
