// SPDX-License-Identifier: MIT
// Passes progress from a backend to the user's function, and says when a call is to stop: when that function throws, or
// its time is over.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>

#include "myriad/host/backend/cpu_backend.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Forwards progress from a backend, which must not see exceptions, to the user's function, which may throw.
struct progress_relay {
    using clock = std::chrono::steady_clock;
    /// Instances under way have that long to end once the function has thrown.
    static constexpr auto patience = std::chrono::milliseconds(500);
    static constexpr auto ask_every = std::chrono::milliseconds(20);

    const std::function<void(std::int64_t, std::int64_t)>& function;
    std::int64_t total;
    std::exception_ptr failure;
    std::int64_t last_done = 0;
    clock::time_point last_call = clock::now(), failed_at{};
    clock::time_point deadline = clock::time_point::max();
    bool over = false;  // the deadline has passed with work left

    /// When a call that begins now is to end; 0 seconds: never.
    static clock::time_point deadline_in(double seconds) {
        constexpr double never = 1e9;  // in three decades, and still far from where clocks overflow
        if (!(seconds > 0 && seconds < never)) return clock::time_point::max();
        return clock::now() + std::chrono::duration_cast<clock::duration>(std::chrono::duration<double>(seconds));
    }
    /// Whether anything can stop the call.
    bool may_stop() const { return function || deadline != clock::time_point::max(); }

    /// `done` instances are done. False once the function has thrown: no further instance is to be begun.
    static bool call(void* context, std::int64_t done) {
        auto& relay = *static_cast<progress_relay*>(context);
        if (relay.failure || !relay.function) return !relay.failure;
        relay.last_done = done;
        relay.last_call = clock::now();
        try {
            relay.function(done, relay.total);
        } catch (...) {
            relay.failure = std::current_exception();
            relay.failed_at = clock::now();
        }
        return !relay.failure;
    }
    /// Whether to stop. Calls the function again if the last call was long ago, as no instance has ended since.
    static detail::stop_request ask(void* context) {
        auto& relay = *static_cast<progress_relay*>(context);
        const auto now = clock::now();
        if (!relay.failure && now - relay.last_call > ask_every) call(context, relay.last_done);
        if (!relay.failure && now >= relay.deadline) relay.over = true;
        if (relay.over) return detail::stop_request::end_all;
        if (!relay.failure) return detail::stop_request::none;
        return now - relay.failed_at > patience ? detail::stop_request::end_now : detail::stop_request::begin_no_more;
    }
};

}  // namespace myriad::host::inline MYRIAD_ABI
