// SPDX-License-Identifier: MIT
// Reports a language standard that is too old before the compiler fails on everything else. Included first by public
// headers.
#pragma once

#if __cplusplus < 202002L
#error "Myriad is written in C++20, and this file is compiled as an older C++: give the compiler -std=c++20"
#endif
