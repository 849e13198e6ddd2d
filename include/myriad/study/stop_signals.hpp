// SPDX-License-Identifier: MIT
// SIGINT and SIGTERM as a request to stop, for as long as a study runs. Host code only.
#pragma once

#include <signal.h>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// During its lifetime the first of these signals is remembered; a second one of the same kind ends the program as it
/// would have before. One at a time.
class stop_signals {
public:
    stop_signals();
    stop_signals(const stop_signals&) = delete;
    stop_signals& operator=(const stop_signals&) = delete;
    ~stop_signals();

    /// Whether one came.
    bool came() const;

private:
    struct sigaction interrupt_, terminate_;  // what was there before
};

}  // namespace myriad::studies::inline MYRIAD_ABI
