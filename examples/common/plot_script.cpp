// SPDX-License-Identifier: MIT
// Compiled anew for each program, as each has a script of its own.
#include "command_line.hpp"

namespace examples {

const char* const plot_script = MYRIAD_PLOT_SCRIPT;

}  // namespace examples
