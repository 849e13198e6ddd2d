// SPDX-License-Identifier: MIT
// Says that the language is too old before the compiler says so of everything else. Included first by what users include.
#pragma once

#if __cplusplus < 202002L
#error "Myriad is written in C++20, and this file is compiled as an older C++: give the compiler -std=c++20"
#endif
