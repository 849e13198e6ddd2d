// SPDX-License-Identifier: MIT
// A GPU made of host memory and threads, so that the GPU code of `solve` and `solver` runs where there is no GPU: a
// program that links simulated_gpu.cpp has it as device "cuda". This is how tests control and observe it.
#pragma once

#include <atomic>
#include <cstdint>

namespace simulated {

/// For several threads, without any ordering between them, so that a thread sanitizer sees only the library's own.
template <class T>
class unordered {
public:
    constexpr unordered(T value = {}) : value_(value) {}
    operator T() const { return value_.load(std::memory_order_relaxed); }
    T operator=(T value) { return value_.exchange(value, std::memory_order_relaxed); }  // returns the old value
    T operator+=(T value) { return value_.fetch_add(value, std::memory_order_relaxed) + value; }

private:
    std::atomic<T> value_;
};

/// Points of failure: pinning, calls of an engine, or a kernel, whose failure is reported by the calls after
/// `integrate`.
enum class call { none, make_engine, reserve, upload, integrate, kernel, download, wait, pin };

struct gpu {
    unordered<std::int64_t> memory = std::int64_t{1} << 40, used;  // bytes
    unordered<std::uint64_t> longest_delay, seed;                  // of the work, in microseconds; random up to this
    unordered<call> fails_at;                                      // throws `error`, once,
    unordered<int> calls_before;                                   // after so many successful calls
    unordered<int> under_way;                                      // tasks enqueued on all engines and not finished
    unordered<bool> wrote;                                         // to arrays of the host
    unordered<bool> seems_idle;                                    // at once, like a GPU too fast for the host

    void fail(call kind, int after) {
        calls_before = after;
        fails_at = kind;
    }
    bool has_failed() const { return calls_before < 0; }
    /// Fails if a failure is due.
    void meet(call kind);
};
inline gpu the_gpu;

/// Ends the program, and so the test, unless the condition holds.
void demand(bool condition, const char* misuse);
/// Whether the device may copy to and from this place asynchronously, at any time before the next `wait`.
bool is_pinned(const void* place);

}  // namespace simulated
