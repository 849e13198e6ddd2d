// SPDX-License-Identifier: MIT
// Waiting for one of several things. Host code only.
#pragma once

#include <chrono>
#include <future>
#include <thread>

namespace myriad::host {

/// Whether what the future promises has come.
template <class Future>
bool is_over(const Future& awaited, std::chrono::microseconds wait = {}) {
    return awaited.wait_for(wait) == std::future_status::ready;
}

/// For a thread that waits for one of several things: it looks again at once while that may save some of the time of a chunk, and
/// later sleeps in between.
class patience {
public:
    template <class Future>
    bool is_over(const Future& awaited) {
        const bool sleeps = std::chrono::steady_clock::now() - begin_ > std::chrono::milliseconds{5};
        if (!sleeps) std::this_thread::yield();
        return host::is_over(awaited, std::chrono::microseconds{sleeps ? 50 : 0});
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace myriad::host
