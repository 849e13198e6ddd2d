// SPDX-License-Identifier: MIT
// Signs of life, claims, and what is left of dead processes.
#include "myriad/study/store/writer.hpp"

#include <cerrno>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace myriad::studies::inline MYRIAD_ABI {

writer::writer(file_system& files, std::string folder, std::chrono::milliseconds expiry)
    : files_(files), folder_(std::move(folder)), expiry_(expiry), self_(process_identity::own(files, folder_)),
      others_(expiry), owner_(::getpid()) {
    add_own_writer(self_.id);
    try {
        appear();
    } catch (...) {
        leave();
        throw;
    }
    heartbeat_ = std::make_unique<heartbeat>();
    heartbeat_->thread = std::thread([this] { stay_alive(); });
}

writer::~writer() {
    if (owner_ != ::getpid()) {  // forked: there is no such thread here, and the rest is another process'
        static_cast<void>(heartbeat_.release());
        return;
    }
    {
        const std::lock_guard lock(heartbeat_->mutex);
        heartbeat_->ending = true;
    }
    heartbeat_->end.notify_all();
    heartbeat_->thread.join();
    const std::set<std::int64_t> held = std::exchange(held_, {});
    for (const std::int64_t chunk : held) release(chunk);
    leave();
}

void writer::leave() noexcept {
    remove_writer(self_.id);
    remove_own_writer(self_.id);
}

std::string writer::temporary() {
    const std::lock_guard lock(mutex_);
    return message(folder_, "/writers/", self_.id, '/', ++temporaries_);
}

void writer::appear() {
    for (int attempt = 0;; ++attempt) {
        try {
            make_folder(files_, folder_ + "/claims");
            make_folder(files_, folder_ + "/writers");
            make_folder(files_, folder_ + "/writers/" + self_.id);
            // Not durable: it says that this process runs.
            open_file file(files_, alive(), O_WRONLY | O_CREAT);
            file.write(std::as_bytes(std::span(std::string_view(self_.id))));
            file.close();
            return;
        } catch (const file_error& failure) {
            // Another process removed the folder while it was empty.
            if (failure.code() != ENOENT || attempt == 10) throw;
        }
    }
}

std::string writer::path_of(std::int64_t chunk) const { return message(folder_, "/claims/", chunk); }
std::string writer::alive() const { return folder_ + "/writers/" + self_.id + "/alive"; }

bool writer::is_dead(const std::string& path, process_identity* who, const std::string& was) {
    // Opened and not only looked up, since NFS then asks its server instead of its cache.
    std::string text(4096, '\0');
    file_facts facts;
    try {
        open_file file(files_, path, O_RDONLY);
        text.resize(file.read(std::as_writable_bytes(std::span(text))));
        facts = file.facts();
    } catch (const file_error& failure) {
        if (failure.code() == ENOENT || failure.code() == ESTALE) return false;  // given back in the meantime
        throw;
    }
    const process_identity other = process_identity::of(text);
    if (who != nullptr) *who = other;
    if (other.id == self_.id) return false;
    const process_state state = self_.state_of(other);
    if (state != process_state::unknown) return state == process_state::ended;
    // Each path for itself: in a copied folder the claims are no more links to the sign of life, and differ in times.
    return others_.is_silent(message(other.id, ' ', was.empty() ? path : was), facts.modified);
}

bool writer::take_away(const std::string& claim) {
    const std::string taken = temporary();
    if (files_.rename(claim, taken) < 0) {
        if (errno == ENOENT) return true;
        throw file_error("taking over", claim, errno);
    }
    // Between the look at it and now, another process may have taken it over and claimed it.
    if (!is_dead(taken, nullptr, claim)) {
        files_.link(taken, claim);
        files_.unlink(taken);
        return false;
    }
    files_.unlink(taken);
    return true;
}

bool writer::claim(std::int64_t chunk) {
    {
        const std::lock_guard lock(mutex_);
        if (!held_.insert(chunk).second) return false;
    }
    const std::string path = path_of(chunk);
    try {
        for (int attempt = 0; attempt < 10; ++attempt) {
            if (files_.link(alive(), path) == 0) return true;
            if (errno == ENOENT) {  // taken for dead by another process, perhaps more than once
                appear();
                continue;
            }
            if (errno != EEXIST) throw file_error("claiming a chunk by the link", path, errno);
            process_identity holder;
            if (!is_dead(path, &holder)) {
                // A server that lost its answer was asked twice.
                if (holder.id == self_.id) return true;
                break;
            }
            if (!take_away(path)) break;
            remove_writer(holder.id);
        }
    } catch (...) {
        const std::lock_guard lock(mutex_);
        held_.erase(chunk);
        throw;
    }
    const std::lock_guard lock(mutex_);
    held_.erase(chunk);
    return false;
}

bool writer::holds(std::int64_t chunk) const {
    const std::optional<std::string> text = read_text(files_, path_of(chunk));
    return text && process_identity::of(*text).id == self_.id;
}

void writer::release(std::int64_t chunk) noexcept {
    try {
        if (holds(chunk)) files_.unlink(path_of(chunk));
    } catch (const error&) {
    }
    const std::lock_guard lock(mutex_);
    held_.erase(chunk);
}

void writer::remove_dead() {
    for (const std::string& name : names_in(files_, folder_ + "/claims").value_or(std::vector<std::string>{})) {
        const std::string path = folder_ + "/claims/" + name;
        if (is_dead(path)) take_away(path);
    }
    for (const std::string& id : names_in(files_, folder_ + "/writers").value_or(std::vector<std::string>{})) {
        if (id == self_.id) continue;
        const process_identity other = process_identity::of(id);
        const bool has_ended = self_.state_of(other) == process_state::ended;
        if (has_ended || is_dead(folder_ + "/writers/" + id + "/alive")) remove_writer(other.id);
    }
}

void writer::remove_claims(const std::function<bool(std::int64_t chunk)>& is_done) {
    for (const std::string& name : names_in(files_, folder_ + "/claims").value_or(std::vector<std::string>{})) {
        const std::optional<std::int64_t> chunk = number_in(name);
        if (chunk && is_done(*chunk)) files_.unlink(path_of(*chunk));
    }
}

void writer::remove_writer(const std::string& id) noexcept {
    if (id.empty()) return;
    try {
        const std::string folder = folder_ + "/writers/" + id;
        // The sign of life last, since nobody looks for the rest without it.
        for (const std::string& name : names_in(files_, folder).value_or(std::vector<std::string>{}))
            if (name != "alive") files_.unlink(folder + '/' + name);
        files_.unlink(folder + "/alive");
        files_.rmdir(folder);
    } catch (const error&) {
    }
}

void writer::stay_alive() {
    std::unique_lock lock(heartbeat_->mutex);
    while (!heartbeat_->end.wait_for(lock, expiry_ / 5, [this] { return heartbeat_->ending; })) {
        lock.unlock();
        try {
            if (files_.touch(alive()) < 0 && errno == ENOENT) appear();
        } catch (const file_error&) {  // the next call that needs the file says so
        }
        lock.lock();
    }
}

}  // namespace myriad::studies::inline MYRIAD_ABI
