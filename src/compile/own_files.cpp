// SPDX-License-Identifier: MIT
// Looks at owners and modes.
#include "compile/own_files.hpp"

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <system_error>

#include <fcntl.h>

#include "myriad/host/core/error.hpp"

namespace myriad::compiling {

namespace fs = std::filesystem;

bool is_own(const struct stat& is) { return is.st_uid == ::geteuid() || is.st_uid == 0; }

std::string objection_to(const struct stat& is) {
    if (!is_own(is)) return message("it belongs to another user, of number ", is.st_uid);
    if ((is.st_mode & (S_IWGRP | S_IWOTH)) == 0) return "";
    char mode[8] = {};
    std::to_chars(mode, mode + sizeof mode, is.st_mode & 0777, 8);
    return message("others may write to it (mode ", mode, ")");
}

bool make_folders(const fs::path& path) {
    if (::mkdir(path.c_str(), 0700) == 0 || errno == EEXIST) return true;
    const fs::path parent = path.parent_path();
    if (errno != ENOENT || parent.empty() || parent == path || !make_folders(parent)) return false;
    return ::mkdir(path.c_str(), 0700) == 0 || errno == EEXIST;
}

int open_own(int folder, const std::string& name) {
    const int file = ::openat(folder, name.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    struct stat is;
    if (file < 0 || (::fstat(file, &is) == 0 && S_ISREG(is.st_mode) && objection_to(is).empty())) return file;
    ::close(file);
    return -1;
}

namespace {

/// A folder that lasts as long as the process that made it.
struct temporary_folder {
    fs::path path;
    pid_t owner = ::getpid();

    temporary_folder() {
        std::error_code unknown;
        for (const fs::path& where : {fs::temp_directory_path(unknown), fs::path("/tmp"), fs::path("/var/tmp")}) {
            if (!where.is_absolute()) continue;
            std::string name = (where / "myriad.XXXXXX").string();
            if (::mkdtemp(name.data()) == nullptr) continue;
            path = name;
            return;
        }
        host::refuse({"neither the cache nor a temporary folder can be written", host::cure,
                      "set MYRIAD_CACHE_DIR to a folder that can"});
    }
    temporary_folder(const temporary_folder&) = delete;
    temporary_folder& operator=(const temporary_folder&) = delete;
    ~temporary_folder() {
        std::error_code ignored;
        if (::getpid() == owner) fs::remove_all(path, ignored);
    }
};

}  // namespace

fs::path folder_of_process() {
    static std::mutex mutex;
    static std::optional<temporary_folder> made;
    const std::lock_guard guard(mutex);
    std::error_code unknown;
    if (!made || made->owner != ::getpid() || !fs::is_directory(made->path, unknown)) made.emplace();
    return made->path;
}

}  // namespace myriad::compiling
