// SPDX-License-Identifier: MIT
// Handlers of signals.
#include "myriad/study/run/stop_signals.hpp"

#include <atomic>
#include <cstdint>

#include <signal.h>
#include <time.h>

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

/// A signal that a handler has to know of.
struct watched_signal {
    int number;
    struct sigaction before {};           // the handler that was there
    std::atomic<std::int64_t> since{-1};  // milliseconds of the clock when it came; -1: it did not
};
watched_signal watched[] = {{SIGINT}, {SIGTERM}};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);  // as a handler needs

std::int64_t now() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return std::int64_t{1000} * time.tv_sec + time.tv_nsec / 1'000'000;
}

extern "C" void remember_signal(int number) {
    constexpr std::int64_t repeats = 1000;  // milliseconds
    for (watched_signal& w : watched) {
        if (w.number != number) continue;
        std::int64_t none = -1;
        if (w.since.compare_exchange_strong(none, now()) || now() - none <= repeats) return;
        sigaction(number, &w.before, nullptr);
        raise(number);  // which comes when this handler returns
    }
}

}  // namespace

stop_signals::stop_signals() {
    struct sigaction handler {};
    handler.sa_handler = &remember_signal;
    handler.sa_flags = SA_RESTART;
    sigemptyset(&handler.sa_mask);
    for (watched_signal& w : watched) {
        w.since = -1;
        sigaction(w.number, nullptr, &w.before);  // before it can be needed
        sigaction(w.number, &handler, nullptr);
    }
}
stop_signals::~stop_signals() {
    for (const watched_signal& w : watched) sigaction(w.number, &w.before, nullptr);
}

bool stop_signals::came() const { return last() != 0; }

int stop_signals::last() {
    for (const watched_signal& w : watched)
        if (w.since >= 0) return w.number;
    return 0;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
