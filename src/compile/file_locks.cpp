// SPDX-License-Identifier: MIT
// Locks files by flock.
#include "compile/file_locks.hpp"

#include <cerrno>
#include <mutex>
#include <vector>

#include <fcntl.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compile/own_files.hpp"

namespace myriad::compiling {

namespace {

/// The locks of this process. A child that it forks has them open, too, and would hold them until it ends.
class held_locks {
public:
    static void add(int file) {
        const std::lock_guard guard(mine().mutex_);
        mine().files_.push_back(file);
    }
    /// Unlocks and closes one; one that this process only has from its parent is closed already.
    static void give_back(int file) {
        const std::lock_guard guard(mine().mutex_);
        if (std::erase(mine().files_, file) == 0) return;
        ::flock(file, LOCK_UN);
        ::close(file);
    }

private:
    held_locks() {
        ::pthread_atfork([] { mine().mutex_.lock(); }, [] { mine().mutex_.unlock(); },
                         [] {
                             for (const int file : mine().files_) ::close(file);
                             mine().files_.clear();
                             mine().mutex_.unlock();
                         });
    }
    static held_locks& mine() {
        static auto* const all = new held_locks;  // for the life of the process
        return *all;
    }

    std::mutex mutex_;
    std::vector<int> files_;
};

}  // namespace

/// A file is removed by the process that has its lock, so that it must be the one which has the name then.
int take_lock(int folder, const std::string& name, bool wait, const signal_check& check) {
    for (;;) {
        const int file = ::openat(folder, name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
        if (file < 0) return -1;
        open_file lock(file);
        int locked = -1;
        while ((locked = ::flock(file, LOCK_EX | (wait ? 0 : LOCK_NB))) < 0 && errno == EINTR)
            if (check) check();
        struct stat mine, named;
        if (locked == 0 && ::fstat(file, &mine) == 0 &&
            ::fstatat(folder, name.c_str(), &named, AT_SYMLINK_NOFOLLOW) == 0 && mine.st_ino == named.st_ino) {
            held_locks::add(file);
            return lock.release();
        }
        if (locked < 0) return -1;
    }
}

void give_lock_back(int folder, const std::string& name, int file) {
    if (file < 0) return;
    ::unlinkat(folder, name.c_str(), 0);
    held_locks::give_back(file);
}

}  // namespace myriad::compiling
