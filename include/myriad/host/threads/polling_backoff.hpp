// SPDX-License-Identifier: MIT
// Waiting for one of several things. Host code only.
#pragma once

#include <chrono>
#include <future>
#include <thread>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Whether the future is ready.
template <class Future>
bool is_over(const Future& awaited, std::chrono::microseconds wait = {}) {
    return awaited.wait_for(wait) == std::future_status::ready;
}

/// For a thread that polls several conditions: it polls without a pause while that may save a part of a chunk's time,
/// and later sleeps in between.
class polling_backoff {
public:
    template <class Future>
    bool is_over(const Future& awaited) {
        if (!sleeps()) std::this_thread::yield();
        return host::is_over(awaited, std::chrono::microseconds{sleeps() ? 50 : 0});
    }
    /// The pause alone.
    void pause() const {
        if (sleeps()) {
            std::this_thread::sleep_for(std::chrono::microseconds{50});
        } else {
            std::this_thread::yield();
        }
    }

private:
    bool sleeps() const { return std::chrono::steady_clock::now() - begin_ > std::chrono::milliseconds{5}; }

    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace myriad::host::inline MYRIAD_ABI
