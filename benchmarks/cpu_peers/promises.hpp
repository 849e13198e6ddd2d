// SPDX-License-Identifier: MIT
// What Myriad promises of its speed, for the tests to hold it to.
#pragma once

namespace cpu_peers {

/// Measures what is promised and prints one line for each promise; returns whether all are kept.
bool check_promises();

}  // namespace cpu_peers
