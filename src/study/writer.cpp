// SPDX-License-Identifier: MIT
// Signs of life, claims, and what is left of dead processes.
#include "myriad/study/writer.hpp"

#include <cerrno>
#include <charconv>
#include <locale>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <sys/random.h>
#include <unistd.h>

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

// The start of a process in ticks since the machine's, 0 if it cannot be known, or nothing if there is no such process,
// or one that has ended and was not waited for.
std::optional<std::int64_t> start_of(std::int64_t process) {
    std::optional<std::string> text;
    try {
        text = read_text(file_system::real(), message("/proc/", process, "/stat"));
    } catch (const file_error&) {  // it ended just now, or is another user's
    }
    // "number (name) state ...": the name may have spaces and parentheses. The start is the 22nd entry.
    const std::size_t name_end = text ? text->rfind(')') : std::string::npos;
    if (name_end == std::string::npos)
        return ::kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM ? std::optional<std::int64_t>(0)
                                                                             : std::nullopt;
    std::istringstream rest(text->substr(name_end + 1));
    std::string state, skipped;
    rest >> state;
    for (int entry = 4; entry < 22; ++entry) rest >> skipped;
    if (state == "Z" || state == "X") return std::nullopt;
    std::int64_t start = 0;
    rest >> start;
    return start;
}

std::string host_name() {
    char name[256] = {};
    return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

// One run of this machine.
std::string boot_id() {
    std::string id = read_text(file_system::real(), "/proc/sys/kernel/random/boot_id").value_or("");
    while (!id.empty() && id.back() == '\n') id.pop_back();
    return id;
}

// Among whom numbers of processes mean something.
std::string process_space() {
    char space[64] = {};
    return ::readlink("/proc/self/ns/pid", space, sizeof space - 1) > 0 ? space : "";
}

// The writers of this process.
struct writer_list {
    std::mutex mutex;
    std::set<std::string> ids;
    bool has(const std::string& id) {
        const std::lock_guard lock(mutex);
        return ids.contains(id);
    }
};
writer_list& here() {
    static writer_list list;
    return list;
}

// For a name of a file, whose parts '~' separates.
std::string part_of_name(std::string text) {
    for (char& c : text) {
        const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.';
        if (!kept) c = '-';
    }
    return text.substr(0, 64);
}

std::int64_t number(const std::string& text) {
    std::int64_t value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

}  // namespace

process_identity process_identity::own() {
    std::uint64_t random = 0;
    if (::getrandom(&random, sizeof random, 0) != sizeof random)
        random = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
    return of(message(part_of_name(host_name()), '~', part_of_name(boot_id()), '~', part_of_name(process_space()), '~',
                      ::getpid(), '~', start_of(::getpid()).value_or(0), '~', random));
}

process_identity process_identity::of(std::string_view text) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == '~')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    process_identity read;
    if (parts.size() != 6) return read;
    // It is part of a path.
    for (const std::string& part : parts)
        if (part != part_of_name(part)) return read;
    read = {std::string(text), parts[0], parts[1], parts[2], number(parts[3]), number(parts[4])};
    return read;
}

bool process_identity::ended_here() const {
    if (process <= 0 || start <= 0 || boot.empty() || host != part_of_name(host_name())) return false;
    // Numbers of processes that cannot be looked up, as those of a container.
    if (space != part_of_name(process_space())) return false;
    if (boot != part_of_name(boot_id())) return true;
    if (process == ::getpid()) return !here().has(id);
    const std::optional<std::int64_t> now = start_of(process);
    return !now || (*now != 0 && *now != start);
}

writer::writer(file_system& files, std::string folder, std::chrono::milliseconds expiry)
    : files_(files), folder_(std::move(folder)), expiry_(expiry), self_(process_identity::own()), owner_(::getpid()) {
    {
        const std::lock_guard lock(here().mutex);
        here().ids.insert(self_.id);
    }
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
    const std::lock_guard lock(here().mutex);
    here().ids.erase(self_.id);
}

std::string writer::temporary() {
    const std::lock_guard lock(mutex_);
    return message(folder_, "/writers/", self_.id, '/', ++temporaries_);
}

void writer::appear() {
    const std::string own = folder_ + "/writers/" + self_.id;
    for (int attempt = 0;; ++attempt) {
        try {
            make_folder(files_, folder_ + "/writers");
            make_folder(files_, own);
            // Not durable: it says that this process runs.
            open_file alive(files_, own + "/alive", O_WRONLY | O_CREAT);
            alive.write(std::as_bytes(std::span(std::string_view(self_.id))));
            alive.close();
            return;
        } catch (const file_error& failure) {
            // Another process removed the folder while it was empty.
            if (failure.code() != ENOENT || attempt == 10) throw;
        }
    }
}

std::string writer::path_of(std::int64_t chunk) const { return message(folder_, "/claims/", chunk); }

bool writer::is_dead(const std::string& path, process_identity* who) {
    // Opened and not only looked up, since NFS then asks its server instead of its cache.
    std::string text(4096, '\0');
    file_facts facts;
    try {
        open_file alive(files_, path, O_RDONLY);
        text.resize(alive.read(std::as_writable_bytes(std::span(text))));
        facts = alive.facts();
    } catch (const file_error& failure) {
        if (failure.code() == ENOENT || failure.code() == ESTALE) return false;  // given back in the meantime
        throw;
    }
    const process_identity identity = process_identity::of(text);
    if (who != nullptr) *who = identity;
    if (identity.id == self_.id) return false;
    if (identity.ended_here()) return true;
    // The time now, by the clock that also gave the other time.
    const std::string own = folder_ + "/writers/" + self_.id + "/alive";
    if (files_.touch(own) < 0) appear();
    open_file alive(files_, own, O_RDONLY);
    return alive.facts().modified - facts.modified > std::chrono::nanoseconds(expiry_).count();
}

bool writer::take_away(const std::string& claim) {
    const std::string taken = temporary();
    if (files_.rename(claim, taken) < 0) {
        if (errno == ENOENT) return true;
        throw file_error("taking over", claim, errno);
    }
    // Between the look at it and now, another process may have taken it over and claimed it.
    if (!is_dead(taken)) {
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
    const std::string path = path_of(chunk), own = folder_ + "/writers/" + self_.id + "/alive";
    try {
        for (int attempt = 0; attempt < 10; ++attempt) {
            if (files_.link(own, path) == 0) return true;
            if (errno == ENOENT && attempt == 0) {
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

void writer::release(std::int64_t chunk) noexcept {
    try {
        const std::string path = path_of(chunk);
        const std::optional<std::string> text = read_text(files_, path);
        if (text && process_identity::of(*text).id == self_.id) files_.unlink(path);
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
        const process_identity identity = process_identity::of(id);
        if (identity.ended_here() || is_dead(folder_ + "/writers/" + id + "/alive")) remove_writer(identity.id);
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
    const std::string own = folder_ + "/writers/" + self_.id + "/alive";
    std::unique_lock lock(heartbeat_->mutex);
    while (!heartbeat_->end.wait_for(lock, expiry_ / 5, [this] { return heartbeat_->ending; })) {
        lock.unlock();
        files_.touch(own);  // if it fails, the next call that needs the file says so
        lock.lock();
    }
}

}  // namespace myriad::studies::inline MYRIAD_ABI
