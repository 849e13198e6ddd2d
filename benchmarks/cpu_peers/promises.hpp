// SPDX-License-Identifier: MIT
// The speed that Myriad promises, for the tests to check.
#pragma once

namespace cpu_peers {

/// Measures the promised ratios and prints a line for each try; returns whether all promises are kept. `slack` is the
/// fraction by which a ratio may miss its promise, for machines that others use too.
bool check_promises(double slack);

}  // namespace cpu_peers
