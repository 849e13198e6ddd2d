// SPDX-License-Identifier: MIT
// Starting other programs.
#include "compile/child_process.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "myriad/host/core/error.hpp"

namespace myriad::compiling {

child_process::child_process(const std::vector<std::string>& words, const std::string& output, ended_with with)
    : with_(with) {
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
    // What this program ignores, that one would, too: compilers wait for children of their own.
    posix_spawnattr_t how;
    posix_spawnattr_init(&how);
    sigset_t usual;
    sigemptyset(&usual);
    sigaddset(&usual, SIGCHLD);
    posix_spawnattr_setsigdefault(&how, &usual);
    const bool has_group = with == ended_with::its_programs;
    posix_spawnattr_setpgroup(&how, 0);
    posix_spawnattr_setflags(&how, static_cast<short>(POSIX_SPAWN_SETSIGDEF | (has_group ? POSIX_SPAWN_SETPGROUP : 0)));
    if (posix_spawnp(&id_, arguments[0], &files, &how, arguments.data(), environ) != 0) id_ = -1;
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&files);
}

child_process::~child_process() {
    if (id_ >= 0) ::kill(with_ == ended_with::its_programs ? -id_ : id_, SIGKILL);
    wait();
}

int child_process::wait(const signal_check& check) {
    if (id_ < 0) return status_;
    int status = 0;
    while (waitpid(id_, &status, 0) < 0) {
        if (errno != EINTR) {
            id_ = -1;
            return status_ = unknown;
        }
        if (check) check();
    }
    note(status);
    return status_;
}

bool child_process::wait_for(double seconds, const signal_check& check) {
    constexpr long shortest = 1'000'000, longest = 20'000'000;  // ns between two looks
    const auto begin = std::chrono::steady_clock::now();
    for (long nap = shortest; id_ >= 0; nap = std::min(longest, nap + nap / 4)) {
        int status = 0;
        const pid_t found = waitpid(id_, &status, WNOHANG);
        if (found == id_) {
            note(status);
            break;
        }
        if (found < 0 && errno != EINTR) {
            id_ = -1;
            status_ = unknown;
            break;
        }
        if (check) check();
        if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > seconds) return false;
        const timespec time{0, nap};
        nanosleep(&time, nullptr);
    }
    return true;
}

void child_process::note(int waited) {
    id_ = -1;
    status_ = WIFEXITED(waited) ? WEXITSTATUS(waited) : 128;
}

namespace {

/// A folder may be "executed", too.
bool is_program(const std::string& path) {
    struct stat is;
    return ::stat(path.c_str(), &is) == 0 && S_ISREG(is.st_mode) && access(path.c_str(), X_OK) == 0;
}

}  // namespace

std::string output_of(const std::vector<std::string>& words) {
    const int file = ::memfd_create("output", MFD_CLOEXEC);
    if (file < 0) return "";
    std::string text;
    const int status = child_process(words, message("/proc/self/fd/", file)).wait();
    if (status == 0 || status == child_process::unknown) {
        char part[4096];
        for (ssize_t got; (got = ::pread(file, part, sizeof part, static_cast<off_t>(text.size()))) > 0;)
            text.append(part, static_cast<std::size_t>(got));
    }
    ::close(file);
    return text;
}

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

std::vector<std::string> words_of(const std::string& command) {
    std::vector<std::string> words;
    bool in_word = false;
    for (std::size_t at = 0; at < command.size(); ++at) {
        const char c = command[at];
        if (std::strchr(" \t\r\n", c) != nullptr) {
            in_word = false;
            continue;
        }
        if (!in_word) words.emplace_back();
        in_word = true;
        if (c == '\'' || c == '"') {
            for (++at; at < command.size() && command[at] != c; ++at) {
                const bool is_escaped = c == '"' && command[at] == '\\' && at + 1 < command.size() &&
                                        (command[at + 1] == '"' || command[at + 1] == '\\');
                if (is_escaped) ++at;
                words.back() += command[at];
            }
            require(at < command.size(), "a quotation in it has no end");
        } else {
            const bool is_escaped = c == '\\' && at + 1 < command.size();
            if (is_escaped) ++at;
            words.back() += command[at];
        }
    }
    return words;
}

}  // namespace myriad::compiling
