// SPDX-License-Identifier: MIT
// The order in which the threads of a simulated team run.
#pragma once

namespace teams {

/// Who comes first between two points at which the threads of a team wait for each other.
enum class order { first_thread_first, last_thread_first };
inline order order_of_threads = order::first_thread_first;

}  // namespace teams
