// SPDX-License-Identifier: MIT
// Other programs that this one starts: compilers and Python. Host code only.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace myriad::programs {

/// A program that runs beside this one.
class child_process {
public:
    /// Starts the first word, looked for on the PATH, with the others as arguments. What it prints goes to a file;
    /// empty: where this program's output goes.
    explicit child_process(const std::vector<std::string>& words, const std::string& output = "");
    child_process(child_process&& other) noexcept : id_(other.id_) { other.id_ = -1; }
    child_process& operator=(child_process&&) = delete;
    ~child_process() { wait(); }

    /// Its exit status; 127 if there is no such program, 128 if a signal ended it.
    int wait();

private:
    pid_t id_ = -1;
    int status_ = 127;
};

/// The path of a program on the PATH, or of a file that can be run; empty if there is none.
std::string find_program(const std::string& name);

}  // namespace myriad::programs
