// SPDX-License-Identifier: MIT
// The last check before a program ends: output fails on a full disk, which is reported only on request.
#pragma once

#include <cstdio>
#include <iostream>

namespace examples {

/// The exit status of a program that has written to standard output: `status`, or `broken` if the writing failed.
inline int after_output(int status, int broken = 2) {
    if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
    std::cerr << "standard output cannot be written\n";
    return broken;
}

}  // namespace examples
