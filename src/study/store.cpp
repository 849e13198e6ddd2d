// SPDX-License-Identifier: MIT
// Folders of results: made, gone on with, filled, read and verified.
#include "myriad/study/store.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>
#include <set>

#include <fcntl.h>

#include "myriad/host/core/error.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/study/crc32c.hpp"
#include "myriad/study/file_system.hpp"
#include "myriad/study/metadata.hpp"
#include "myriad/study/writer.hpp"

namespace myriad {

namespace studies::inline MYRIAD_ABI {

// An array of a store, in a folder of its name.
struct stored_array {
    std::string name;
    array_shape shape;
    std::vector<attribute> attributes;
};

}  // namespace studies::inline MYRIAD_ABI

using namespace studies;

static_assert(std::endian::native == std::endian::little, "stores hold little-endian numbers as they are in memory");

namespace {

constexpr std::size_t most_open = 8;                   // files of a chunk, since each thread of each device has one
constexpr std::int64_t piece = std::int64_t{1} << 20;  // stays in a core's cache between its checksum and its copy

std::size_t bytes_of(std::int64_t count) { return static_cast<std::size_t>(count); }

// What reading a file showed: its checksum, and what is wrong with it, if anything.
struct file_check {
    std::uint32_t checksum = 0;
    std::string damage;
};

// Reads a file of an array as a whole, since its checksum is about the whole, and copies the bytes from `begin` to
// `end`.
file_check read_array_file(file_system& files, const std::string& path, const array_shape& shape, std::int64_t begin,
                           std::int64_t end, std::byte* to) {
    const std::int64_t size = shape.file_bytes() - 4;
    file_check check;
    std::vector<std::byte> scratch(bytes_of(std::min(size, piece)));
    try {
        open_file file(files, path, O_RDONLY);
        for (std::int64_t at = 0; at < size;) {
            const bool wanted = begin <= at && at < end;
            const std::int64_t until = at < begin ? begin : at < end ? end : size;
            const std::int64_t part = std::min(until - at, piece);
            const std::span<std::byte> into(wanted ? to + (at - begin) : scratch.data(), bytes_of(part));
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
        if (failure.code() != ENOENT) throw;
        check.damage = "it is missing";
    }
    return check;
}

constexpr const char* repair_advice =
    "): start the study again with the option check set to checksums, which reads all that is stored and does what is "
    "damaged once more";

// Writes a file of an array, filled up to its full length, to a temporary place.
new_file write_array_file(file_system& files, const std::string& temporary, const array_shape& shape,
                          std::span<const std::byte> bytes, std::uint32_t& checksum) {
    new_file file(files, temporary);
    checksum = 0;
    const auto put = [&](std::span<const std::byte> part) {
        checksum = crc32c(part, checksum);
        file.write(part);
    };
    for (std::size_t at = 0; at < bytes.size(); at += bytes_of(piece))
        put(bytes.subspan(at, std::min(bytes_of(piece), bytes.size() - at)));
    std::int64_t missing = shape.file_bytes() - 4 - static_cast<std::int64_t>(bytes.size());
    if (missing > 0) {
        std::vector<std::byte> filler(bytes_of(std::min(missing, piece)));
        fill(shape.type, filler.data(), filler.size() / size_of(shape.type));
        for (; missing > 0; missing -= piece) put(std::span(filler).first(bytes_of(std::min(missing, piece))));
    }
    file.write(std::as_bytes(std::span(&checksum, 1)));
    return file;
}

// Items [first, first + count) of a coordinate's array.
void read_coordinate(file_system& files, const std::string& folder, const stored_array& array, std::int64_t first,
                     std::span<double> values) {
    const auto count = static_cast<std::int64_t>(values.size());
    require(first >= 0 && first <= array.shape.items() - count, "coordinate ", array.name, " has ", array.shape.items(),
            " values, and not those from ", first, " to ", first + count);
    for (std::int64_t at = first; at < first + count;) {
        const std::int64_t file = at / array.shape.chunk, begin = at - file * array.shape.chunk;
        const std::int64_t end = std::min(array.shape.chunk, begin + first + count - at);
        const std::string path = folder + '/' + array.name + '/' + array.shape.file_name(file);
        const file_check check = read_array_file(files, path, array.shape, begin * 8, end * 8,
                                                 reinterpret_cast<std::byte*>(values.data() + (at - first)));
        require(check.damage.empty(), path, " is damaged (", check.damage, repair_advice);
        at += end - begin;
    }
}

// Where it is also after the process has gone to another folder.
std::string absolute(const std::string& folder) {
    require(!folder.empty(), "the folder of a study has no name: give one");
    std::error_code unknown;
    const std::filesystem::path path = std::filesystem::absolute(folder, unknown);
    return unknown ? folder : path.string();
}

// The layout of a folder with a store, or nothing if there is none yet. An error if there is something else.
std::optional<layout> stored_layout(file_system& files, const std::string& folder) {
    const std::string path = folder + "/zarr.json";
    // In this order, since another process may be about to make one.
    std::vector<std::string> names = names_in(files, folder).value_or(std::vector<std::string>{});
    if (const std::optional<std::string> text = read_text(files, path)) return layout_of(*text, path);
    // A start that was interrupted early leaves this.
    std::erase(names, "myriad");
    if (names.empty()) return std::nullopt;
    std::sort(names.begin(), names.end());
    host::refuse({"the folder ", folder, " is not empty and holds no study (it has ", names.front(),
                  names.size() > 1 ? " and others" : "", "): give a new folder"});
}

void refuse_other(const layout& stored, const layout& here, const std::string& folder) {
    const std::vector<std::string> found = differences(stored, here);
    if (found.empty()) return;
    std::string text;
    for (std::size_t i = 0; i < found.size() && i < 10; ++i) text += "\n  " + found[i];
    if (found.size() > 10) text += message("\n  and ", found.size() - 10, " more");
    host::refuse({"the folder ", folder, " holds the results of another study, which differs in", text,
                  "\ngive another folder, or the same study"});
}

}  // namespace

struct store::implementation {
    file_system& files;
    std::string folder;
    layout content;
    std::vector<stored_array> variables, coordinates;
    std::vector<coordinate> given;  // coordinates to write, only of a store that can be written
    std::unique_ptr<writer> self;   // null if opened for reading

    mutable std::mutex mutex;  // of all that follows
    std::vector<bool> finished, counted;
    std::int64_t finished_count = 0, counted_instances = 0;
    std::map<std::string, std::int64_t> statuses;
    std::set<std::string> device_names;
    double seconds = 0.0;
    std::vector<std::int64_t> committed;  // by this process, since the last look at the folder began
    std::vector<damage> found;

    std::mutex claiming;  // of what follows
    std::int64_t next = 0;
    std::chrono::steady_clock::time_point looked;

    implementation(file_system& used, std::string where, layout stored)
        : files(used), folder(std::move(where)), content(std::move(stored)) {
        for (const variable& v : content.variables) variables.push_back({v.name, shape_of(content, v), v.attributes});
        for (coordinate& c : content.coordinates) {
            coordinates.push_back({c.name, shape_of(content, c), c.attributes});
            c.values = [&f = files, place = folder, array = coordinates.back()](std::int64_t first,
                                                                                std::span<double> values) {
                read_coordinate(f, place, array, first, values);
            };
        }
        finished.assign(bytes_of(content.chunks()), false);
        counted = finished;
    }

    std::string own(std::string_view name) const { return message(folder, "/myriad/", name); }
    std::string record_path(std::int64_t chunk) const { return message(folder, "/myriad/chunks/", chunk, ".json"); }
    std::string path_of(const stored_array& array, std::int64_t file) const {
        return folder + '/' + array.name + '/' + array.shape.file_name(file);
    }

    void check_chunk(std::int64_t chunk) const { range_of(content, chunk); }
    bool is_finished(std::int64_t chunk) const {
        const std::lock_guard lock(mutex);
        return finished[bytes_of(chunk)];
    }
    void require_writable() const {
        require(self != nullptr, "the store ", folder, " was opened for reading: use store::create_or_resume");
    }

    // -----------------------------------------------------------------------------------------------------------------
    // Making
    // -----------------------------------------------------------------------------------------------------------------

    void write_coordinate_file(std::size_t c, std::int64_t file) {
        const array_shape& shape = coordinates[c].shape;
        const std::int64_t first = file * shape.chunk;
        std::vector<double> values(bytes_of(std::min(shape.chunk, shape.items() - first)));
        given[c].values(first, values);
        std::uint32_t checksum = 0;
        new_file made = write_array_file(files, self->temporary(), shape, std::as_bytes(std::span(values)), checksum);
        made.finish();
        made.rename_to(path_of(coordinates[c], file));
    }

    void begin_array(const stored_array& array) {
        const std::string place = folder + '/' + array.name;
        make_folder(files, place);
        write_text(files, self->temporary(), place + "/zarr.json", array_json(array.shape, array.attributes));
    }

    // Everything but results. May be done by several processes at a time, with equal files.
    void write_arrays() {
        for (const stored_array& array : variables) begin_array(array);
        for (std::size_t c = 0; c < coordinates.size(); ++c) {
            begin_array(coordinates[c]);
            for (std::int64_t file = 0; file < coordinates[c].shape.files(); ++file) write_coordinate_file(c, file);
            sync_folder(files, folder + '/' + coordinates[c].name);
        }
        // A group of its own, so that readers which look at every folder know what it is.
        write_text(files, self->temporary(), own("zarr.json"), "{\"zarr_format\": 3, \"node_type\": \"group\"}\n");
        make_folder(files, own("claims"));
        sync_folder(files, folder);
        // The last, as the sign that all this is there.
        make_folder(files, own("chunks"));
        sync_folder(files, own(""));
    }

    // The folders that someone removed; `check_chunks` and `check_rest` find what is missing in them.
    void restore_arrays() {
        const auto restore = [&](const std::vector<stored_array>& arrays) {
            for (const stored_array& array : arrays)
                if (!exists(folder + '/' + array.name + "/zarr.json")) begin_array(array);
        };
        restore(variables);
        restore(coordinates);
        make_folder(files, own("claims"));
    }

    bool exists(const std::string& path) const {
        std::int64_t size = 0;
        if (files.size(path, size) == 0) return true;
        if (errno == ENOENT) return false;
        throw file_error("looking for", path, errno);
    }
    bool has_length(const std::string& path, std::int64_t length) const {
        std::int64_t size = 0;
        if (files.size(path, size) == 0) return size == length;
        if (errno == ENOENT) return false;
        throw file_error("looking for", path, errno);
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
        seconds = 0.0;
    }

    void count(std::int64_t chunk, const chunk_record& record) {
        if (counted[bytes_of(chunk)]) return;
        counted[bytes_of(chunk)] = true;
        counted_instances += range_of(content, chunk).count;
        for (const auto& [name, number] : record.statuses) statuses[name] += number;
        if (!record.device.empty()) device_names.insert(record.device);
        seconds += record.seconds;
    }

    // Reads the records that were not read yet.
    void count_all() {
        std::vector<std::int64_t> missing;
        {
            const std::lock_guard lock(mutex);
            for (std::size_t i = 0; i < finished.size(); ++i)
                if (finished[i] && !counted[i]) missing.push_back(static_cast<std::int64_t>(i));
        }
        for (const std::int64_t chunk : missing) {
            const std::optional<std::string> text = read_text(files, record_path(chunk));
            chunk_record record;
            bool good = text.has_value();
            try {
                if (good) record = record_of(*text, content, chunk).record;
            } catch (const error&) {
                good = false;
            }
            if (!good) {
                put_back(chunk);
                continue;
            }
            const std::lock_guard lock(mutex);
            count(chunk, record);
        }
    }

    void put_back(std::int64_t chunk) {
        if (self && files.unlink(record_path(chunk)) < 0 && errno != ENOENT)
            throw file_error("removing", record_path(chunk), errno);
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
            std::optional<stored_chunk> record;
            if (checksums) {
                try {
                    if (const auto text = read_text(files, record_path(chunk)))
                        record = record_of(*text, content, chunk);
                    else
                        problems.push_back({chunk, "", "its record is missing"});
                } catch (const file_error&) {
                    throw;
                } catch (const error& failure) {
                    problems.push_back({chunk, "", failure.what()});
                }
            }
            std::size_t place = 0;
            for (std::size_t v = 0; v < variables.size(); ++v) {
                if (content.variables[v].extent == along::nothing) continue;
                const std::string path = path_of(variables[v], chunk);
                file_check check;
                if (!has_length(path, variables[v].shape.file_bytes())) {
                    check.damage = exists(path) ? "it has not the length it should have" : "it is missing";
                } else if (record) {
                    check = read_array_file(files, path, variables[v].shape, 0, 0, nullptr);
                    const std::uint32_t expected = record->checksums[place];
                    if (check.damage.empty() && check.checksum != expected)
                        check.damage = "its checksum is " + hexadecimal(check.checksum) + ", and " +
                                       hexadecimal(expected) + " in the record";
                }
                if (!check.damage.empty()) problems.push_back({chunk, variables[v].name, check.damage});
                ++place;
            }
            if (problems.size() > before) put_back(chunk);
        }
        if (self && !problems.empty()) sync_folder(files, own("chunks"));
    }

    void check_rest(bool checksums, std::vector<damage>& problems) {
        const auto damage_of = [&](const stored_array& array, std::int64_t file) -> std::string {
            const std::string path = path_of(array, file);
            if (!has_length(path, array.shape.file_bytes()))
                return exists(path) ? "it has not the length it should have" : "it is missing";
            return checksums ? read_array_file(files, path, array.shape, 0, 0, nullptr).damage : "";
        };
        for (std::size_t c = 0; c < coordinates.size(); ++c) {
            bool anew = false;
            for (std::int64_t file = 0; file < coordinates[c].shape.files(); ++file) {
                const std::string reason = damage_of(coordinates[c], file);
                if (reason.empty()) continue;
                problems.push_back({-1, coordinates[c].name, reason});
                if (self) write_coordinate_file(c, file);
                anew = true;
            }
            if (self && anew) sync_folder(files, folder + '/' + coordinates[c].name);
        }
        for (std::size_t v = 0; v < variables.size(); ++v) {
            if (content.variables[v].extent != along::nothing || !exists(path_of(variables[v], 0))) continue;
            const std::string reason = damage_of(variables[v], 0);
            if (reason.empty()) continue;
            problems.push_back({-1, variables[v].name, reason});
            if (self) files.unlink(path_of(variables[v], 0));
        }
    }

    // Before anything is written, and again when chunks were put back.
    void check_space() const {
        std::int64_t left = 0, free = 0;
        const auto add = [&](std::int64_t file_bytes, std::int64_t count) {
            std::int64_t bytes = 0;
            if (__builtin_mul_overflow((file_bytes + 4095) / 4096 * 4096, count, &bytes) ||
                __builtin_add_overflow(left, bytes, &left))
                left = std::numeric_limits<std::int64_t>::max();
        };
        bool coordinates_left = false;
        for (const stored_array& array : coordinates)
            for (std::int64_t file = 0; file < array.shape.files(); ++file) {
                if (has_length(path_of(array, file), array.shape.file_bytes())) continue;
                add(array.shape.file_bytes(), 1);
                coordinates_left = true;
            }
        const std::int64_t missing = content.chunks() - finished_count;
        for (std::size_t v = 0; v < variables.size(); ++v) {
            if (content.variables[v].extent != along::nothing)
                add(variables[v].shape.file_bytes(), missing);
            else if (!exists(path_of(variables[v], 0)))
                add(variables[v].shape.file_bytes(), 1);
        }
        add(1, missing);  // their records, of a block each
        if (files.free_bytes(folder, free) < 0) throw file_error("asking for the free space of", folder, errno);
        const auto [need, have] = host::bytes_texts(static_cast<double>(left), static_cast<double>(free));
        require(left <= free, "the ", missing, " chunks ", coordinates_left ? "and the coordinates " : "",
                "that are left take ", need, ", and the disk of ", folder, " has ", have,
                " free: free space, give a folder on a larger disk, or keep less");
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
                require(content.variables[v].extent != along::nothing, "variable ", c.variable,
                        " is not of a chunk: use store::write");
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
        write_text(files, self->temporary(), record_path(chunk), record_json(content, chunk, stored));
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

    // Once more if another process took this one for dead and removed its folder.
    template <class F>
    void with_writer(F write) {
        try {
            write();
        } catch (const file_error& failure) {
            if (failure.code() != ENOENT) throw;
            self->appear();
            write();
        }
    }
};

store::store(std::unique_ptr<implementation> made) : self_(std::move(made)) {}
store::store(store&& other) noexcept = default;
store& store::operator=(store&& other) noexcept = default;
store::~store() = default;

store store::create_or_resume(const std::string& given, const layout& wanted, const store_options& options) {
    wanted.check();
    const std::string folder = absolute(given);
    require(options.expiry.count() > 0, "the expiry of claims is ", options.expiry.count(),
            " ms (must be positive): give seconds to minutes");
    file_system& files = options.files ? *options.files : file_system::real();
    make_folders(files, folder);
    std::optional<layout> stored = stored_layout(files, folder);
    if (stored) refuse_other(*stored, wanted, folder);

    layout content = wanted;
    if (stored) content.chunk = stored->chunk;
    {
        implementation before(files, folder, content);
        before.refresh();
        before.check_space();
    }
    make_folder(files, folder + "/myriad");
    auto self = std::make_unique<writer>(files, folder + "/myriad", options.expiry);
    if (!stored) {
        new_file group(files, self->temporary());
        group.write(group_json(wanted));
        group.finish();
        if (group.link_to(folder + "/zarr.json")) {
            stored = wanted;
        } else {  // another process was faster
            stored = stored_layout(files, folder);
            require(stored.has_value(), "the folder ", folder, " was removed while a study started there");
            refuse_other(*stored, wanted, folder);
        }
        sync_folder(files, folder);
    }
    content.chunk = stored->chunk;
    auto made = std::make_unique<implementation>(files, folder, content);
    made->self = std::move(self);
    made->given = wanted.coordinates;
    if (made->exists(made->own("chunks")))
        made->restore_arrays();
    else
        made->write_arrays();
    made->self->remove_dead();
    made->refresh();
    made->check_chunks(options.check == resume_check::checksums, made->found);
    made->check_rest(options.check == resume_check::checksums, made->found);
    if (!made->found.empty()) made->check_space();
    return store(std::move(made));
}

store store::open(const std::string& given, file_system* used) {
    const std::string folder = absolute(given);
    file_system& files = used ? *used : file_system::real();
    require(names_in(files, folder).has_value(), "there is no folder ", folder, ": give that of a study");
    std::optional<layout> stored = stored_layout(files, folder);
    require(stored.has_value(), "the folder ", folder, " is empty: give that of a study");
    auto made = std::make_unique<implementation>(files, folder, std::move(*stored));
    made->refresh();
    return store(std::move(made));
}

std::optional<layout> store::content_of(const std::string& given) {
    const std::string folder = absolute(given);
    std::optional<layout> stored = stored_layout(file_system::real(), folder);
    if (!stored) return stored;
    return implementation(file_system::real(), folder, std::move(*stored)).content;
}

const layout& store::content() const { return self_->content; }
const std::string& store::folder() const { return self_->folder; }

bool store::done(std::int64_t chunk) const {
    self_->check_chunk(chunk);
    return self_->is_finished(chunk);
}

bool store::written(std::string_view variable) const {
    const std::size_t v = self_->content.find(variable);
    require(self_->content.variables[v].extent == along::nothing, "variable ", variable,
            " is written chunk by chunk: ask whether its chunks are done");
    return self_->has_length(self_->path_of(self_->variables[v], 0), self_->variables[v].shape.file_bytes());
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
    return now;
}

std::optional<std::int64_t> store::claim_next() {
    implementation& s = *self_;
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
        // Another process took the chunk over and was faster: what it wrote stays.
        const bool is_first = !s.exists(s.record_path(chunk));
        if (is_first) s.with_writer([&] { s.write_chunk(chunk, ordered, record); });
        const std::lock_guard lock(s.mutex);
        s.finish(chunk);
        if (is_first) s.count(chunk, record);
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
    require(s.content.variables[v].extent == along::nothing, "variable ", values.variable,
            " is written chunk by chunk: use store::commit");
    const std::span<const std::byte> bytes = s.bytes_for(v, std::span(&values, 1), s.variables[v].shape.items());
    s.with_writer([&] {
        std::uint32_t checksum = 0;
        new_file made = write_array_file(s.files, s.self->temporary(), s.variables[v].shape, bytes, checksum);
        made.finish();
        made.rename_to(s.path_of(s.variables[v], 0));
        sync_folder(s.files, s.folder + '/' + s.variables[v].name);
    });
}

std::vector<damage> store::verify() {
    std::vector<damage> problems;
    self_->refresh();
    self_->check_chunks(true, problems);
    self_->check_rest(true, problems);
    return problems;
}

const std::vector<damage>& store::put_back() const { return self_->found; }

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
        const bool there = extent == along::nothing ? written(name) : s.is_finished(file);
        if (there) {
            const std::string path = s.path_of(s.variables[v], file);
            const file_check check = read_array_file(s.files, path, shape, begin * item, end * item, to);
            require(check.damage.empty(), path, " is damaged (", check.damage, repair_advice);
        } else {
            fill(shape.type, to, bytes_of((end - begin) * item) / size_of(shape.type));
        }
        to += (end - begin) * item;
        at += end - begin;
    }
}

std::size_t store::size_for(std::string_view name, element type, std::int64_t first, std::int64_t count) const {
    const variable& v = self_->content.variables[self_->content.find(name)];
    require(v.type == type, "variable ", name, " has values of type ", name_of(v.type), ", and not ", name_of(type));
    const std::int64_t items = v.extent == along::nothing  ? 1
                               : v.extent == along::chunks ? self_->content.chunks()
                                                           : self_->content.instances();
    require(first >= 0 && count >= 0 && first <= items - count, "variable ", name, " has ", items,
            " items, and not those from ", first, " to ", first + count);
    return bytes_of(count * v.values_per_item());
}

std::vector<std::string> store::devices() const {
    self_->count_all();
    const std::lock_guard lock(self_->mutex);
    return {self_->device_names.begin(), self_->device_names.end()};
}

}  // namespace myriad
