// SPDX-License-Identifier: MIT
// The chunks of a call on GPUs: who takes which, and which are back. Host code only.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>

#include "myriad/host/chunks/chunk_plan.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Instances [first, first + count); none are left if `count` is 0.
struct chunk {
    std::int64_t first = 0, count = 0;
};

/// Hands out the chunks of a plan in the order of their instances. They come back in any order, from several threads.
class chunk_queue {
public:
    chunk_queue(const chunk_plan& plan, std::int64_t size) : plan_(plan), size_(size) {}

    chunk take() {
        const std::lock_guard lock(mutex_);
        const chunk next{next_, next_ < size_ ? plan_.count_from(next_) : 0};
        next_ += next.count;
        return next;
    }
    /// Instances [begin, end) are in the ensemble again. Returns how many are by now.
    std::int64_t bring_back(std::int64_t begin, std::int64_t end) {
        const std::lock_guard lock(mutex_);
        back_ += end - begin;
        ahead_.emplace(begin, end);
        for (auto it = ahead_.begin(); it != ahead_.end() && it->first == back_until_; it = ahead_.erase(it))
            back_until_ = it->second;
        return back_;
    }
    std::int64_t back() const {
        const std::lock_guard lock(mutex_);
        return back_;
    }
    /// The instance before which all are back.
    std::int64_t back_until() const {
        const std::lock_guard lock(mutex_);
        return back_until_;
    }
    /// Calls `leave` with each instance that is not back; from then on all are.
    template <class Leave>
    void give_up(Leave&& leave) {
        const std::lock_guard lock(mutex_);
        ahead_.emplace(size_, size_);
        for (const auto& [begin, end] : ahead_) {
            for (std::int64_t i = back_until_; i < begin; ++i) leave(i);
            back_until_ = end;
        }
        ahead_.clear();
        back_ = size_;
    }

private:
    const chunk_plan plan_;
    const std::int64_t size_;
    mutable std::mutex mutex_;
    std::int64_t next_ = 0, back_ = 0, back_until_ = 0;
    std::map<std::int64_t, std::int64_t> ahead_;  // first instances and ends of chunks that are back before others
};

}  // namespace myriad::host::inline MYRIAD_ABI
