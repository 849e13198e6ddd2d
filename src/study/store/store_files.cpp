// SPDX-License-Identifier: MIT
// Finds and reads the files of a store, each compared with its record.
#include "myriad/study/store/store_files.hpp"

#include <algorithm>
#include <cerrno>

#include "myriad/host/core/error.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

constexpr const char* wrong_length = "it has not the length it should have";

[[noreturn]] void refuse_damaged(const std::string& path, const std::string& damage) {
    host::refuse({path, " is damaged (", damage, repair_advice});
}

}  // namespace

std::string stored_coordinates::path_of(const stored_array& array, std::int64_t file) const {
    return folder + '/' + array.name + '/' + array.shape.file_name(file);
}

void stored_coordinates::read_record() {
    const std::optional<std::string> text = read_text(files, record_path());
    require(text.has_value(), "the record of the coordinates is missing");
    coordinate_checksums read = coordinates_of(*text, group);
    const std::lock_guard lock(mutex);
    record = std::move(read);
}

std::optional<std::uint32_t> stored_coordinates::recorded(const stored_array& array, std::int64_t file) {
    const std::lock_guard lock(mutex);
    const auto found = record.find(array.name);
    if (found == record.end() || std::cmp_greater_equal(file, found->second.size())) return std::nullopt;
    return found->second[static_cast<std::size_t>(file)];
}

std::string stored_coordinates::check(const stored_array& array, std::int64_t file, std::int64_t begin,
                                      std::int64_t end, std::byte* to) {
    file_check found = read_array_file(files, path_of(array, file), array.shape, begin, end, to);
    if (!found.damage.empty()) return found.damage;
    // Read again if it does not agree: it may have been mended since.
    for (int attempt = 0; attempt < 2; ++attempt) {
        const std::optional<std::uint32_t> expected = recorded(array, file);
        if (expected && *expected == found.checksum) return "";
        if (attempt == 1) return expected ? found.compare(*expected).damage : "it is not in the record";
        if (const auto damage = damage_in([&] { read_record(); })) return *damage;
    }
    return "";
}

void stored_coordinates::read(const stored_array& array, std::int64_t first, std::span<double> values) {
    const auto count = static_cast<std::int64_t>(values.size());
    require(first >= 0 && first <= array.shape.items() - count, "coordinate ", array.name, " has ", array.shape.items(),
            " values, and not those from ", first, " to ", first + count);
    for (std::int64_t at = first; at < first + count;) {
        const std::int64_t file = at / array.shape.chunk, begin = at - file * array.shape.chunk;
        const std::int64_t end = std::min(array.shape.chunk, begin + first + count - at);
        const std::string damage =
            check(array, file, begin * 8, end * 8, reinterpret_cast<std::byte*>(values.data() + (at - first)));
        if (!damage.empty()) refuse_damaged(path_of(array, file), damage);
        at += end - begin;
    }
}

store_files::store_files(file_system& used, std::string where, stored_group of)
    : files(used), folder(std::move(where)), group(std::move(of)), content(group.content),
      places(std::make_shared<stored_coordinates>(files, folder, group.checksum)) {
    for (const variable& v : content.variables) variables.push_back({v.name, shape_of(content, v), v.attributes});
    for (coordinate& c : content.coordinates) {
        coordinates.push_back({c.name, shape_of(content, c), c.attributes});
        c.values = [read = places, array = coordinates.back()](std::int64_t first, std::span<double> values) {
            read->read(array, first, values);
        };
    }
}

std::optional<std::int64_t> store_files::length_of(const std::string& path) const {
    std::int64_t size = 0;
    if (files.size(path, size) == 0) return size;
    if (errno == ENOENT) return std::nullopt;
    throw file_error("looking for", path, errno);
}

stored_chunk store_files::read_record(std::int64_t chunk) const {
    const std::optional<std::string> text = read_text(files, record_path(chunk));
    require(text.has_value(), "its record is missing");
    return record_of(*text, content, group.checksum, chunk);
}

void store_files::check_chunk(std::int64_t chunk, bool checksums, std::vector<damage>& problems) const {
    std::optional<stored_chunk> record;
    const auto damage = damage_in([&] {
        if (checksums) record = read_record(chunk);
    });
    if (damage) problems.push_back({chunk, "", *damage});
    for (std::size_t v = 0; v < variables.size(); ++v) {
        if (content.variables[v].extent == along::nothing) continue;
        const std::string path = path_of(variables[v], chunk);
        file_check check;
        if (!has_length(path, variables[v].shape.file_bytes()))
            check.damage = exists(path) ? wrong_length : "it is missing";
        else if (record)
            check = read_array_file(files, path, variables[v].shape).compare(record->checksums[place_in_record(v)]);
        if (!check.damage.empty()) problems.push_back({chunk, variables[v].name, check.damage});
    }
}

bool store_files::has_result(std::size_t v) const { return exists(result_record_path(v)); }

std::string store_files::check_result(std::size_t v, bool checksums) const {
    const std::string path = path_of(variables[v], 0);
    const bool has_file = exists(path), has_record = exists(result_record_path(v));
    if (!has_file) return has_record ? "it is missing" : "";
    if (!has_length(path, variables[v].shape.file_bytes())) return wrong_length;
    if (!checksums) return "";
    return damage_of_result(v, nullptr);
}

// Of the variables that records have checksums of.
std::size_t store_files::place_in_record(std::size_t v) const {
    const auto end = content.variables.begin() + static_cast<std::ptrdiff_t>(v);
    return static_cast<std::size_t>(
        std::count_if(content.variables.begin(), end, [](const variable& w) { return w.extent != along::nothing; }));
}

std::uint32_t store_files::recorded(std::size_t v, std::int64_t chunk) const {
    {
        const std::lock_guard lock(mutex_);
        const auto known = checksums_.find(chunk);
        if (known != checksums_.end()) return known->second[place_in_record(v)];
    }
    stored_chunk read = read_record(chunk);
    const std::lock_guard lock(mutex_);
    return (checksums_[chunk] = std::move(read.checksums))[place_in_record(v)];
}

void store_files::forget(std::int64_t chunk) const {
    const std::lock_guard lock(mutex_);
    checksums_.erase(chunk);
}

void store_files::read_chunk(std::size_t v, std::int64_t chunk, std::int64_t begin, std::int64_t end,
                             std::byte* to) const {
    const std::string path = path_of(variables[v], chunk);
    // Once more if they do not agree: another process may have done the chunk anew.
    for (int attempt = 0;; ++attempt) {
        file_check check;
        const auto unreadable = damage_in([&] {
            const std::uint32_t expected = recorded(v, chunk);
            check = read_array_file(files, path, variables[v].shape, begin, end, to);
            check.compare(expected);
        });
        if (unreadable) check.damage = *unreadable;
        if (check.damage.empty()) return;
        if (attempt == 1) refuse_damaged(path, check.damage);
        forget(chunk);
    }
}

std::string store_files::damage_of_result(std::size_t v, std::byte* to) const {
    const array_shape& shape = variables[v].shape;
    file_check check =
        read_array_file(files, path_of(variables[v], 0), shape, 0, to != nullptr ? shape.file_bytes() - 4 : 0, to);
    if (!check.damage.empty()) return check.damage;
    const std::optional<std::string> text = read_text(files, result_record_path(v));
    if (!text) return "its record is missing";
    const auto damage = damage_in([&] { check.compare(result_of(*text, group.checksum, variables[v].name)); });
    return damage ? *damage : check.damage;
}

void store_files::read_result(std::size_t v, std::byte* to) const {
    const std::string damage = damage_of_result(v, to);
    if (!damage.empty()) refuse_damaged(path_of(variables[v], 0), damage);
}

}  // namespace myriad::studies::inline MYRIAD_ABI
