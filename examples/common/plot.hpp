// SPDX-License-Identifier: MIT
// Draws a picture from a table with the example's plot.py.
#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

namespace examples {

/// A Python that has matplotlib. The first on the PATH may not be the one for which the system's packages are
/// installed.
class plotter {
public:
    /// Throws std::runtime_error if there is none; constructed before the work whose results are to be drawn.
    plotter() {
        for (const char* python : {"python3", "/usr/bin/python3"}) {
            if (run({python, "-c", "import matplotlib"}, output::dropped) != 0) continue;
            python_ = python;
            return;
        }
        throw std::runtime_error(
            "--plot needs a Python 3 with matplotlib: install it (Debian, Ubuntu: apt-get install "
            "python3-matplotlib), or leave --plot out");
    }

    /// Runs `script table picture`; throws std::runtime_error if it fails. The script reports the reason on stderr.
    void draw(const std::string& script, const std::string& table, const std::string& picture) const {
        if (run({python_, script, table, picture}, output::shown) != 0)
            throw std::runtime_error(picture + " was not drawn; the table is in " + table);
    }

private:
    enum class output { shown, dropped };

    /// Returns the exit status, or 127 if there is no such program.
    static int run(const std::vector<std::string>& words, output what) {
        std::vector<char*> arguments;
        for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        if (what == output::dropped)
            for (const int file : {1, 2}) posix_spawn_file_actions_addopen(&files, file, "/dev/null", O_WRONLY, 0);
        pid_t child = 0;
        const int failure = ::posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
        posix_spawn_file_actions_destroy(&files);
        if (failure != 0) return 127;
        int status = 0;
        while (::waitpid(child, &status, 0) < 0)
            if (errno != EINTR) return 127;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    }

    std::string python_;
};

}  // namespace examples
