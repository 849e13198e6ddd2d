// SPDX-License-Identifier: MIT
// The command-line program. Host code only.
#pragma once

namespace myriad::programs {

/// Does what the arguments say, and returns the exit status: 0 done, 1 a failure, 2 bad input, 128 and the number of
/// the signal that stopped a study.
int run_program(int argc, const char* const* argv);

}  // namespace myriad::programs
