// SPDX-License-Identifier: MIT
// Where the lanes of the OpenMP backend get their instances: chunks of consecutive indices, handed to whichever thread
// asks, so that no thread waits for another.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "myriad/backend.hpp"
#include "myriad/core/macros.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// One thread's view of the ensemble; `next()` is all the loop knows of it.
class chunked_instances {
public:
    /// `begun` counts the instances handed out, over all threads; `order`, if not null, says which they are. `reports`: this
    /// thread calls the progress function.
    chunked_instances(std::atomic<std::int64_t>& begun, std::int64_t size, std::int64_t chunk, const std::uint32_t* order,
                      const run_options& options, bool reports)
        : begun_(begun), size_(size), chunk_(chunk), order_(order), options_(options),
          reports_(reports && options.progress) {}

    /// The next instance, or -1 when all are taken. If the progress function says no, none is handed out any more.
    std::int64_t next() {
        if (next_ == end_) {
            next_ = std::min(begun_.fetch_add(chunk_, std::memory_order_relaxed), size_);
            end_ = std::min(next_ + chunk_, size_);
            if (reports_ && !options_.progress(options_.context, next_)) begun_.store(size_, std::memory_order_relaxed);
            if (next_ == end_) return -1;
        }
        const std::int64_t place = next_++;
        return order_ != nullptr ? order_[place] : place;
    }

private:
    std::atomic<std::int64_t>& begun_;
    std::int64_t size_, chunk_;
    const std::uint32_t* order_;
    const run_options& options_;
    bool reports_;
    std::int64_t next_ = 0, end_ = 0;
};

}  // namespace myriad::inline MYRIAD_TARGET
