// SPDX-License-Identifier: MIT
// The folder of compiled models, its files and locks.
#include "compile/compiled_cache.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "compile/file_locks.hpp"
#include "compile/own_files.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/study/store/crc32c.hpp"

namespace myriad::compiling {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view work_mark = ".work.";

std::uintmax_t size_limit() {
    constexpr std::uintmax_t usual = std::uintmax_t{1} << 30;
    const std::string asked = variable("MYRIAD_CACHE_SIZE");
    if (asked.empty()) return usual;
    std::uintmax_t limit = 0;
    const auto [end, failed] = std::from_chars(asked.data(), asked.data() + asked.size(), limit);
    require(failed == std::errc() && end == asked.data() + asked.size(), "MYRIAD_CACHE_SIZE is '", asked, "'",
            host::cure, "give a number of bytes, such as ", usual);
    return limit;
}

/// A name of the same file that no library of this process was loaded by: the system's loader takes a name that it
/// knows for the library that it has loaded by it, and numbers of files come again. Slashes and dots, which lead
/// nowhere, spell a number, and whose it is, as another library of the process may have this code, too.
std::string new_path_of(int file) {
    static std::atomic<std::uint64_t> loaded{0};
    std::string path = "/proc/self/fd/";
    for (const std::uint64_t number : {std::uint64_t{reinterpret_cast<std::uintptr_t>(&loaded)}, ++loaded})
        for (int bit = 0; bit < 64; ++bit) path += (number >> bit & 1) != 0 ? "./" : "/";
    return path + std::to_string(file);
}

/// A copy of a file in memory, from which code may be run where the file system of the file forbids that; -1 if there
/// can be none.
int executable_copy(int file) {
    constexpr unsigned for_code = 0x10;  // MFD_EXEC, which older headers and kernels do not know
    int made = ::memfd_create("myriad_model", MFD_CLOEXEC | for_code);
    if (made < 0 && errno == EINVAL) made = ::memfd_create("myriad_model", MFD_CLOEXEC);
    open_file copy(made);
    if (made < 0) return -1;
    const std::string content = read_file(path_of(file));
    for (std::size_t at = 0; at < content.size();) {
        const ssize_t written = ::write(made, content.data() + at, content.size() - at);
        if (written < 0 && errno != EINTR) return -1;
        at += written > 0 ? static_cast<std::size_t>(written) : 0;
    }
    return copy.release();
}

/// Loads an open file, which may be closed afterwards.
void load_file(int file, const compiled_cache::loader& load) {
    struct statvfs is;
    const bool is_forbidden = ::fstatvfs(file, &is) == 0 && (is.f_flag & ST_NOEXEC) != 0;
    const open_file copy(is_forbidden ? executable_copy(file) : -1);
    load(new_path_of(copy.get() >= 0 ? copy.get() : file));
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

bool is_loaded(int file, const compiled_cache::loader& load) {
    try {
        load_file(file, load);
        return true;
    } catch (const error&) {
        return false;
    }
}

/// Models and prepared headers, which may be removed: they are made again.
bool is_compiled(const fs::path& path) {
    const fs::path kind = path.extension();
    return kind == ".so" || kind == ".pch" || kind == ".gch";
}

/// Whether a disk may have no room for what a compiler writes, which is removed again.
bool is_full(const fs::path& folder) {
    std::error_code unknown;
    const fs::space_info room = fs::space(folder, unknown);
    return !unknown && room.available < (std::uintmax_t{16} << 20);
}

}  // namespace

// ---------------------------------------------------------------------------------------------------------------------
// The folder
// ---------------------------------------------------------------------------------------------------------------------

compiled_cache::compiled_cache(signal_check check) : check_(std::move(check)), limit_(size_limit()) {
    const fs::path chosen = user_folder();
    if (chosen.empty()) {
        objection_ = "there is no folder for compiled models: set MYRIAD_CACHE_DIR to one";
    } else {
        open_folder(chosen);
    }
    if (objection_.empty()) {
        made_in_ = chosen;
        made_in_folder_ = folder_;
    } else {
        use_folder_of_process();
    }
}

compiled_cache::~compiled_cache() {
    if (folder_ >= 0) ::close(folder_);
    if (made_in_folder_ != folder_) ::close(made_in_folder_);
}

fs::path compiled_cache::user_folder() {
    if (const std::string chosen = variable("MYRIAD_CACHE_DIR"); !chosen.empty()) return chosen;
    if (const std::string caches = variable("XDG_CACHE_HOME"); !caches.empty()) return fs::path(caches) / "myriad";
    const std::string home = variable("HOME");
    return home.empty() ? fs::path() : fs::path(home) / ".cache" / "myriad";
}

void compiled_cache::use_folder_of_process() {
    made_in_ = folder_of_process();
    if (made_in_folder_ != folder_) ::close(made_in_folder_);
    made_in_folder_ = ::open(made_in_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

void compiled_cache::open_folder(const fs::path& path) {
    const auto refuse = [&](const std::string& why, const std::string& cure) {
        objection_ = message("compiled models are not kept in ", path.string(), ", as ", why, ": ", cure);
    };
    const auto failed = [&](int code) {
        refuse(message("it cannot be used (", std::generic_category().message(code), ")"),
               "set MYRIAD_CACHE_DIR to a folder that can");
    };
    if (!make_folders(path)) return failed(errno);
    // A link that somebody else made leads where that user wants.
    struct stat is;
    if (::lstat(path.c_str(), &is) < 0) return failed(errno);
    if (S_ISLNK(is.st_mode) && !is_own(is)) {
        is_distrusted_ = true;
        return refuse(objection_to(is), "remove it, or set MYRIAD_CACHE_DIR to a folder of your own");
    }
    const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return failed(errno);
    const bool is_known = ::fstat(folder, &is) == 0;
    if (const std::string why = is_known ? objection_to(is) : "nothing is known of it"; !why.empty()) {
        ::close(folder);
        is_distrusted_ = true;
        return refuse(why, is_known && is_own(is) ? message("remove it, or if nobody has put anything there, `chmod "
                                                            "go-w ",
                                                            path.string(), '`')
                                                  : "set MYRIAD_CACHE_DIR to a folder of your own");
    }
    folder_ = folder;  // one that can only be read is a cache, too, as on a shared home
    if (::faccessat(folder, ".", W_OK | X_OK, AT_EACCESS) != 0) failed(errno);
}

// ---------------------------------------------------------------------------------------------------------------------
// Where something is made
// ---------------------------------------------------------------------------------------------------------------------

/// A folder in the cache, for the process that has the lock of a key.
class compiled_cache::workplace {
public:
    workplace(const compiled_cache& cache, const std::string& key)
        : cache_(cache), lock_name_(key + ".lock"),
          lock_(take_lock(cache.made_in_folder_, lock_name_, true, cache.check_)) {
        std::error_code ignored;
        const std::string begin = key + std::string(work_mark);
        if (lock_ >= 0)  // what is there is of a process that was killed
            for (fs::directory_iterator at(cache.made_in_, ignored), end; !ignored && at != end; at.increment(ignored))
                if (at->path().filename().string().starts_with(begin)) fs::remove_all(at->path(), ignored);
        std::string name = (cache.made_in_ / (begin + "XXXXXX")).string();
        const bool is_made = ::mkdtemp(name.data()) != nullptr;
        const int code = errno;
        if (!is_made) give_lock_back(cache_.made_in_folder_, lock_name_, lock_);
        if (!is_made) throw std::system_error(code, std::generic_category());
        folder_ = name;
    }
    workplace(const workplace&) = delete;
    workplace& operator=(const workplace&) = delete;
    ~workplace() {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
        give_lock_back(cache_.made_in_folder_, lock_name_, lock_);
    }

    const fs::path& folder() const { return folder_; }

    /// Puts what it was made from and a checksum behind `model.so`, and returns it open.
    int seal(std::string_view made_from) const {
        const int file = open_own(cache_.made_in_folder_, made());
        require(file >= 0, folder_.string(), "/model.so is missing, or somebody else's", host::cure,
                "compile the model again");
        std::string added(made_from);
        const std::uint64_t size = made_from.size();
        added.append(reinterpret_cast<const char*>(&size), sizeof size);
        const std::uint32_t sum = checksum(read_file(path_of(file)) + added);
        added.append(reinterpret_cast<const char*>(&sum), sizeof sum);
        write_file(folder_ / "model.so", added, std::ios::app);
        return file;
    }
    /// Gives `model.so` the mode of a file for this user alone, in a folder that nobody else can look into.
    void make_private() const { ::fchmodat(cache_.made_in_folder_, made().c_str(), 0600, 0); }
    /// Puts it into the cache.
    bool keep(const std::string& name) const {
        return ::renameat(cache_.made_in_folder_, made().c_str(), cache_.made_in_folder_, name.c_str()) == 0;
    }

private:
    std::string made() const { return (folder_.filename() / "model.so").string(); }

    const compiled_cache& cache_;
    std::string lock_name_;
    int lock_;
    fs::path folder_;
};

// ---------------------------------------------------------------------------------------------------------------------
// Its files
// ---------------------------------------------------------------------------------------------------------------------

bool compiled_cache::find(const std::string& key, std::string_view made_from, const loader& load) const {
    const std::string name = key + ".so";
    const auto find_in = [&](int folder) {
        open_file file(folder < 0 ? -1 : open_own(folder, name));
        if (file.get() < 0 || !is_whole(read_file(path_of(file.get())), made_from)) return false;
        ::utimensat(folder, name.c_str(), nullptr, AT_SYMLINK_NOFOLLOW);  // the time of its last use, for `shrink`
        return is_loaded(file.get(), load);
    };
    return find_in(folder_) || (made_in_folder_ != folder_ && find_in(made_in_folder_));
}

bool compiled_cache::obtain(std::string_view made_from, const maker& make, const loader& load) {
    const std::string key = text_hash(made_from);
    if (find(key, made_from, load)) return true;
    if (made_in_folder_ == folder_) {
        const auto leave = [&](std::string_view why) {
            objection_ = message("compiled models are not kept in ", made_in_.string(), ", as it cannot be used (", why,
                                 "): free space, or set MYRIAD_CACHE_DIR to another folder");
            use_folder_of_process();
        };
        try {
            const bool was_there = make_model(key, made_from, make, load);
            if (!was_there) shrink(key + ".so");
            return was_there;
        } catch (const std::system_error& why) {
            leave(why.code().message());
        } catch (const error&) {  // a compiler may not say that it cannot write
            if (!is_full(made_in_)) throw;
            leave(std::generic_category().message(ENOSPC));
        }
    }
    try {
        return make_model(key, made_from, make, load);
    } catch (const std::system_error& why) {
        throw error(statement_of("no folder can be made in ", made_in_.string(), " (", why.code().message(), ")",
                                 host::cure, "free space, or set MYRIAD_CACHE_DIR to another folder"));
    } catch (const error& why) {
        if (!is_full(made_in_)) throw;
        throw error(statement_of(why.said(), " (and the disk with ", made_in_.string(),
                                 " is nearly full: free space, or set MYRIAD_CACHE_DIR to a folder on another)"));
    }
}

/// Makes what is not there, unless the process that had the lock has; returns whether that is so.
bool compiled_cache::make_model(const std::string& key, std::string_view made_from, const maker& make,
                                const loader& load) const {
    const workplace work(*this, key);
    if (find(key, made_from, load)) return true;
    make(work.folder());
    work.make_private();
    const open_file file(work.seal(made_from));
    load_file(file.get(), load);
    work.keep(key + ".so");
    return false;
}

std::string compiled_cache::find_file(const std::string& name) const {
    const int file = folder_ < 0 ? -1 : open_own(folder_, name);
    if (file < 0) return "";
    ::close(file);
    ::utimensat(folder_, name.c_str(), nullptr, AT_SYMLINK_NOFOLLOW);
    return (user_folder() / name).string();
}

std::string compiled_cache::make_file(const std::string& name, const maker& make) {
    if (made_in_folder_ != folder_) return "";
    try {
        const workplace work(*this, name.substr(0, name.find('.')));
        if (std::string made = find_file(name); !made.empty()) return made;
        make(work.folder());
        work.make_private();
        return work.keep(name) ? find_file(name) : "";
    } catch (const std::system_error&) {
    } catch (const error&) {  // another time, then
    }
    return "";
}

bool compiled_cache::knows(const std::string& source) const {
    const open_file file(open_own(folder_, text_hash(source) + ".hpp"));
    return file.get() >= 0 && read_file(path_of(file.get())) == source;
}
void compiled_cache::remember(const std::string& source) {
    make_file(text_hash(source) + ".hpp", [&](const fs::path& folder) { write_file(folder / "model.so", source); });
}

void compiled_cache::shrink(const std::string& keep) const {
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
        } else if (is_compiled(at->path()) && !at->is_symlink(ignored)) {
            files.emplace_back(at->last_write_time(ignored), at->path());
            total += at->file_size(ignored);
        }
    }
    std::sort(files.begin(), files.end());
    for (const auto& [time, path] : files) {
        if (total <= limit_) return;
        if (path.filename() == keep) continue;
        total -= std::min(total, fs::file_size(path, ignored));
        fs::remove(path, ignored);
    }
}

int compiled_cache::clear() const {
    std::error_code ignored;
    int removed = 0;
    for (fs::directory_iterator at(user_folder(), ignored), end; !ignored && at != end; at.increment(ignored)) {
        if (!is_compiled(at->path())) continue;
        std::error_code failed;
        removed += fs::remove(at->path(), failed) && at->path().extension() == ".so" ? 1 : 0;
    }
    return removed;
}

}  // namespace myriad::compiling
