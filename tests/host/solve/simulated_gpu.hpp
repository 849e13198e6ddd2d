// SPDX-License-Identifier: MIT
// A GPU made of the host's memory and threads, so that what `solve` and `solver` do with one runs where there is none:
// a program that links simulated_gpu.cpp has it as device "cuda". Here is what tests can do to it, and what it notices.
#pragma once

#include <atomic>
#include <cstdint>

namespace simulated {

/// For several threads, without any order between them: a thread sanitizer sees none but the library's own.
template <class T>
class unordered {
public:
    constexpr unordered(T value = {}) : value_(value) {}
    operator T() const { return value_.load(std::memory_order_relaxed); }
    T operator=(T value) { return value_.exchange(value, std::memory_order_relaxed); }  // the one before
    T operator+=(T value) { return value_.fetch_add(value, std::memory_order_relaxed) + value; }

private:
    std::atomic<T> value_;
};

/// What can fail: pinning, calls of an engine, or a kernel, of which calls after `integrate` are told.
enum class call { none, make_engine, reserve, upload, integrate, kernel, download, wait, pin };

struct gpu {
    unordered<std::int64_t> memory = std::int64_t{1} << 40, used;  // bytes
    unordered<std::uint64_t> longest_delay, seed;                  // of the work, in microseconds; at random
    unordered<call> fails_at;                                      // throws `error`, once,
    unordered<int> calls_before;                                   // after so many that do not
    unordered<int> under_way;                                      // asked of all engines, and not done
    unordered<bool> wrote;                                         // to arrays of the host
    unordered<bool> seems_idle;                                    // at once, as one too fast for the host

    void fail(call kind, int after) {
        calls_before = after;
        fails_at = kind;
    }
    bool has_failed() const { return calls_before < 0; }
    /// Fails if it is to.
    void meet(call kind);
};
inline gpu the_gpu;

/// Ends the program, which no test survives, unless the condition holds.
void demand(bool condition, const char* misuse);
/// Whether the device may copy from and to there by itself, at any time before the next `wait`.
bool is_pinned(const void* place);

}  // namespace simulated
