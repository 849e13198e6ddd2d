// SPDX-License-Identifier: MIT
// Reads, writes and hashes texts.
#include "compile/text_files.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>

#include "myriad/host/core/error.hpp"

namespace myriad::compiling {

namespace fs = std::filesystem;

std::string text_hash(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    std::string digits(16, '0');
    for (std::size_t i = 16; i-- > 0; hash >>= 4) digits[i] = "0123456789abcdef"[hash & 15];
    return digits;
}

void write_file(const fs::path& path, const std::string& text, std::ios::openmode mode) {
    errno = 0;
    std::ofstream file(path, std::ios::binary | mode);
    file << text;
    file.close();
    require(file.good(), path.string(), " cannot be written (",
            errno != 0 ? std::generic_category().message(errno) : "the system does not say why", ")");
}
std::string read_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr ? value : "";
}

}  // namespace myriad::compiling
