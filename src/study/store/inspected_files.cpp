// SPDX-License-Identifier: MIT
// Compares files with their records.
#include "inspected_files.hpp"

#include <cerrno>

#include "disk_space.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

void inspected_files::refresh() {
    ledger.begin_look();
    ledger.end_look(names_in(files, own("chunks")).value_or(std::vector<std::string>{}));
}

void inspected_files::count_all(std::vector<damage>* problems) {
    for (const std::int64_t chunk : ledger.uncounted()) {
        const auto damage = damage_in([&] { ledger.count(chunk, read_record(chunk).record); });
        if (!damage) continue;
        if (problems != nullptr) problems->push_back({chunk, "", *damage});
        if (self || !exists(record_path(chunk)))
            put_back(chunk);
        else  // for those who only read it is still there, and damaged
            ledger.spoil(chunk);
    }
}

void inspected_files::put_back(std::int64_t chunk) {
    if (self && files.unlink(record_path(chunk)) < 0 && errno != ENOENT)
        throw file_error("removing", record_path(chunk), errno);
    forget(chunk);
    ledger.put_back(chunk);
}

void inspected_files::check_chunks(bool checksums, std::vector<damage>& problems) {
    for (std::int64_t chunk = 0; chunk < content.chunks(); ++chunk) {
        if (!ledger.is_finished(chunk)) continue;
        const std::size_t before = problems.size();
        store_files::check_chunk(chunk, checksums, problems);
        if (problems.size() > before && (self || !exists(record_path(chunk)))) put_back(chunk);
    }
    if (self && !problems.empty()) sync_folder(files, own("chunks"));
}

void inspected_files::check_rest(bool checksums, std::vector<damage>& problems) {
    for (std::size_t c = 0; c < coordinates.size(); ++c) {
        const stored_array& array = coordinates[c];
        bool whole = true;
        for (std::int64_t file = 0; file < array.shape.files(); ++file) {
            std::string reason;
            if (checksums)
                reason = places->check(array, file);
            else if (!has_length(path_of(array, file), array.shape.file_bytes()))
                reason = exists(path_of(array, file)) ? "it has not the length it should have" : "it is missing";
            if (reason.empty()) continue;
            problems.push_back({-1, array.name, reason});
            whole = false;
        }
        if (self && !whole) write_coordinates(true);
    }
    for (std::size_t v = 0; v < variables.size(); ++v) {
        if (content.variables[v].extent != along::nothing) continue;
        const std::string reason = check_result(v, checksums);
        if (reason.empty()) continue;
        problems.push_back({-1, variables[v].name, reason});
        if (!self) continue;
        files.unlink(result_record_path(v));
        files.unlink(path_of(variables[v], 0));
    }
}

bool inspected_files::is_consistent(std::int64_t chunk) {
    std::vector<damage> problems;
    store_files::check_chunk(chunk, true, problems);
    if (!problems.empty()) put_back(chunk);
    return problems.empty();
}

bool inspected_files::is_whole(resume_check check) {
    if (!ledger.complete()) return false;
    std::vector<damage> problems;
    check_chunks(check == resume_check::checksums, problems);
    check_rest(check == resume_check::checksums, problems);
    count_all(&problems);
    for (std::size_t v = 0; v < variables.size(); ++v)
        if (content.variables[v].extent == along::nothing && !has_result(v)) return false;
    return problems.empty();
}

void inspected_files::check_space() const {
    left_room(*this, content.chunks() - ledger.finished()).require_free(files, folder);
}

}  // namespace myriad::studies::inline MYRIAD_ABI
