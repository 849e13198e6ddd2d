// SPDX-License-Identifier: MIT
// Compiles the kernel of the Lorenz system, and reports the instruction set.
#include <myriad/instantiate.hpp>

#include "equations.hpp"
#include "problems/lorenz.hpp"

MYRIAD_INSTANTIATE(problems::fused_lorenz, myriad::runge_kutta_4)

#define CPU_PEERS_TEXT_OF(name) #name
#define CPU_PEERS_TEXT(name) CPU_PEERS_TEXT_OF(name)

namespace cpu_peers::lorenz {

const char* instruction_set() { return CPU_PEERS_TEXT(MYRIAD_TARGET); }

}  // namespace cpu_peers::lorenz
