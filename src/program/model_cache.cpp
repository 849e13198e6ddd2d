// SPDX-License-Identifier: MIT
// The folder of compiled models, its files and locks. Python's cache (python/myriad/cache.py) has the same rules.
#include "program/model_cache.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "myriad/host/core/error.hpp"
#include "myriad/study/crc32c.hpp"
#include "program/model_source.hpp"

namespace myriad::programs {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view work_mark = ".work.";

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr ? value : "";
}

/// The user's folder; empty if none is known.
fs::path chosen_folder() {
    if (const std::string chosen = variable("MYRIAD_CACHE_DIR"); !chosen.empty()) return chosen;
    if (const std::string caches = variable("XDG_CACHE_HOME"); !caches.empty()) return fs::path(caches) / "myriad";
    const std::string home = variable("HOME");
    return home.empty() ? fs::path() : fs::path(home) / ".cache" / "myriad";
}

bool is_own(const struct stat& is) { return is.st_uid == ::geteuid() || is.st_uid == 0; }

/// Why something is not trusted; empty if it is.
std::string objection_to(const struct stat& is) {
    if (!is_own(is)) return message("it belongs to another user, of number ", is.st_uid);
    if ((is.st_mode & (S_IWGRP | S_IWOTH)) == 0) return "";
    char mode[8] = {};
    std::to_chars(mode, mode + sizeof mode, is.st_mode & 0777, 8);
    return message("others may write to it (mode ", mode, ")");
}

/// Makes a folder and those that it is in, for this user alone whatever the umask is.
bool make_folders(const fs::path& path) {
    if (::mkdir(path.c_str(), 0700) == 0 || errno == EEXIST) return true;
    const fs::path parent = path.parent_path();
    if (errno != ENOENT || parent.empty() || parent == path || !make_folders(parent)) return false;
    return ::mkdir(path.c_str(), 0700) == 0 || errno == EEXIST;
}

std::string contents_of(int file) {
    std::string text;
    char part[65536];
    for (off_t at = 0;;) {
        const ssize_t got = ::pread(file, part, sizeof part, at);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return text;
        text.append(part, static_cast<std::size_t>(got));
        at += got;
    }
}
bool append_to(int file, std::string_view text) {
    while (!text.empty()) {
        const ssize_t put = ::write(file, text.data(), text.size());
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(put));
    }
    return true;
}

// Behind a shared object there is the text that it was made from and a checksum of everything, by which damage is
// noticed before the system loads it. Loaders do not look at it.
std::uint32_t checksum(std::string_view text) { return studies::crc32c(std::as_bytes(std::span(text))); }

bool is_whole(const std::string& whole, std::string_view made_from) {
    std::uint64_t size = 0;
    std::uint32_t sum = 0;
    if (whole.size() < made_from.size() + sizeof size + sizeof sum) return false;
    std::memcpy(&sum, whole.data() + whole.size() - sizeof sum, sizeof sum);
    const std::string_view summed(whole.data(), whole.size() - sizeof sum);
    if (checksum(summed) != sum) return false;
    std::memcpy(&size, summed.data() + summed.size() - sizeof size, sizeof size);
    return size == made_from.size() && summed.substr(summed.size() - sizeof size - size, made_from.size()) == made_from;
}

/// Opens a file of this user; -1 if it is not that. A pipe does not wait for its other end.
int open_own(int folder, const std::string& name, int flags) {
    const int file = ::openat(folder, name.c_str(), flags | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    struct stat is;
    if (file < 0 || (::fstat(file, &is) == 0 && S_ISREG(is.st_mode) && objection_to(is).empty())) return file;
    ::close(file);
    return -1;
}

/// Takes the lock of a key; -1 if another process has it and `wait` is false, or if there are no locks here. A file is
/// removed by the process that has its lock, so that it must be the one which has the name then.
int take_lock(int folder, const std::string& name, bool wait) {
    for (;;) {
        const int file = ::openat(folder, name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
        if (file < 0) return -1;
        int locked = -1;
        do locked = ::flock(file, LOCK_EX | (wait ? 0 : LOCK_NB));
        while (locked < 0 && errno == EINTR);
        struct stat mine, named;
        if (locked == 0 && ::fstat(file, &mine) == 0 &&
            ::fstatat(folder, name.c_str(), &named, AT_SYMLINK_NOFOLLOW) == 0 && mine.st_ino == named.st_ino)
            return file;
        ::close(file);
        if (locked < 0) return -1;
    }
}
void give_lock_back(int folder, const std::string& name, int file) {
    if (file < 0) return;
    ::unlinkat(folder, name.c_str(), 0);
    ::close(file);
}

}  // namespace

// ---------------------------------------------------------------------------------------------------------------------
// The folder
// ---------------------------------------------------------------------------------------------------------------------

model_cache::model_cache() {
    const fs::path chosen = chosen_folder();
    if (!chosen.empty()) open_folder(chosen);
    if (folder_ >= 0 && objection_.empty()) {
        made_in_ = chosen;
        made_in_folder_ = folder_;
        return;
    }
    std::error_code unknown;
    std::string name = (fs::temp_directory_path(unknown) / "myriad.XXXXXX").string();
    const bool is_made = ::mkdtemp(name.data()) != nullptr;
    require(is_made,
            "neither the cache nor a temporary folder can be written: set MYRIAD_CACHE_DIR to a folder that can");
    made_in_ = name;
    made_in_folder_ = ::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

model_cache::~model_cache() {
    std::error_code ignored;
    if (folder_ >= 0) ::close(folder_);
    if (made_in_folder_ == folder_) return;
    ::close(made_in_folder_);
    fs::remove_all(made_in_, ignored);
}

void model_cache::open_folder(const fs::path& path) {
    const auto refuse = [&](const std::string& why, const std::string& cure) {
        objection_ = message("compiled models are not kept in ", path.string(), ", as ", why, ": ", cure);
    };
    const auto failed = [&] {
        refuse(message("it cannot be used (", std::generic_category().message(errno), ")"),
               "set MYRIAD_CACHE_DIR to a folder that can");
    };
    if (!make_folders(path)) return failed();
    // A link that somebody else made leads where that user wants.
    struct stat is;
    if (::lstat(path.c_str(), &is) < 0) return failed();
    if (S_ISLNK(is.st_mode) && !is_own(is))
        return refuse(objection_to(is), "remove it, or set MYRIAD_CACHE_DIR to a folder of your own");
    const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return failed();
    std::string objection = ::fstat(folder, &is) < 0 ? "nothing is known of it" : objection_to(is);
    if (objection.empty()) {
        folder_ = folder;
        // A cache that can only be read is one, as on a shared home.
        if (::faccessat(folder, ".", W_OK | X_OK, AT_EACCESS) == 0) return;
        return failed();
    }
    ::close(folder);
    refuse(objection, is_own(is)
                          ? message("remove it, or if nobody has put anything there, `chmod go-w ", path.string(), '`')
                          : "set MYRIAD_CACHE_DIR to a folder of your own");
}

// ---------------------------------------------------------------------------------------------------------------------
// Its files
// ---------------------------------------------------------------------------------------------------------------------

std::optional<compiled_file> model_cache::find(const std::string& key, std::string_view made_from) const {
    const std::string name = key + ".so";
    const int file = open_own(folder_, name, O_RDONLY);
    if (file < 0) return {};
    if (is_whole(contents_of(file), made_from)) {
        ::utimensat(folder_, name.c_str(), nullptr, AT_SYMLINK_NOFOLLOW);  // the time of its last use, for `shrink`
        return compiled_file{file};
    }
    ::close(file);
    return {};
}

bool model_cache::knows(const std::string& source) const {
    const int file = open_own(folder_, text_hash(source) + ".hpp", O_RDONLY);
    if (file < 0) return false;
    const bool same = contents_of(file) == source;
    ::close(file);
    return same;
}
void model_cache::remember(const std::string& source) const {
    if (made_in_folder_ != folder_ || knows(source)) return;
    const std::string name = text_hash(source) + ".hpp", made = message(name, ".part-", ::getpid());
    ::unlinkat(folder_, made.c_str(), 0);
    const int file = ::openat(folder_, made.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0) return;  // and asked for again
    const bool done = append_to(file, source);
    ::close(file);
    if (!done || ::renameat(folder_, made.c_str(), folder_, name.c_str()) < 0) ::unlinkat(folder_, made.c_str(), 0);
}

void model_cache::shrink(const std::string& keep) const {
    std::uintmax_t limit = std::uintmax_t{1} << 30;
    const std::string asked = variable("MYRIAD_CACHE_SIZE");
    std::from_chars(asked.data(), asked.data() + asked.size(), limit);
    std::error_code ignored;
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    std::uintmax_t total = 0;
    for (fs::directory_iterator at(made_in_, ignored), end; !ignored && at != end; at.increment(ignored)) {
        const std::string name = at->path().filename().string();
        if (const std::size_t mark = name.find(work_mark); mark != std::string::npos) {
            const std::string lock_name = name.substr(0, mark) + ".lock";
            const int lock = take_lock(folder_, lock_name, false);
            if (lock >= 0) fs::remove_all(at->path(), ignored);
            give_lock_back(folder_, lock_name, lock);
        } else if (at->path().extension() == ".lock") {
            give_lock_back(folder_, name, take_lock(folder_, name, false));
        } else if (at->path().extension() == ".so" && !at->is_symlink(ignored)) {
            files.emplace_back(at->last_write_time(ignored), at->path());
            total += at->file_size(ignored);
        }
    }
    std::sort(files.begin(), files.end());
    for (const auto& [time, path] : files) {
        if (total <= limit) return;
        if (path.filename() == keep + ".so") continue;
        total -= std::min(total, fs::file_size(path, ignored));
        fs::remove(path, ignored);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Where one is made
// ---------------------------------------------------------------------------------------------------------------------

model_cache::workplace::workplace(const model_cache& cache, const std::string& key)
    : cache_(cache), key_(key), lock_(take_lock(cache.made_in_folder_, key + ".lock", true)) {
    std::error_code ignored;
    const std::string begin = key + std::string(work_mark);
    if (lock_ >= 0)  // what is there is of a process that was killed
        for (fs::directory_iterator at(cache.made_in_, ignored), end; !ignored && at != end; at.increment(ignored))
            if (at->path().filename().string().starts_with(begin)) fs::remove_all(at->path(), ignored);
    std::string name = (cache.made_in_ / (begin + "XXXXXX")).string();
    if (::mkdtemp(name.data()) == nullptr) {
        const int code = errno;
        give_lock_back(cache_.made_in_folder_, key_ + ".lock", lock_);
        throw error(message("no folder can be made in ", cache.made_in_.string(), " (",
                            std::generic_category().message(code),
                            "): free space, or set MYRIAD_CACHE_DIR to another folder"));
    }
    folder_ = name;
}
model_cache::workplace::~workplace() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    give_lock_back(cache_.made_in_folder_, key_ + ".lock", lock_);
}

compiled_file model_cache::workplace::seal(std::string_view made_from) const {
    const std::string name = (folder_.filename() / "model.so").string();
    // In a folder that only this user can look into, so far with the mode that the compiler gave it.
    ::fchmodat(cache_.made_in_folder_, name.c_str(), 0600, 0);
    const int file = open_own(cache_.made_in_folder_, name, O_RDWR | O_APPEND);
    require(file >= 0, folder_.string(), "/model.so is missing, or somebody else's: compile the model again");
    const std::string whole = contents_of(file);
    std::string added(made_from);
    const std::uint64_t size = made_from.size();
    added.append(reinterpret_cast<const char*>(&size), sizeof size);
    const std::uint32_t sum = checksum(whole + added);
    added.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    const bool done = append_to(file, added);
    ::close(file);
    require(done, folder_.string(), "/model.so cannot be written: is the disk full?");
    return {open_own(cache_.made_in_folder_, name, O_RDONLY)};
}
void model_cache::workplace::keep() const {
    const std::string from = (folder_.filename() / "model.so").string(), to = key_ + ".so";
    ::renameat(cache_.made_in_folder_, from.c_str(), cache_.made_in_folder_, to.c_str());
    if (cache_.made_in_folder_ == cache_.folder_) cache_.shrink(key_);
}

}  // namespace myriad::programs
