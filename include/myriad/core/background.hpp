// SPDX-License-Identifier: MIT
// A thread that does what it is asked, in order, while the one that asks goes on. Host code only.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

namespace myriad::host {

class background {
public:
    background() = default;
    background(const background&) = delete;
    background& operator=(const background&) = delete;
    /// Waits for the task at work; those after it are dropped.
    ~background() {
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
            tasks_.clear();
        }
        changed_.notify_one();
        if (thread_.joinable()) thread_.join();
    }

    /// What the task throws, the future does.
    std::future<void> ask(std::function<void()> task) {
        std::packaged_task<void()> packed(std::move(task));
        std::future<void> done = packed.get_future();
        {
            const std::lock_guard lock(mutex_);
            tasks_.push_back(std::move(packed));
            if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
        }
        changed_.notify_one();
        return done;
    }

private:
    void work() {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [this] { return over_ || !tasks_.empty(); });
            if (over_) return;
            std::packaged_task<void()> next = std::move(tasks_.front());
            tasks_.pop_front();
            lock.unlock();
            next();
            lock.lock();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::packaged_task<void()>> tasks_;
    bool over_ = false;
    std::thread thread_;
};

}  // namespace myriad::host
