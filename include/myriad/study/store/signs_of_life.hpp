// SPDX-License-Identifier: MIT
// Whether a process that cannot be asked for still gives signs of life, seen without comparing clocks: those of other
// machines may be wrong, and any clock may be set.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// Remembers the signs of others, and for how long it has seen each of them unchanged. Functions may be called by
/// several threads at a time.
class signs_of_life {
public:
    explicit signs_of_life(std::chrono::nanoseconds expiry) : expiry_(expiry) {}

    /// Whether the sign of `who` has not changed for longer than the expiry. Of the time between two looks no more than
    /// a quarter of it counts, since whoever looks may have been stopped or suspended together with the other.
    bool is_silent(const std::string& who, std::int64_t sign);

private:
    struct seen {
        std::int64_t sign;
        std::chrono::steady_clock::time_point looked;  // not of a clock that can be set
        std::chrono::nanoseconds unchanged;
    };
    std::chrono::nanoseconds expiry_;
    std::mutex mutex_;
    std::map<std::string, seen> seen_;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
