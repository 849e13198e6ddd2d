// SPDX-License-Identifier: MIT
// What every implementation of a case is given and what it returns: plain pointers, because host and implementations are
// compiled for different instruction sets and must share no inline code.
#pragma once

#include <cstdint>

#include <time.h>

namespace cpu_peers {

/// How an instance ended. The peers tell apart only what the cases need.
enum class ending : unsigned char { completed, accumulated, failed };
inline constexpr int ending_count = 3;

/// One sweep over parameters. Component c of instance i is at `[c * instances + i]`.
struct sweep {
    std::int64_t instances;
    int phases;
    int threads;
    const double* parameters;
    double* states;          ///< at the start on entry, at the end on return
    std::int64_t* accepted;  ///< accepted steps of each instance
    ending* endings;
};

/// What a run took: the integration alone, without the setting up of arrays.
struct outcome {
    double cpu_seconds = 0;  ///< of all threads
    int lanes = 1;           ///< instances side by side in one thread
    double idle_share = 0;   ///< share of lane steps in which the lane had nothing to do
};

using implementation_function = outcome (*)(const sweep&);

/// CPU time of this process in seconds.
inline double cpu_clock() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Times the integration.
template <class Integration>
outcome timed(Integration&& integration) {
    const double begin = cpu_clock();
    integration();
    outcome result;
    result.cpu_seconds = cpu_clock() - begin;
    return result;
}

}  // namespace cpu_peers
