// SPDX-License-Identifier: MIT
// What Myriad promises of its speed, for the tests to hold it to.
#pragma once

namespace cpu_peers {

/// Measures what is promised and prints a line for each try; returns whether all promises are kept. `slack` is the part
/// by which a ratio may miss what is promised, for machines that others use too.
bool check_promises(double slack);

}  // namespace cpu_peers
