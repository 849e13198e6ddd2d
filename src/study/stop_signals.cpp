// SPDX-License-Identifier: MIT
// Handlers of signals.
#include "myriad/study/stop_signals.hpp"

#include <atomic>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

std::atomic<bool> signal_came{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // as a handler needs

extern "C" void remember_signal(int) { signal_came = true; }

}  // namespace

stop_signals::stop_signals() {
    signal_came = false;
    struct sigaction handler {};
    handler.sa_handler = &remember_signal;
    handler.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
    sigemptyset(&handler.sa_mask);
    sigaction(SIGINT, &handler, &interrupt_);
    sigaction(SIGTERM, &handler, &terminate_);
}
stop_signals::~stop_signals() {
    sigaction(SIGINT, &interrupt_, nullptr);
    sigaction(SIGTERM, &terminate_, nullptr);
}

bool stop_signals::came() const { return signal_came; }

}  // namespace myriad::studies::inline MYRIAD_ABI
