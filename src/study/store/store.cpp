// SPDX-License-Identifier: MIT
// Folders of results: made, gone on with, filled, read and verified.
#include "myriad/study/store/store.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <mutex>
#include <thread>

#include "columns.hpp"
#include "disk_space.hpp"
#include "found_group.hpp"
#include "inspected_files.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/study/store/records.hpp"

namespace myriad {

using namespace studies;

static_assert(std::endian::native == std::endian::little, "stores hold little-endian numbers as they are in memory");

namespace {

constexpr std::size_t most_open = 8;  // files of a chunk, since each thread of each device has one

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

struct store::implementation : inspected_files {
    std::vector<damage> found;

    std::mutex claiming;  // of what follows
    std::int64_t next = 0;
    std::chrono::steady_clock::time_point looked, tidied;
    std::chrono::milliseconds expiry{};

    implementation(file_system& used, std::string where, const found_group& of)
        : inspected_files(used, std::move(where), of) {}

    void require_chunk(std::int64_t chunk) const { range_of(content, chunk); }
    void require_writable() const {
        require(self != nullptr, "the store ", folder, " was opened for reading", host::cure,
                "use store::create_or_resume");
    }
    // The place of a variable with one value for the whole study.
    std::size_t result_place(std::string_view variable, const char* advice) const {
        const std::size_t v = content.find(variable);
        require(content.variables[v].extent == along::nothing, "variable ", variable, " is written chunk by chunk",
                host::cure, advice);
        return v;
    }
    void require_items(std::string_view variable, std::int64_t items, std::int64_t first, std::int64_t count) const {
        require(first >= 0 && count >= 0 && first <= items - count, "variable ", variable, " has ", items,
                " items, and not those from ", first, " to ", first + count);
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
    made->check_arithmetic(options, made->ledger.complete());
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
            [&] { is_first = write_first(files, made->self->temporary(), group_path(folder), there->text); },
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
        made->check_arithmetic(options, made->ledger.complete());
    };
    repeat_if_lost(*made->self, begin, may_write);
    made->self->remove_claims([&](std::int64_t chunk) {
        return chunk >= 0 && chunk < made->content.chunks() && made->ledger.is_finished(chunk);
    });
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
    self_->require_chunk(chunk);
    return self_->ledger.is_finished(chunk);
}

bool store::written(std::string_view variable) const {
    return self_->has_result(self_->result_place(variable, "ask whether its chunks are done"));
}

bool store::complete() const { return self_->ledger.complete(); }

void store::refresh() { self_->refresh(); }

store_progress store::progress() {
    self_->refresh();
    self_->count_all();
    return self_->ledger.progress();
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
        if (s.ledger.is_finished(chunk) || !s.self->claim(chunk)) continue;
        if (s.keep_claim(chunk)) return chunk;
        // Another process has done it since, and so probably others too.
        if (std::chrono::steady_clock::now() - s.looked > std::chrono::milliseconds(200)) {
            s.refresh();
            s.looked = std::chrono::steady_clock::now();
        } else {
            s.ledger.finish(chunk);
        }
    }
    s.refresh();
    s.tidy();
    return std::nullopt;
}

bool store::claim(std::int64_t chunk) {
    implementation& s = *self_;
    s.require_writable();
    s.require_chunk(chunk);
    if (s.ledger.is_finished(chunk) || !s.self->claim(chunk)) return false;
    if (s.keep_claim(chunk)) return true;
    s.ledger.finish(chunk);
    return false;
}

void store::commit(std::int64_t chunk, std::span<const column> columns, const chunk_record& record) {
    implementation& s = *self_;
    s.require_writable();
    s.require_chunk(chunk);
    try {
        const std::vector<std::span<const std::byte>> ordered = ordered_columns(s.content, chunk, columns);
        s.compare_arithmetic(record.computed_by);
        // Another process took the chunk over and was faster: what it wrote stays.
        const bool is_first = !s.exists(s.record_path(chunk));
        bool is_done = true;
        if (is_first) {
            s.with_writer([&] { s.write_chunk(chunk, ordered, record); });
            is_done = s.self->holds(chunk) || s.is_consistent(chunk);
        }
        if (is_done) s.ledger.finish(chunk, is_first ? &record : nullptr);
    } catch (...) {
        s.self->release(chunk);
        throw;
    }
    s.self->release(chunk);
}

void store::release(std::int64_t chunk) {
    self_->require_writable();
    self_->require_chunk(chunk);
    self_->self->release(chunk);
}

void store::write(const column& values) {
    implementation& s = *self_;
    s.require_writable();
    const std::size_t v = s.result_place(values.variable, "use store::commit");
    const std::span<const std::byte> bytes = bytes_for(s.content.variables[v], std::span(&values, 1), 1);
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
std::vector<std::string> store::warnings() const { return self_->warnings(); }

void store::read(std::string_view name, std::int64_t first, std::int64_t count, void* values) const {
    const implementation& s = *self_;
    const std::size_t v = s.content.find(name);
    const array_shape& shape = s.variables[v].shape;
    const along extent = s.content.variables[v].extent;
    const std::int64_t items = extent == along::nothing ? 1 : shape.items();
    s.require_items(name, items, first, count);
    const std::int64_t per_file = extent == along::nothing ? 1 : shape.chunk;
    const std::int64_t item = extent == along::nothing ? shape.file_bytes() - 4 : shape.item_bytes();
    auto* to = static_cast<std::byte*>(values);
    for (std::int64_t at = first; at < first + count;) {
        const std::int64_t file = at / per_file, begin = at - file * per_file;
        const std::int64_t end = std::min(per_file, begin + first + count - at);
        const bool is_there = extent == along::nothing ? s.has_result(v) : s.ledger.is_finished(file);
        require(is_there || extent != along::nothing || !complete(), name, " is not there, though all instances of ",
                s.folder, " are done: its files were removed, or another process is about to write them", host::cure,
                "start the study again, which computes it from what is stored");
        if (!is_there)
            fill(shape.type, to, static_cast<std::size_t>((end - begin) * item) / size_of(shape.type));
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
    self_->require_items(name, self_->content.items(v), first, count);
    return static_cast<std::size_t>(count * v.values_per_item());
}

std::vector<std::string> store::devices() const {
    self_->count_all();
    return self_->ledger.devices();
}

std::vector<arithmetic> store::arithmetics() const {
    self_->count_all();
    return self_->ledger.arithmetics();
}

}  // namespace myriad
