// expect: Myriad is compiled with -ffast-math
// flags: -ffinite-math-only
// SPDX-License-Identifier: MIT
// What was never set is NaN, and would not be found.
#include "myriad/myriad.hpp"

int main() {}
