// SPDX-License-Identifier: MIT
// A thread that does what it is asked, in order, while the one that asks goes on. Host code only.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include "myriad/core/kept.hpp"

namespace myriad::host {

class background {
public:
    background() = default;
    background(const background&) = delete;
    background& operator=(const background&) = delete;
    ~background() {
        forget();
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        changed_.notify_all();
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
        changed_.notify_all();
        return done;
    }
    /// Waits for the task at work; those after it are dropped.
    void forget() {
        std::unique_lock lock(mutex_);
        tasks_.clear();
        changed_.wait(lock, [this] { return !at_work_; });
    }

private:
    void work() {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [this] { return over_ || !tasks_.empty(); });
            if (over_) return;
            std::packaged_task<void()> next = std::move(tasks_.front());
            tasks_.pop_front();
            at_work_ = true;
            lock.unlock();
            next();
            lock.lock();
            at_work_ = false;
            changed_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::packaged_task<void()>> tasks_;
    bool over_ = false, at_work_ = false;
    std::thread thread_;
};

/// One that is borrowed for a while, as a new thread, and those that it takes for its loops, take long to make beside a short
/// kernel.
class lent_background {
public:
    lent_background() : taken_(idle::all().take({})) {
        if (taken_ == nullptr) taken_ = std::make_unique<background>();
    }
    lent_background(const lent_background&) = delete;
    lent_background& operator=(const lent_background&) = delete;
    /// Waits for the task at work; those after it are dropped.
    ~lent_background() {
        taken_->forget();
        idle::all().give({}, std::move(taken_));
    }
    background* operator->() const { return taken_.get(); }

private:
    using idle = kept<std::monostate, background>;

    std::unique_ptr<background> taken_;
};

}  // namespace myriad::host
