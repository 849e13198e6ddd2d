// SPDX-License-Identifier: MIT
// Starting other programs.
#include "program/child_process.hpp"

#include <cerrno>
#include <cstdlib>
#include <string_view>

#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace myriad::programs {

child_process::child_process(const std::vector<std::string>& words, const std::string& output) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (!output.empty()) {
        posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    }
    if (posix_spawnp(&id_, arguments[0], &files, nullptr, arguments.data(), environ) != 0) id_ = -1;
    posix_spawn_file_actions_destroy(&files);
}

int child_process::wait() {
    if (id_ < 0) return status_;
    int status = 0;
    while (waitpid(id_, &status, 0) < 0)
        if (errno != EINTR) return status_ = 128;
    id_ = -1;
    return status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

namespace {

/// A folder may be "executed", too.
bool is_program(const std::string& path) {
    struct stat is;
    return ::stat(path.c_str(), &is) == 0 && S_ISREG(is.st_mode) && access(path.c_str(), X_OK) == 0;
}

}  // namespace

std::string find_program(const std::string& name) {
    if (name.find('/') != std::string::npos) return is_program(name) ? name : "";
    const char* const path = std::getenv("PATH");
    std::string_view left = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
    while (!left.empty()) {
        const std::size_t end = std::min(left.find(':'), left.size());
        const std::string found = std::string(left.substr(0, end)) + '/' + name;
        if (end > 0 && is_program(found)) return found;
        left.remove_prefix(std::min(end + 1, left.size()));
    }
    return "";
}

}  // namespace myriad::programs
