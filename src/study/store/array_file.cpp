// SPDX-License-Identifier: MIT
// Reads and writes the files of arrays, in pieces.
#include "myriad/study/store/array_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include <fcntl.h>

#include "myriad/study/plan/layout.hpp"
#include "myriad/study/store/crc32c.hpp"
#include "myriad/study/store/sealed_text.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

constexpr std::int64_t piece = std::int64_t{1} << 20;  // stays in a core's cache between its checksum and its copy

std::size_t length_of(std::int64_t count) { return static_cast<std::size_t>(count); }

}  // namespace

file_check& file_check::compare(std::uint32_t recorded) {
    if (damage.empty() && checksum != recorded)
        damage = "its checksum is " + hexadecimal(checksum) + ", and " + hexadecimal(recorded) + " in the record";
    return *this;
}

file_check read_array_file(file_system& files, const std::string& path, const array_shape& shape, std::int64_t begin,
                           std::int64_t end, std::byte* to) {
    const std::int64_t size = shape.file_bytes() - 4;
    file_check check;
    std::vector<std::byte> scratch(length_of(std::min(size, piece)));
    try {
        open_file file(files, path, O_RDONLY);
        for (std::int64_t at = 0; at < size;) {
            const bool wanted = begin <= at && at < end;
            const std::int64_t until = at < begin ? begin : at < end ? end : size;
            const std::int64_t part = std::min(until - at, piece);
            const std::span<std::byte> into(wanted ? to + (at - begin) : scratch.data(), length_of(part));
            if (file.read(into) != into.size()) {
                check.damage = "it is too short";
                return check;
            }
            check.checksum = crc32c(into, check.checksum);
            at += part;
        }
        std::uint32_t stored = 0;
        std::byte last[5];
        if (file.read(last) != 4) {
            check.damage = "it has not the length it should have";
            return check;
        }
        std::memcpy(&stored, last, 4);
        if (stored != check.checksum)
            check.damage = "its checksum is " + hexadecimal(check.checksum) + " and should be " + hexadecimal(stored);
    } catch (const file_error& failure) {
        if (failure.code() != ENOENT && failure.code() != EISDIR) throw;
        check.damage = failure.code() == ENOENT ? "it is missing" : "it is a folder";
    }
    return check;
}

new_file write_array_file(file_system& files, const std::string& temporary, const array_shape& shape,
                          std::span<const std::byte> bytes, std::uint32_t& checksum) {
    new_file file(files, temporary);
    checksum = 0;
    const auto put = [&](std::span<const std::byte> part) {
        checksum = crc32c(part, checksum);
        file.write(part);
    };
    for (std::size_t at = 0; at < bytes.size(); at += length_of(piece))
        put(bytes.subspan(at, std::min(length_of(piece), bytes.size() - at)));
    std::int64_t missing = shape.file_bytes() - 4 - static_cast<std::int64_t>(bytes.size());
    if (missing > 0) {
        std::vector<std::byte> filler(length_of(std::min(missing, piece)));
        fill(shape.type, filler.data(), filler.size() / size_of(shape.type));
        for (; missing > 0; missing -= piece) put(std::span(filler).first(length_of(std::min(missing, piece))));
    }
    file.write(std::as_bytes(std::span(&checksum, 1)));
    return file;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
