// SPDX-License-Identifier: MIT
// Shifts an int by more bits than it has: the undefined-behaviour sanitizer must report it.
#include <cstdio>

int main(int argc, char*[]) { std::printf("%d\n", argc << (40 + argc)); }
