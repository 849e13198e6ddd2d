// SPDX-License-Identifier: MIT
// Folders of results: made, gone on with, filled, read and verified.
#include "myriad/study/store.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "myriad/host/core/error.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/study/model_behaviour.hpp"
#include "myriad/study/store_files.hpp"
#include "myriad/study/writer.hpp"

namespace myriad {

using namespace studies;

static_assert(std::endian::native == std::endian::little, "stores hold little-endian numbers as they are in memory");

namespace {

constexpr const char* own_group = "{\"zarr_format\": 3, \"node_type\": \"group\"}\n";
constexpr std::size_t most_open = 8;  // files of a chunk, since each thread of each device has one

std::size_t bytes_of(std::int64_t count) { return static_cast<std::size_t>(count); }

// Where it is also after the process has gone to another folder.
std::string absolute(const std::string& folder) {
    require(!folder.empty(), host::named_option("store", "the folder"), " of a study has no name", host::cure,
            "give one");
    refuse_zero_byte(folder);
    std::error_code unknown;
    const std::filesystem::path path = std::filesystem::absolute(folder, unknown);
    return unknown ? folder : path.string();
}

// A group that was found in a folder, and what is wrong with its file, if it is known from its copy alone.
struct found_group {
    stored_group group;
    std::string text, damage;
    statement advice = {};  // to those who only read, besides what `damage` says
};

std::string group_path(const std::string& folder) { return folder + "/zarr.json"; }
std::string copy_path(const std::string& folder) { return folder + "/myriad/group.json"; }

// The copy of a group's file.
std::optional<found_group> copied_group(file_system& files, const std::string& folder, const std::string& damage) {
    const std::optional<std::string> text = read_text(files, copy_path(folder));
    if (!text) return std::nullopt;
    try {
        return found_group{group_of(*text, copy_path(folder)), *text, damage};
    } catch (const file_error&) {
        throw;
    } catch (const error&) {
        return std::nullopt;
    }
}

// The group of a folder with a store, or nothing if there is none yet. An error if there is something else.
std::optional<found_group> find_group(file_system& files, const std::string& folder) {
    const std::string path = group_path(folder);
    // In this order, since another process may be about to make one.
    std::vector<std::string> names = names_in(files, folder).value_or(std::vector<std::string>{});
    if (const std::optional<std::string> text = read_text(files, path)) {
        try {
            return found_group{group_of(*text, path), *text, ""};
        } catch (const file_error&) {
            throw;
        } catch (const error& failure) {
            if (auto copy = copied_group(files, folder, failure.what())) return copy;
            throw;
        }
    }
    if (auto copy = copied_group(files, folder, path + " is missing")) {
        copy->advice =
            statement_of(host::cure, "start the study again, which restores it from its copy myriad/group.json");
        return copy;
    }
    // A start that was interrupted early leaves this.
    std::erase(names, "myriad");
    if (names.empty()) return std::nullopt;
    std::sort(names.begin(), names.end());
    host::refuse({host::named_option("store", "the folder"), " ", folder, " is not empty and holds no study (it has ",
                  names.front(), names.size() > 1 ? " and others" : "", ")", host::cure, "give a new folder"});
}

// For readers, who have nothing to restore it with.
std::optional<found_group> whole_group(file_system& files, const std::string& folder) {
    std::optional<found_group> found = find_group(files, folder);
    if (found && !found->damage.empty()) host::refuse({found->damage, found->advice});
    return found;
}

std::string model_path(const std::string& folder) { return folder + "/myriad/model.json"; }

// What the model of a store does; nothing if that is not known.
std::optional<model_behaviour> stored_model(file_system& files, const std::string& folder,
                                            const group_checksum& group) {
    try {
        if (const auto text = read_text(files, model_path(folder))) return model_of(*text, group);
    } catch (const file_error&) {
        throw;
    } catch (const error&) {  // `check_metadata` says so
    }
    return std::nullopt;
}

void refuse_other(file_system& files, const stored_group& stored, const layout& here, const model_behaviour* model,
                  const std::string& folder) {
    std::vector<statement> found = differences(stored.content, here);
    // With other instances or options, functions give other values, too.
    if (model != nullptr && (found.empty() || differ_in_notes_alone(stored.content, here))) {
        if (const auto there = stored_model(files, folder, stored.checksum))
            for (statement& one : model->differences_from(*there)) found.push_back(std::move(one));
    }
    if (found.empty()) return;
    statement list;
    for (std::size_t i = 0; i < found.size() && i < 10; ++i) list = statement_of(list, "\n  ", found[i]);
    if (found.size() > 10) list = statement_of(list, "\n  and ", found.size() - 10, " more");
    host::refuse({"the folder ", folder, " holds the results of another study, which differs in", list,
                  host::cure_begins{"\n"}, "give another ", host::named_option("store", "folder"),
                  ", or the same study"});
}

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
    void require_free(file_system& files, const std::string& folder) const {
        std::string place = folder;
        std::int64_t size = 0, free = 0;
        while (files.size(place, size) < 0 && folder_of(place) != place) {
            if (errno != ENOENT) throw file_error("looking for", place, errno);
            place = folder_of(place);
        }
        if (files.free_bytes(place, free) < 0) throw file_error("asking for the free space of", place, errno);
        const auto [need, have] = host::bytes_texts(bytes, static_cast<double>(free));
        require(bytes <= static_cast<double>(free), "the ", chunks, " chunks ",
                has_coordinates ? "and the coordinates " : "", "that are left take ", need, ", and the disk of ",
                host::named_option("store", folder), " has ", have, " free", host::cure,
                "free space, give a folder on a larger disk, or keep less");
    }
};
// All of a store that is not there yet.
room needed_room(const layout& content) {
    room all(content.chunks());
    for (const coordinate& c : content.coordinates) {
        const array_shape shape = shape_of(content, c);
        all.add_coordinates(shape.file_bytes(), shape.files());
    }
    for (const variable& v : content.variables)
        all.add(shape_of(content, v).file_bytes(), v.extent == along::nothing ? 1 : all.chunks);
    return all;
}

// Again if another process took this one for dead and removed its temporary files, as often as that happens; but not if
// what is missing is something else, so that it may not be written.
template <class F, class May>
void repeat_if_lost(writer& self, F write, May may_write) {
    constexpr int most_attempts = 1000;
    for (int attempt = 0;; ++attempt) {
        try {
            return write();
        } catch (const file_error& failure) {
            if (failure.code() != ENOENT || attempt == most_attempts || !may_write()) throw;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(std::min(attempt, 50)));
        self.appear();
    }
}

}  // namespace

struct store::implementation : store_files {
    const std::string group_text;
    std::vector<coordinate> given;  // coordinates to write, only of a store that can be written
    std::unique_ptr<writer> self;   // null if opened for reading

    mutable std::mutex mutex;                      // of all that follows
    std::vector<bool> finished, counted, spoiled;  // spoiled: with a damaged record
    std::int64_t finished_count = 0, counted_instances = 0;
    std::map<std::string, std::int64_t> statuses;
    std::set<std::string> device_names;
    std::map<std::string, arithmetic> computed_by;  // by host and arithmetic
    double seconds = 0.0;
    std::vector<std::int64_t> committed;  // by this process, since the last look at the folder began
    std::vector<damage> found;
    std::vector<std::string> warnings;
    std::optional<arithmetic> begun_with;
    other_arithmetic others = other_arithmetic::refuse;

    std::mutex claiming;  // of what follows
    std::int64_t next = 0;
    std::chrono::steady_clock::time_point looked, tidied;
    std::chrono::milliseconds expiry{};

    implementation(file_system& used, std::string where, const found_group& of)
        : store_files(used, std::move(where), of.group), group_text(of.text) {
        finished.assign(bytes_of(content.chunks()), false);
        spoiled = counted = finished;
    }

    void check_chunk(std::int64_t chunk) const { range_of(content, chunk); }
    bool is_finished(std::int64_t chunk) const {
        const std::lock_guard lock(mutex);
        return finished[bytes_of(chunk)];
    }
    void require_writable() const {
        require(self != nullptr, "the store ", folder, " was opened for reading", host::cure,
                "use store::create_or_resume");
    }

    // -----------------------------------------------------------------------------------------------------------------
    // Making
    // -----------------------------------------------------------------------------------------------------------------

    void write_own(const std::string& path, const std::string& text) {
        write_text(files, self->temporary(), path, text);
    }

    const coordinate& given_for(std::size_t c) const {
        const auto same = std::find_if(given.begin(), given.end(),
                                       [&](const coordinate& g) { return g.name == coordinates[c].name; });
        require(same != given.end(), "there are no values for coordinate ", coordinates[c].name);
        return *same;
    }

    std::uint32_t write_coordinate_file(std::size_t c, std::int64_t file, bool replaces) {
        const array_shape& shape = coordinates[c].shape;
        const std::int64_t first = file * shape.chunk;
        std::vector<double> values(bytes_of(std::min(shape.chunk, shape.items() - first)));
        given_for(c).values(first, values);
        std::uint32_t checksum = 0;
        new_file made = write_array_file(files, self->temporary(), shape, std::as_bytes(std::span(values)), checksum);
        made.finish();
        if (replaces) {
            made.rename_to(path_of(coordinates[c], file));
        } else if (!made.link_to(path_of(coordinates[c], file))) {
            // Another process was faster, perhaps with a library whose functions differ in the last digit: there is one
            // record for both.
            const file_check there = read_array_file(files, path_of(coordinates[c], file), shape);
            if (!there.damage.empty()) return write_coordinate_file(c, file, true);
            return there.checksum;
        }
        return checksum;
    }

    void begin_array(const stored_array& array) {
        const std::string place = folder + '/' + array.name;
        make_folder(files, place);
        write_own(place + "/zarr.json", array_json(array.shape, array.attributes));
    }

    void write_coordinates(bool replaces) {
        coordinate_checksums checksums;
        for (std::size_t c = 0; c < coordinates.size(); ++c) {
            std::vector<std::uint32_t>& of_files = checksums[coordinates[c].name];
            for (std::int64_t file = 0; file < coordinates[c].shape.files(); ++file)
                of_files.push_back(write_coordinate_file(c, file, replaces));
            sync_folder(files, folder + '/' + coordinates[c].name);
        }
        write_own(places->record_path(), coordinates_json(group.checksum, checksums));
        places->read_record();
    }

    // Everything but results. May be done by several processes at a time, with equal files.
    void write_arrays() {
        for (const stored_array& array : variables) begin_array(array);
        for (const stored_array& array : coordinates) begin_array(array);
        write_coordinates(false);
        // A group of its own, so that readers which look at every folder know what it is.
        write_own(own("zarr.json"), own_group);
        write_own(copy_path(folder), group_text);
        make_folder(files, own("results"));
        make_folder(files, own("claims"));
        sync_folder(files, folder);
        // The last, as the sign that all this is there.
        make_folder(files, own("chunks"));
        sync_folder(files, own(""));
    }

    // What describes the results: compared with what it should be, and restored if it can be written.
    void check_metadata(std::vector<damage>& problems) {
        const auto restore = [&](const std::string& path, const std::string& name, const std::string& wanted,
                                 bool to_the_byte) {
            const std::optional<std::string> text = read_text(files, path);
            if (text && (to_the_byte ? *text == wanted : same_json(*text, wanted))) return;
            problems.push_back({-1, name, text ? "it is not what it should be" : "it is missing"});
            if (!self) return;
            make_folder(files, folder_of(path));
            write_own(path, wanted);
        };
        restore(group_path(folder), "zarr.json", group_text, true);
        restore(copy_path(folder), "myriad/group.json", group_text, true);
        restore(own("zarr.json"), "myriad/zarr.json", own_group, false);
        for (const std::vector<stored_array>* arrays : {&variables, &coordinates})
            for (const stored_array& array : *arrays)
                restore(folder + '/' + array.name + "/zarr.json", array.name + "/zarr.json",
                        array_json(array.shape, array.attributes), false);
        try {
            if (const auto text = read_text(files, own("arithmetic.json"))) arithmetic_of(*text, group.checksum);
        } catch (const file_error&) {
            throw;
        } catch (const error& failure) {
            problems.push_back({-1, "myriad/arithmetic.json", failure.what()});
            if (self) files.unlink(own("arithmetic.json"));
        }
        try {
            if (const auto text = read_text(files, model_path(folder))) model_of(*text, group.checksum);
        } catch (const file_error&) {
            throw;
        } catch (const error& failure) {
            problems.push_back({-1, "myriad/model.json", failure.what()});
            if (self) files.unlink(model_path(folder));
        }
        try {
            places->read_record();
        } catch (const file_error&) {
            throw;
        } catch (const error& failure) {
            problems.push_back({-1, "myriad/coordinates.json", failure.what()});
            if (self) write_coordinates(true);
        }
        if (!self) return;
        make_folder(files, own("claims"));
        make_folder(files, own("results"));
    }

    // Keeps what the model does, if that is not there yet.
    void keep_model(const model_behaviour* model, const layout& wanted) {
        if (model == nullptr || model->empty()) return;
        if (!exists(model_path(folder))) {
            new_file made(files, self->temporary());
            made.write(model_json(group.checksum, *model));
            made.finish();
            const bool is_first = made.link_to(model_path(folder));
            sync_folder(files, own(""));
            if (is_first) return;
        }
        refuse_other(files, group, wanted, model, folder);  // another process may have been faster
    }

    // That which the store began with; nothing if it is not known.
    std::optional<arithmetic> first_arithmetic() const {
        try {
            if (const auto text = read_text(files, own("arithmetic.json"))) return arithmetic_of(*text, group.checksum);
        } catch (const file_error&) {
            throw;
        } catch (const error&) {  // `check_metadata` says so
        }
        return std::nullopt;
    }

    // Compares it with the arithmetic of the results, by the option.
    void compare_arithmetic(const arithmetic& here) {
        if (here.instruction_set.empty() || !begun_with || begun_with->same_as(here)) return;
        const std::string differs = message("the study in ", folder, " was begun with ", begun_with->text(), " on ",
                                            begun_with->host, ", and ", here.host, " has ", here.text(),
                                            ": results differ in their last digits, and in more where the model is "
                                            "chaotic");
        require(
            others == other_arithmetic::warn, differs,
            "; set MYRIAD_INSTRUCTION_SET to the same on all machines, and use the same compiler and libraries, or ",
            host::cures::allow_arithmetic);
        const std::lock_guard lock(mutex);
        if (std::find(warnings.begin(), warnings.end(), differs) == warnings.end()) warnings.push_back(differs);
    }

    // Compares it with this process', which is it if there is none yet.
    void check_arithmetic(const store_options& options) {
        const arithmetic& here = options.computed_by;
        others = options.others;
        if (here.instruction_set.empty() || finished_count == content.chunks()) return;
        begun_with = first_arithmetic();
        if (!begun_with && self) {
            new_file made(files, self->temporary());
            made.write(arithmetic_json(group.checksum, here));
            made.finish();
            // Another process may be faster.
            begun_with = made.link_to(own("arithmetic.json")) ? here : first_arithmetic();
            sync_folder(files, own(""));
        }
        compare_arithmetic(here);
    }

    // -----------------------------------------------------------------------------------------------------------------
    // What is done
    // -----------------------------------------------------------------------------------------------------------------

    void refresh() {
        {
            const std::lock_guard lock(mutex);
            committed.clear();
        }
        const std::vector<std::string> names = names_in(files, own("chunks")).value_or(std::vector<std::string>{});
        std::vector<bool> now(finished.size(), false);
        for (const std::string& name : names) {
            std::int64_t chunk = -1;
            const char* const end = name.data() + name.size();
            const auto [rest, problem] = std::from_chars(name.data(), end, chunk);
            if (problem != std::errc() || std::string_view(rest, end) != ".json" || chunk < 0 ||
                chunk >= content.chunks())
                continue;
            now[bytes_of(chunk)] = true;
        }
        const std::lock_guard lock(mutex);
        spoiled.assign(spoiled.size(), false);
        for (const std::int64_t chunk : committed) now[bytes_of(chunk)] = true;
        bool lost = false;  // put back by another process
        for (std::size_t i = 0; i < now.size() && !lost; ++i) lost = counted[i] && !now[i];
        if (lost) forget_counts();
        finished = std::move(now);
        finished_count = std::count(finished.begin(), finished.end(), true);
    }

    void finish(std::int64_t chunk) {
        if (!finished[bytes_of(chunk)]) ++finished_count;
        finished[bytes_of(chunk)] = true;
        committed.push_back(chunk);
    }

    void forget_counts() {
        counted.assign(counted.size(), false);
        counted_instances = 0;
        statuses.clear();
        device_names.clear();
        computed_by.clear();
        seconds = 0.0;
    }

    void count(std::int64_t chunk, const chunk_record& record) {
        if (counted[bytes_of(chunk)]) return;
        counted[bytes_of(chunk)] = true;
        counted_instances += range_of(content, chunk).count;
        for (const auto& [name, number] : record.statuses) statuses[name] += number;
        if (!record.device.empty()) device_names.insert(record.device);
        const arithmetic& by = record.computed_by;
        if (!by.library.empty()) computed_by.emplace(by.host + '\n' + by.text(), by);
        seconds += record.seconds;
    }

    // Reads the records that were not read yet; adds those that are damaged.
    void count_all(std::vector<damage>* problems = nullptr) {
        std::vector<std::int64_t> missing;
        {
            const std::lock_guard lock(mutex);
            for (std::size_t i = 0; i < finished.size(); ++i)
                if (finished[i] && !counted[i] && !spoiled[i]) missing.push_back(static_cast<std::int64_t>(i));
        }
        for (const std::int64_t chunk : missing) {
            try {
                const chunk_record record = read_record(chunk).record;
                const std::lock_guard lock(mutex);
                count(chunk, record);
            } catch (const file_error&) {
                throw;
            } catch (const error& failure) {
                if (problems != nullptr) problems->push_back({chunk, "", failure.what()});
                if (self || !exists(record_path(chunk))) {
                    put_back(chunk);
                } else {  // for those who only read it is still there, and damaged
                    const std::lock_guard lock(mutex);
                    spoiled[bytes_of(chunk)] = true;
                }
            }
        }
    }

    void put_back(std::int64_t chunk) {
        if (self && files.unlink(record_path(chunk)) < 0 && errno != ENOENT)
            throw file_error("removing", record_path(chunk), errno);
        forget(chunk);
        const std::lock_guard lock(mutex);
        if (finished[bytes_of(chunk)]) --finished_count;
        finished[bytes_of(chunk)] = false;
        if (counted[bytes_of(chunk)]) forget_counts();
    }

    // -----------------------------------------------------------------------------------------------------------------
    // What is damaged
    // -----------------------------------------------------------------------------------------------------------------

    void check_chunks(bool checksums, std::vector<damage>& problems) {
        for (std::int64_t chunk = 0; chunk < content.chunks(); ++chunk) {
            if (!is_finished(chunk)) continue;
            const std::size_t before = problems.size();
            store_files::check_chunk(chunk, checksums, problems);
            if (problems.size() > before && (self || !exists(record_path(chunk)))) put_back(chunk);
        }
        if (self && !problems.empty()) sync_folder(files, own("chunks"));
    }

    void check_rest(bool checksums, std::vector<damage>& problems) {
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

    // Whether a chunk that another process may have written at the same time has the files of its record. With one
    // arithmetic the bits are the same; else it is put back if the files are of both.
    bool is_consistent(std::int64_t chunk) {
        std::vector<damage> problems;
        store_files::check_chunk(chunk, true, problems);
        if (!problems.empty()) put_back(chunk);
        return problems.empty();
    }

    // Whether there is nothing to write.
    bool is_whole(resume_check check) {
        if (finished_count != content.chunks()) return false;
        std::vector<damage> problems;
        check_chunks(check == resume_check::checksums, problems);
        check_rest(check == resume_check::checksums, problems);
        count_all(&problems);
        for (std::size_t v = 0; v < variables.size(); ++v)
            if (content.variables[v].extent == along::nothing && !has_result(v)) return false;
        return problems.empty();
    }

    // Before anything is written, and again when chunks were put back.
    void check_space() const {
        room left{content.chunks() - finished_count};
        for (const stored_array& array : coordinates)
            for (std::int64_t file = 0; file < array.shape.files(); ++file)
                if (!has_length(path_of(array, file), array.shape.file_bytes()))
                    left.add_coordinates(array.shape.file_bytes(), 1);
        for (std::size_t v = 0; v < variables.size(); ++v) {
            if (content.variables[v].extent != along::nothing)
                left.add(variables[v].shape.file_bytes(), left.chunks);
            else if (!exists(path_of(variables[v], 0)))
                left.add(variables[v].shape.file_bytes(), 1);
        }
        left.require_free(files, folder);
    }

    // -----------------------------------------------------------------------------------------------------------------
    // Writing
    // -----------------------------------------------------------------------------------------------------------------

    std::span<const std::byte> bytes_for(std::size_t v, std::span<const column> columns, std::int64_t items) const {
        const variable& wanted = content.variables[v];
        const column* given_column = nullptr;
        for (const column& c : columns)
            if (c.variable == wanted.name) given_column = &c;
        require(given_column != nullptr, "there is no column for variable ", wanted.name,
                ": a chunk has one for each variable");
        require(given_column->type == wanted.type, "the column for ", wanted.name, " has values of type ",
                name_of(given_column->type), ", and the variable ", name_of(wanted.type));
        const std::int64_t bytes = items * variables[v].shape.item_bytes();
        require(given_column->bytes.size() == bytes_of(bytes), "the column for ", wanted.name, " has ",
                given_column->bytes.size(), " bytes, and needs ", bytes);
        return given_column->bytes;
    }

    // The columns in the order of the variables, empty for those without.
    std::vector<std::span<const std::byte>> checked(std::int64_t chunk, std::span<const column> columns) const {
        std::vector<std::span<const std::byte>> ordered(variables.size());
        std::size_t used = 0;
        for (std::size_t v = 0; v < variables.size(); ++v) {
            const along extent = content.variables[v].extent;
            if (extent == along::nothing) continue;
            ordered[v] = bytes_for(v, columns, extent == along::instances ? range_of(content, chunk).count : 1);
            ++used;
        }
        if (columns.size() != used) {
            for (const column& c : columns) {
                const std::size_t v = content.find(c.variable);
                require(content.variables[v].extent != along::nothing, "variable ", c.variable, " is not of a chunk",
                        host::cure, "use store::write");
            }
            host::refuse({"chunk ", chunk, " has ", columns.size(), " columns for ", used, " variables"});
        }
        return ordered;
    }

    void write_chunk(std::int64_t chunk, const std::vector<std::span<const std::byte>>& ordered,
                     const chunk_record& record) {
        std::vector<std::pair<std::size_t, new_file>> written;
        stored_chunk stored{record, {}};
        // Several are handed over before the first is waited for, so that the disk has them together.
        std::size_t finished_files = 0;
        const auto finish_until = [&](std::size_t end) {
            while (finished_files < end) written[finished_files++].second.finish();
        };
        for (std::size_t v = 0; v < variables.size(); ++v) {
            if (content.variables[v].extent == along::nothing) continue;
            if (written.size() - finished_files == most_open) finish_until(written.size());
            written.emplace_back(v, write_array_file(files, self->temporary(), variables[v].shape, ordered[v],
                                                     stored.checksums.emplace_back()));
        }
        finish_until(written.size());
        for (auto& [v, file] : written) file.rename_to(path_of(variables[v], chunk));
        for (auto& [v, file] : written) sync_folder(files, folder + '/' + variables[v].name);
        write_own(record_path(chunk), record_json(content, group.checksum, chunk, stored));
    }

    void write_result(std::size_t v, std::span<const std::byte> bytes) {
        std::uint32_t checksum = 0;
        new_file made = write_array_file(files, self->temporary(), variables[v].shape, bytes, checksum);
        made.finish();
        made.rename_to(path_of(variables[v], 0));
        sync_folder(files, folder + '/' + variables[v].name);
        write_own(result_record_path(v), result_json(group.checksum, variables[v].name, checksum));
    }

    // Gives a claim back if another process had done the chunk before.
    bool keep_claim(std::int64_t chunk) {
        try {
            if (!exists(record_path(chunk))) return true;
        } catch (...) {
            self->release(chunk);
            throw;
        }
        self->release(chunk);
        return false;
    }

    // Removes what dead processes of other machines left, which takes several looks.
    void tidy() {
        const auto now = std::chrono::steady_clock::now();
        if (now - tidied < expiry / 4) return;
        tidied = now;
        self->remove_dead();
    }

    void require_same_study() const {
        const std::optional<std::string> text = read_text(files, group_path(folder));
        if (!text) throw file_error("looking for", group_path(folder), ENOENT);
        require(*text == group_text, host::named_option("store", "the folder"), " ", folder,
                " holds something else than when this study began", host::cure, "give each study a folder of its own");
    }

    // Of a study that runs.
    template <class F>
    void with_writer(F write) {
        const auto may_write = [this] {
            require_same_study();
            for (const stored_array& array : variables)
                if (!exists(folder + '/' + array.name)) return false;
            return exists(own("chunks"));
        };
        require_same_study();
        repeat_if_lost(*self, write, may_write);
    }
};

store::store(std::unique_ptr<implementation> made) : self_(std::move(made)) {}
store::store(store&& other) noexcept = default;
store& store::operator=(store&& other) noexcept = default;
store::~store() = default;

store store::create_or_resume(const std::string& given, const layout& wanted, const store_options& options) {
    wanted.check();
    const std::string folder = absolute(given);
    constexpr std::chrono::milliseconds never = std::chrono::hours(24 * 365 * 100);
    require(options.expiry.count() > 0 && options.expiry <= never, "the expiry of claims is ", options.expiry.count(),
            " ms (must be positive, and at most ", never.count(), ')', host::cure, "give seconds to minutes");
    file_system& files = options.files ? *options.files : file_system::real();
    std::optional<found_group> there = find_group(files, folder);
    const bool is_new = !there;
    if (there) refuse_other(files, there->group, wanted, options.model.get(), folder);
    // All that can be refused before anything is written.
    if (is_new) {
        std::string text = group_json(wanted);
        there = found_group{group_of(text, group_path(folder)), text, ""};
        needed_room(there->group.content).require_free(files, folder);  // before memory is taken for every chunk
    }
    auto made = std::make_unique<implementation>(files, folder, *there);
    made->refresh();
    made->check_space();
    made->check_arithmetic(options);
    try {
        make_folders(files, folder);
        make_folder(files, folder + "/myriad");
        made->self = std::make_unique<writer>(files, folder + "/myriad", options.expiry);
    } catch (const file_error& failure) {
        const bool forbidden = failure.code() == EROFS || failure.code() == EACCES || failure.code() == EPERM;
        if (!forbidden || is_new || !made->is_whole(options.check)) throw;
        return store(std::move(made));
    }
    const auto may_write = [&] { return made->exists(folder + "/myriad"); };
    if (is_new) {
        bool is_first = true;
        repeat_if_lost(
            *made->self,
            [&] {
                new_file group(files, made->self->temporary());
                group.write(there->text);
                group.finish();
                is_first = group.link_to(group_path(folder));
            },
            may_write);
        sync_folder(files, folder);
        if (!is_first) {  // another process was faster
            there = find_group(files, folder);
            require(there.has_value(), host::named_option("store", "the folder"), " ", folder,
                    " was removed while a study started there");
            refuse_other(files, there->group, wanted, options.model.get(), folder);
            auto self = std::move(made->self);
            made = std::make_unique<implementation>(files, folder, *there);
            made->self = std::move(self);
        }
    }
    made->expiry = options.expiry;
    made->given = wanted.coordinates;
    made->content.description = wanted.description;  // the same, with its own line breaks
    const auto begin = [&] {
        made->found.clear();
        if (!there->damage.empty()) made->write_own(group_path(folder), there->text);
        if (made->exists(made->own("chunks")))
            made->check_metadata(made->found);
        else
            made->write_arrays();
        if (!there->damage.empty()) made->found.push_back({-1, "zarr.json", there->damage});
        made->self->remove_dead();
        made->refresh();
        made->check_chunks(options.check == resume_check::checksums, made->found);
        made->check_rest(options.check == resume_check::checksums, made->found);
        made->count_all(&made->found);
        made->keep_model(options.model.get(), wanted);
        made->check_arithmetic(options);
    };
    repeat_if_lost(*made->self, begin, may_write);
    made->self->remove_claims(
        [&](std::int64_t chunk) { return chunk >= 0 && chunk < made->content.chunks() && made->is_finished(chunk); });
    if (!made->found.empty()) made->check_space();
    return store(std::move(made));
}

store store::open(const std::string& given, file_system* used) {
    const std::string folder = absolute(given);
    file_system& files = used ? *used : file_system::real();
    require(names_in(files, folder).has_value(), "there is no folder ", folder, host::cure, "give that of a study");
    const std::optional<found_group> there = whole_group(files, folder);
    require(there.has_value(), host::named_option("store", "the folder"), " ", folder, " is empty", host::cure,
            "give that of a study");
    auto made = std::make_unique<implementation>(files, folder, *there);
    made->refresh();
    return store(std::move(made));
}

std::optional<layout> store::content_of(const std::string& given) {
    const std::string folder = absolute(given);
    const std::optional<found_group> there = whole_group(file_system::real(), folder);
    if (!there) return std::nullopt;
    return store_files(file_system::real(), folder, there->group).content;
}

const layout& store::content() const { return self_->content; }
const std::string& store::folder() const { return self_->folder; }

bool store::done(std::int64_t chunk) const {
    self_->check_chunk(chunk);
    return self_->is_finished(chunk);
}

bool store::written(std::string_view variable) const {
    const std::size_t v = self_->content.find(variable);
    require(self_->content.variables[v].extent == along::nothing, "variable ", variable, " is written chunk by chunk",
            host::cure, "ask whether its chunks are done");
    return self_->has_result(v);
}

bool store::complete() const {
    const std::lock_guard lock(self_->mutex);
    return self_->finished_count == self_->content.chunks();
}

void store::refresh() { self_->refresh(); }

store_progress store::progress() {
    self_->refresh();
    self_->count_all();
    const std::lock_guard lock(self_->mutex);
    store_progress now;
    now.chunks = self_->finished_count;
    now.all_chunks = self_->content.chunks();
    now.instances = self_->counted_instances;
    now.all_instances = self_->content.instances();
    now.seconds = self_->seconds;
    now.statuses.assign(self_->statuses.begin(), self_->statuses.end());
    now.damaged = std::count(self_->spoiled.begin(), self_->spoiled.end(), true);
    return now;
}

std::optional<std::int64_t> store::claim_next() {
    implementation& s = *self_;
    if (complete()) return std::nullopt;
    s.require_writable();
    const std::lock_guard lock(s.claiming);
    const std::int64_t all = s.content.chunks();
    for (std::int64_t looked = 0; looked < all; ++looked) {
        const std::int64_t chunk = s.next;
        s.next = (s.next + 1) % all;
        if (s.is_finished(chunk) || !s.self->claim(chunk)) continue;
        if (s.keep_claim(chunk)) return chunk;
        // Another process has done it since, and so probably others too.
        if (std::chrono::steady_clock::now() - s.looked > std::chrono::milliseconds(200)) {
            s.refresh();
            s.looked = std::chrono::steady_clock::now();
        } else {
            const std::lock_guard state(s.mutex);
            s.finish(chunk);
        }
    }
    s.refresh();
    s.tidy();
    return std::nullopt;
}

bool store::claim(std::int64_t chunk) {
    implementation& s = *self_;
    s.require_writable();
    s.check_chunk(chunk);
    if (s.is_finished(chunk) || !s.self->claim(chunk)) return false;
    if (s.keep_claim(chunk)) return true;
    const std::lock_guard lock(s.mutex);
    s.finish(chunk);
    return false;
}

void store::commit(std::int64_t chunk, std::span<const column> columns, const chunk_record& record) {
    implementation& s = *self_;
    s.require_writable();
    s.check_chunk(chunk);
    try {
        const std::vector<std::span<const std::byte>> ordered = s.checked(chunk, columns);
        s.compare_arithmetic(record.computed_by);
        // Another process took the chunk over and was faster: what it wrote stays.
        const bool is_first = !s.exists(s.record_path(chunk));
        bool is_done = true;
        if (is_first) {
            s.with_writer([&] { s.write_chunk(chunk, ordered, record); });
            is_done = s.self->holds(chunk) || s.is_consistent(chunk);
        }
        if (is_done) {
            const std::lock_guard lock(s.mutex);
            s.finish(chunk);
            if (is_first) s.count(chunk, record);
        }
    } catch (...) {
        s.self->release(chunk);
        throw;
    }
    s.self->release(chunk);
}

void store::release(std::int64_t chunk) {
    self_->require_writable();
    self_->check_chunk(chunk);
    self_->self->release(chunk);
}

void store::write(const column& values) {
    implementation& s = *self_;
    s.require_writable();
    const std::size_t v = s.content.find(values.variable);
    require(s.content.variables[v].extent == along::nothing, "variable ", values.variable, " is written chunk by chunk",
            host::cure, "use store::commit");
    const std::span<const std::byte> bytes = s.bytes_for(v, std::span(&values, 1), s.variables[v].shape.items());
    s.with_writer([&] { s.write_result(v, bytes); });
}

std::vector<damage> store::verify() {
    std::vector<damage> problems;
    self_->refresh();
    self_->check_metadata(problems);
    self_->check_chunks(true, problems);
    self_->check_rest(true, problems);
    return problems;
}

const std::vector<damage>& store::put_back() const { return self_->found; }
std::vector<std::string> store::warnings() const {
    const std::lock_guard lock(self_->mutex);
    return self_->warnings;
}

void store::read(std::string_view name, std::int64_t first, std::int64_t count, void* values) const {
    const implementation& s = *self_;
    const std::size_t v = s.content.find(name);
    const array_shape& shape = s.variables[v].shape;
    const along extent = s.content.variables[v].extent;
    const std::int64_t items = extent == along::nothing ? 1 : shape.items();
    require(first >= 0 && count >= 0 && first <= items - count, "variable ", name, " has ", items,
            " items, and not those from ", first, " to ", first + count);
    const std::int64_t per_file = extent == along::nothing ? 1 : shape.chunk;
    const std::int64_t item = extent == along::nothing ? shape.file_bytes() - 4 : shape.item_bytes();
    auto* to = static_cast<std::byte*>(values);
    for (std::int64_t at = first; at < first + count;) {
        const std::int64_t file = at / per_file, begin = at - file * per_file;
        const std::int64_t end = std::min(per_file, begin + first + count - at);
        const bool is_there = extent == along::nothing ? s.has_result(v) : s.is_finished(file);
        require(is_there || extent != along::nothing || !complete(), name, " is not there, though all instances of ",
                s.folder, " are done: its files were removed, or another process is about to write them", host::cure,
                "start the study again, which computes it from what is stored");
        if (!is_there)
            fill(shape.type, to, bytes_of((end - begin) * item) / size_of(shape.type));
        else if (extent == along::nothing)
            s.read_result(v, to);
        else
            s.read_chunk(v, file, begin * item, end * item, to);
        to += (end - begin) * item;
        at += end - begin;
    }
}

std::size_t store::size_for(std::string_view name, element type, std::int64_t first, std::int64_t count) const {
    const variable& v = self_->content.variables[self_->content.find(name)];
    require(v.type == type, "variable ", name, " has values of type ", name_of(v.type), ", and not ", name_of(type));
    const std::int64_t items = self_->content.items(v);
    require(first >= 0 && count >= 0 && first <= items - count, "variable ", name, " has ", items,
            " items, and not those from ", first, " to ", first + count);
    return bytes_of(count * v.values_per_item());
}

std::vector<std::string> store::devices() const {
    self_->count_all();
    const std::lock_guard lock(self_->mutex);
    return {self_->device_names.begin(), self_->device_names.end()};
}

std::vector<arithmetic> store::arithmetics() const {
    self_->count_all();
    const std::lock_guard lock(self_->mutex);
    std::vector<arithmetic> all;
    for (const auto& [key, by] : self_->computed_by) all.push_back(by);
    return all;
}

}  // namespace myriad
