// SPDX-License-Identifier: MIT
// Threads that take turns in the order of their arrival, which a mutex does not guarantee.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

class turns {
public:
    /// Runs `task` when all earlier ones have finished.
    template <class Task>
    void take(Task&& task) {
        std::unique_lock lock(mutex_);
        const std::int64_t mine = next_++;
        changed_.wait(lock, [&] { return served_ == mine; });
        lock.unlock();
        const end_of_turn end{*this};  // ends the turn of a failed task too
        task();
    }

private:
    struct end_of_turn {
        turns& all;
        ~end_of_turn() {
            const std::lock_guard lock(all.mutex_);
            ++all.served_;
            all.changed_.notify_all();
        }
    };

    std::mutex mutex_;
    std::condition_variable changed_;
    std::int64_t next_ = 0, served_ = 0;
};
