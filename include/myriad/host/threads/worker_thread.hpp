// SPDX-License-Identifier: MIT
// A thread that runs submitted tasks in order, asynchronously. Host code only.
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

#include "myriad/host/threads/object_pool.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

class worker_thread {
public:
    worker_thread() = default;
    worker_thread(const worker_thread&) = delete;
    worker_thread& operator=(const worker_thread&) = delete;
    ~worker_thread() {
        forget();
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        changed_.notify_all();
        if (thread_.joinable()) thread_.join();
    }

    /// The future rethrows what the task throws.
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

/// A worker borrowed from a pool: creating a thread, and the team for its loops, takes long compared with a short
/// kernel.
class pooled_worker {
public:
    pooled_worker() : taken_(idle::all().take({})) {
        if (taken_ == nullptr) taken_ = std::make_unique<worker_thread>();
    }
    pooled_worker(const pooled_worker&) = delete;
    pooled_worker& operator=(const pooled_worker&) = delete;
    /// Waits for the task at work; those after it are dropped.
    ~pooled_worker() {
        taken_->forget();
        idle::all().give({}, std::move(taken_));
    }
    worker_thread* operator->() const { return taken_.get(); }

private:
    using idle = object_pool<std::monostate, worker_thread>;

    std::unique_ptr<worker_thread> taken_;
};

}  // namespace myriad::host::inline MYRIAD_ABI
