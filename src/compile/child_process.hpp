// SPDX-License-Identifier: MIT
// Other programs that this one starts: compilers and Python. Host code only.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace myriad::compiling {

/// Called where a signal has interrupted a wait; throws to give it up.
using signal_check = std::function<void()>;

/// What ends with a program: itself alone, or also the programs that it has started, as a compiler's parts. Ctrl-C of a
/// terminal then reaches this program alone, whose `signal_check` ends the others.
enum class ended_with { program, its_programs };

/// A program that runs beside this one.
class child_process {
public:
    /// Starts the first word, looked for on the PATH, with the others as arguments. What it prints goes to a file;
    /// empty: where this program's output goes.
    explicit child_process(const std::vector<std::string>& words, const std::string& output = "",
                           ended_with = ended_with::program);
    child_process(child_process&& other) noexcept : id_(other.id_), with_(other.with_) { other.id_ = -1; }
    child_process& operator=(child_process&&) = delete;
    /// Ends the program if nobody has waited for it to the end.
    ~child_process();

    /// Its exit status; 127 if there is no such program, 128 if a signal ended it, `unknown` if only the system knows,
    /// as in a program that ignores SIGCHLD or waits for all children: what it was to make is there if it succeeded.
    static constexpr int unknown = -1;
    int wait(const signal_check& check = {});
    /// Waits so many seconds at the most; false if the program has not ended by then. `check` is called often.
    bool wait_for(double seconds, const signal_check& check = {});

private:
    void note(int waited);

    pid_t id_ = -1;
    ended_with with_ = ended_with::program;
    int status_ = 127;
};

/// What a program prints on standard output; empty if it fails, as far as that is known.
std::string output_of(const std::vector<std::string>& words);

/// The path of a program on the PATH, or of a file that can be run; empty if there is none.
std::string find_program(const std::string& name);

/// The words of a command as a shell divides it, with quotes and backslashes. Throws `error` if a quote has no end.
std::vector<std::string> words_of(const std::string& command);

}  // namespace myriad::compiling
