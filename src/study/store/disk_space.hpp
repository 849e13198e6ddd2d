// SPDX-License-Identifier: MIT
// The space on its disk that a store still needs.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "myriad/study/store/store_files.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

// What is left to be written.
struct room {
    std::int64_t chunks;
    double bytes = 0;
    bool has_coordinates = false;

    explicit room(std::int64_t missing) : chunks(missing) { add(1, chunks); }  // records, of a block each
    void add(std::int64_t file_bytes, std::int64_t count) {
        bytes += std::ceil(static_cast<double>(file_bytes) / 4096) * 4096 * static_cast<double>(count);
    }
    void add_coordinates(std::int64_t file_bytes, std::int64_t count) {
        add(file_bytes, count);
        has_coordinates = true;
    }
    // An error unless the disk of a folder has so much.
    void require_free(file_system& files, const std::string& folder) const;
};
// All of a store that is not there yet.
room needed_room(const layout& content);
// What is not there of a store that lacks so many chunks.
room left_room(const store_files& of, std::int64_t missing);

}  // namespace myriad::studies::inline MYRIAD_ABI
