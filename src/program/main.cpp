// SPDX-License-Identifier: MIT
// The function main of programs that are linked with myriad::program.
#include "program/commands.hpp"

int main(int argc, char** argv) { return myriad::programs::run_program(argc, argv); }
