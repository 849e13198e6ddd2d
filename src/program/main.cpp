// SPDX-License-Identifier: MIT
// The function main of programs that are linked with myriad::program.
#include <csignal>

#include "program/commands.hpp"

int main(int argc, char** argv) {
    std::signal(SIGCHLD, SIG_DFL);  // who started this may ignore it, and then nobody learns how compilers end
    return myriad::programs::run_program(argc, argv);
}
