// SPDX-License-Identifier: MIT
// SIGINT and SIGTERM as a request to stop, for as long as a study runs. Host code only.
#pragma once

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// During its lifetime the first of these signals is remembered; a second one of the same kind ends the program as it
/// would have before, unless it comes within a second: batch systems and launchers send one signal several times. One
/// object at a time.
class stop_signals {
public:
    stop_signals();
    stop_signals(const stop_signals&) = delete;
    stop_signals& operator=(const stop_signals&) = delete;
    ~stop_signals();

    /// Whether one came.
    bool came() const;
    /// The number of a signal that came during the lifetime of the last object, which may be over; 0 if none did.
    static int last();
};

}  // namespace myriad::studies::inline MYRIAD_ABI
