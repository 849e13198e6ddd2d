// SPDX-License-Identifier: MIT
// The commands that show, export and draw results. Host code only.
#pragma once

#include <string>
#include <vector>

#include "myriad/study/plan/layout.hpp"

namespace myriad::programs {

/// Says how much of the results is not there yet. Throws `error` if all of it is asked for.
void tell_missing(const studies::results& from, bool require_complete);
/// Writes a file whose kind its name tells. `variable`: of an NPY file.
void export_results(const studies::results& from, const std::string& path, const std::string& variable);
/// Shows what is in a folder of results. Returns the exit status.
int info(const std::string& folder, bool verify, bool as_json);
/// Runs the script that draws, with all arguments of the command, which it knows. Returns the exit status.
int plot(const std::vector<std::string>& arguments);

}  // namespace myriad::programs
