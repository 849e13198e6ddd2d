// expect: Myriad is compiled with -ffast-math
// flags: -ffinite-math-only
// SPDX-License-Identifier: MIT
// Values never set are NaN, and would not be found.
#include "myriad/myriad.hpp"

int main() {}
