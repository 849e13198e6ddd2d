// SPDX-License-Identifier: MIT
// What is where in a store's folder, and what its records say of it: paths, arrays, records, and reading them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/layout.hpp"
#include "myriad/study/store/array_file.hpp"
#include "myriad/study/store/file_system.hpp"
#include "myriad/study/store/metadata.hpp"
#include "myriad/study/store/records.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// An array of a store, in a folder of its name.
struct stored_array {
    std::string name;
    array_shape shape;
    std::vector<attribute> attributes;
};

/// The coordinates of a store, shared by all copies of its layout.
class stored_coordinates {
public:
    stored_coordinates(file_system& used, std::string where, group_checksum of)
        : files(used), folder(std::move(where)), group(std::move(of)) {}

    std::string record_path() const { return folder + "/myriad/coordinates.json"; }
    std::string path_of(const stored_array& array, std::int64_t file) const;
    /// What is wrong with a file of a coordinate; copies the bytes from `begin` to `end` of it.
    std::string check(const stored_array& array, std::int64_t file, std::int64_t begin = 0, std::int64_t end = 0,
                      std::byte* to = nullptr);
    /// The values [first, first + size). Throws `error` if they are damaged.
    void read(const stored_array& array, std::int64_t first, std::span<double> values);
    /// Reads the record again. Throws `error` if it is damaged or missing.
    void read_record();
    /// The checksums of their files; empty before `read_record`.
    coordinate_checksums record;

private:
    std::optional<std::uint32_t> recorded(const stored_array& array, std::int64_t file);

    file_system& files;
    std::string folder;
    group_checksum group;
    std::mutex mutex;
};

/// The files of a store.
class store_files {
public:
    store_files(file_system& used, std::string where, stored_group of);

    file_system& files;
    const std::string folder;
    const stored_group group;
    layout content;  ///< with coordinates that are read
    std::vector<stored_array> variables, coordinates;
    std::shared_ptr<stored_coordinates> places;

    std::string own(std::string_view name) const { return message(folder, "/myriad/", name); }
    std::string record_path(std::int64_t chunk) const { return message(folder, "/myriad/chunks/", chunk, ".json"); }
    std::string result_record_path(std::size_t v) const { return own("results/" + variables[v].name + ".json"); }
    std::string path_of(const stored_array& array, std::int64_t file) const { return places->path_of(array, file); }

    /// The bytes of a file; nothing if there is none.
    std::optional<std::int64_t> length_of(const std::string& path) const;
    bool exists(const std::string& path) const { return length_of(path).has_value(); }
    bool has_length(const std::string& path, std::int64_t length) const { return length_of(path) == length; }

    /// The record of a chunk. Throws `error` if it is damaged or missing.
    stored_chunk read_record(std::int64_t chunk) const;
    /// Compares the record of a chunk with its files.
    void check_chunk(std::int64_t chunk, bool checksums, std::vector<damage>& problems) const;
    /// What is wrong with a final result that is there, by its record too if `checksums`.
    std::string check_result(std::size_t v, bool checksums) const;
    /// Whether a final result has been written: it is there, or damaged.
    bool has_result(std::size_t v) const;

    /// Copies the bytes from `begin` to `end` of a variable's file for a chunk, and compares it with its record.
    void read_chunk(std::size_t v, std::int64_t chunk, std::int64_t begin, std::int64_t end, std::byte* to) const;
    void read_result(std::size_t v, std::byte* to) const;
    /// The record of this chunk may have changed.
    void forget(std::int64_t chunk) const;

private:
    std::size_t place_in_record(std::size_t v) const;
    std::string damage_of_result(std::size_t v, std::byte* to) const;
    std::uint32_t recorded(std::size_t v, std::int64_t chunk) const;

    mutable std::mutex mutex_;
    mutable std::map<std::int64_t, std::vector<std::uint32_t>> checksums_;  // of chunks that were read
};

/// What a message about damaged results ends with.
inline constexpr const char* repair_advice =
    "): start the study again with the option check set to checksums, which reads all that is stored and does what is "
    "damaged once more";

}  // namespace myriad::studies::inline MYRIAD_ABI
