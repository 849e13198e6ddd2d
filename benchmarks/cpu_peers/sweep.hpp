// SPDX-License-Identifier: MIT
// The input and output of every implementation of a case: plain pointers, because host and implementations are compiled
// for different instruction sets and must share no inline code.
#pragma once

#include <cstdint>

#include <time.h>

namespace cpu_peers {

/// How an instance ended; only as detailed as the cases need.
enum class ending : unsigned char { completed, accumulated, failed };
inline constexpr int ending_count = 3;

/// One sweep over parameters. Component c of instance i is at `[c * instances + i]`.
struct sweep {
    std::int64_t instances;
    int phases;
    int threads;
    double tolerance;        ///< of steps, relative and absolute; 0: fixed steps
    double event_tolerance;  ///< of event functions; 0: no events
    const double* parameters;
    double* states;          ///< at the start on entry, at the end on return
    std::int64_t* accepted;  ///< accepted steps of each instance
    ending* endings;
};

/// The times of a run: the integration alone, without the set-up of arrays.
struct outcome {
    double cpu_seconds = 0;  ///< of all threads
    double wall_seconds = 0;
    int lanes = 1;          ///< SIMD lanes: instances per thread at a time
    double idle_share = 0;  ///< fraction of lane steps in which the lane was idle
};

using implementation_function = outcome (*)(const sweep&);

/// Seconds on one of the system's clocks.
inline double seconds_of(clockid_t clock) {
    timespec now;
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
/// CPU time of this process in seconds.
inline double cpu_clock() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

/// Times the integration.
template <class Integration>
outcome timed(Integration&& integration) {
    const double cpu_begin = cpu_clock(), wall_begin = seconds_of(CLOCK_MONOTONIC);
    integration();
    outcome result;
    result.cpu_seconds = cpu_clock() - cpu_begin;
    result.wall_seconds = seconds_of(CLOCK_MONOTONIC) - wall_begin;
    return result;
}

}  // namespace cpu_peers
