// SPDX-License-Identifier: MIT
// Passes progress from a backend to the user's function.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Forwards progress from a backend, which must not see exceptions, to the user's function, which may throw.
struct progress_relay {
    const std::function<void(std::int64_t, std::int64_t)>& function;
    std::int64_t total;
    std::exception_ptr failure;

    /// `done` instances are done. False once the function has thrown: no further instance is to be begun.
    static bool call(void* context, std::int64_t done) {
        auto& relay = *static_cast<progress_relay*>(context);
        if (relay.failure || !relay.function) return !relay.failure;
        try {
            relay.function(done, relay.total);
        } catch (...) {
            relay.failure = std::current_exception();
        }
        return !relay.failure;
    }
};

}  // namespace myriad::host::inline MYRIAD_ABI
