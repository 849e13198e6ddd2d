// expect: Myriad is written in C..20, and this file is compiled as an older C
// flags: -std=c++17
// SPDX-License-Identifier: MIT
// The first thing that the compiler says.
#include "myriad/myriad.hpp"
