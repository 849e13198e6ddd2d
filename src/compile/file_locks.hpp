// SPDX-License-Identifier: MIT
// Locks that the processes which share a folder have of each other. Host code only.
#pragma once

#include <string>

#include "compile/child_process.hpp"

namespace myriad::compiling {

/// Takes a lock, a file of that name; -1 if another process has it and `wait` is false, or if there are no locks here.
int take_lock(int folder, const std::string& name, bool wait, const signal_check& check = {});
/// Gives it back, unless it is -1.
void give_lock_back(int folder, const std::string& name, int file);

}  // namespace myriad::compiling
