// SPDX-License-Identifier: MIT
// The machine and the build in the header of the output, without which figures cannot be compared.
#pragma once

#include <string>
#include <vector>

namespace cpu_peers {

/// The compiler as one CSV field, such as "GNU 12.2.0".
std::string compiler();
/// The instruction set of the models as one CSV field, such as "avx512".
std::string instruction_set();
/// Lines for the header: compiler, flags, CPU, instruction set, commit.
std::vector<std::string> describe_machine();

}  // namespace cpu_peers
