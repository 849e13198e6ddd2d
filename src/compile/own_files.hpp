// SPDX-License-Identifier: MIT
// Files and folders that nobody but this user can have written, as they are open. Host code only.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

namespace myriad::compiling {

/// Closes a file at its end, unless that is released.
class open_file {
public:
    explicit open_file(int file) : file_(file) {}
    open_file(const open_file&) = delete;
    open_file& operator=(const open_file&) = delete;
    ~open_file() {
        if (file_ >= 0) ::close(file_);
    }
    int get() const { return file_; }
    int release() { return std::exchange(file_, -1); }

private:
    int file_;
};

/// Whether something belongs to this user, or to root.
bool is_own(const struct stat& is);
/// Why something is not trusted; empty if it is.
std::string objection_to(const struct stat& is);
/// Makes a folder and those that it is in, for this user alone whatever the umask is.
bool make_folders(const std::filesystem::path& path);
/// Opens a file of this user; -1 if it is not that. A pipe does not wait for its other end.
int open_own(int folder, const std::string& name);
/// The name by which an open file, and no other, is read and written.
inline std::string path_of(int file) { return "/proc/self/fd/" + std::to_string(file); }
/// A folder that lasts as long as this process. A child has one of its own, since its parent's may be gone.
std::filesystem::path folder_of_process();

}  // namespace myriad::compiling
