// SPDX-License-Identifier: MIT
// The core's threads: a pool that is never destroyed, since its threads may outlive the interpreter.
#include "threads.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <vector>

#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include "myriad/host/threads/default_arithmetic.hpp"

namespace myriad::python {
namespace {

constexpr std::size_t usual_stack = std::size_t{8} << 20;

/// Where the calling thread's stack ends; 0 if the system does not tell.
std::uintptr_t end_of_stack() {
    pthread_attr_t attributes;
    if (pthread_getattr_np(pthread_self(), &attributes) != 0) return 0;
    void* lowest = nullptr;
    std::size_t size = 0, guard = 0;
    pthread_attr_getstack(&attributes, &lowest, &size);
    pthread_attr_getguardsize(&attributes, &guard);
    pthread_attr_destroy(&attributes);
    return reinterpret_cast<std::uintptr_t>(lowest) + guard;
}

/// Unused bytes of the calling thread's stack, of which a call wants so many; SIZE_MAX if the system does not tell. Of
/// the main thread the system reads a list of all mappings, which takes longer than a small call: the end is kept, and
/// asked for again if the stack looks too small, as its limit may have been raised.
std::size_t stack_left(std::size_t wanted) {
    static thread_local std::uintptr_t end = end_of_stack();
    const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
    if (end != 0 && here < end + wanted) end = end_of_stack();
    return end == 0 || here < end ? SIZE_MAX : here - end;
}

/// One team's parts, handed out to the threads that work on them.
struct shared_parts {
    openmp::team* all;
    std::atomic<int> next{1};
    std::atomic<int> threads{1};

    void work() {
        const detail::default_arithmetic here;
        int done = 0;
        for (int part; (part = next++) < all->parts; ++done) all->body(all->context, part);
        if (done > 0) ++threads;
    }
    void work_as_caller() {
        const detail::default_arithmetic here;
        all->body(all->context, 0);
        for (int part; (part = next++) < all->parts;) all->body(all->context, part);
        // The others count themselves when they are done.
    }
};

bool start_thread(pthread_t& made, std::size_t stack, void* (*begin)(void*), void* argument) {
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes) != 0) return false;
    pthread_attr_setstacksize(&attributes, stack);
    const bool started = pthread_create(&made, &attributes, begin, argument) == 0;
    pthread_attr_destroy(&attributes);
    return started;
}

/// Threads created for one team, and joined at its end.
void run_with_own_threads(shared_parts& parts, std::size_t stack) {
    std::vector<pthread_t> others;
    for (int i = 1; i < parts.all->parts; ++i) {
        pthread_t made;
        const auto begin = [](void* p) -> void* {
            static_cast<shared_parts*>(p)->work();
            return nullptr;
        };
        if (!start_thread(made, stack, begin, &parts)) break;
        others.push_back(made);
    }
    parts.work_as_caller();
    for (const pthread_t other : others) pthread_join(other, nullptr);
}

/// Threads that sleep until there is a team.
class thread_pool {
public:
    explicit thread_pool(pid_t owner) : owner_(owner) {}

    /// The pool of this process.
    static thread_pool& here() {
        static std::atomic<thread_pool*> only{nullptr};
        thread_pool* found = only.load();
        const pid_t now = getpid();
        while (found == nullptr || found->owner_ != now) {
            // That of a parent process has no threads here, and its locks may be held for ever.
            auto* const made = new thread_pool(now);
            if (only.compare_exchange_strong(found, made)) return *made;
            delete made;
        }
        return *found;
    }

    /// False if another team is at work.
    bool run(shared_parts& parts) {
        const std::unique_lock at_work(busy_, std::try_to_lock);
        if (!at_work.owns_lock()) return false;
        const int wanted = parts.all->parts - 1;
        {
            const std::lock_guard lock(mutex_);
            while (made_ < wanted) {
                pthread_t thread;
                if (!start_thread(thread, usual_stack, &begin, this)) break;
                pthread_detach(thread);
                ++made_;
            }
            parts_ = &parts;
            invited_ = std::min(wanted, made_);
        }
        if (wanted < made_) {
            for (int i = 0; i < wanted; ++i) called_.notify_one();
        } else {
            called_.notify_all();
        }
        parts.work_as_caller();
        std::unique_lock lock(mutex_);
        invited_ = 0;  // those that have not come yet need not
        over_.wait(lock, [this] { return working_ == 0; });
        parts_ = nullptr;
        return true;
    }

private:
    static void* begin(void* argument) {
        static_cast<thread_pool*>(argument)->wait_for_teams();
        return nullptr;
    }
    void wait_for_teams() {
        std::unique_lock lock(mutex_);
        for (;;) {
            called_.wait(lock, [this] { return invited_ > 0; });
            --invited_;
            ++working_;
            shared_parts& parts = *parts_;
            lock.unlock();
            parts.work();
            lock.lock();
            if (--working_ == 0) over_.notify_one();
        }
    }

    const pid_t owner_;
    std::mutex busy_, mutex_;
    std::condition_variable called_, over_;
    shared_parts* parts_ = nullptr;
    int made_ = 0, invited_ = 0, working_ = 0;
};

}  // namespace

void start_team(openmp::team* all) {
    const std::size_t here = stack_left(all->stack);
    const std::size_t of_others = std::max(usual_stack, 2 * all->stack);
    all->least_stack = all->parts > 1 ? std::min(here, of_others) : here;
    all->threads = 1;
    if (all->least_stack < all->stack) return;
    shared_parts parts{all};
    if (all->parts <= 1) {
        parts.work_as_caller();
    } else if (of_others > usual_stack || !thread_pool::here().run(parts)) {
        run_with_own_threads(parts, of_others);
    }
    all->threads = parts.threads;
}

int usual_threads() {
    if (const char* const asked = std::getenv("OMP_NUM_THREADS"); asked != nullptr) {
        const int number = std::atoi(asked);
        if (number > 0) return number;
    }
    cpu_set_t cores;
    CPU_ZERO(&cores);
    if (sched_getaffinity(0, sizeof cores, &cores) == 0) return std::max(1, CPU_COUNT(&cores));
    return std::max(1, static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
}

}  // namespace myriad::python

namespace myriad::openmp {

// What the library's own loops over instances look for.
void in_parts(for_set<instruction_set::generic>, team& all) { python::start_team(&all); }
int most_parts(for_set<instruction_set::generic>) { return python::usual_threads(); }

}  // namespace myriad::openmp
