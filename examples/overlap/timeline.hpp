// SPDX-License-Identifier: MIT
// The steps of each solver object on the host's clock, and how much of them overlapped.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

/// The steps of a chunk, in this order.
enum class step { fill, upload, integrate, download, write };

/// Times in seconds since the timeline's start.
struct interval {
    int solver = 0;
    std::int64_t chunk = 0;
    step what = step::fill;
    double begin = 0, end = 0;
    double kernel_seconds = 0;  // the device's own, for `integrate`
};

/// Thread-safe.
class timeline {
public:
    // snippet: during
    /// Runs `task` and records when it began and returned.
    template <class Task>
    void during(step what, int solver, std::int64_t chunk, Task&& task) {
        const double begin = now();
        task();
        const double end = now();
        const std::lock_guard lock(mutex_);
        intervals_.push_back({solver, chunk, what, begin, end});
    }
    // end of snippet
    /// Adds the device's own time for the solver's last integration.
    void set_kernel_seconds(int solver, std::int64_t chunk, double seconds) {
        const std::lock_guard lock(mutex_);
        for (interval& i : intervals_)
            if (i.solver == solver && i.chunk == chunk && i.what == step::integrate) i.kernel_seconds = seconds;
    }

    /// In the order of their beginning. Call it when no thread is at work.
    std::vector<interval> sorted() const {
        auto all = intervals_;
        std::sort(all.begin(), all.end(), [](const interval& a, const interval& b) {
            return std::pair(a.begin, a.solver) < std::pair(b.begin, b.solver);
        });
        return all;
    }

private:
    using clock = std::chrono::steady_clock;
    double now() const { return std::chrono::duration<double>(clock::now() - start_).count(); }

    clock::time_point start_ = clock::now();
    std::mutex mutex_;
    std::vector<interval> intervals_;
};

/// Seconds during which at least `least` of the intervals were in progress.
inline double seconds_with(const std::vector<interval>& all, int least) {
    std::vector<std::pair<double, int>> changes;  // at equal times, ends come before beginnings
    for (const interval& i : all) {
        changes.emplace_back(i.begin, 1);
        changes.emplace_back(i.end, -1);
    }
    std::sort(changes.begin(), changes.end());
    double seconds = 0, since = 0;
    int under_way = 0;
    for (const auto& [t, change] : changes) {
        if (under_way >= least) seconds += t - since;
        since = t;
        under_way += change;
    }
    return seconds;
}
