// SPDX-License-Identifier: MIT
// Teams of threads, for kernels and for the host's loops: OpenMP's, but no more threads than the system allows, none
// lost in a fork, and none whose stack is too small.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include <omp.h>
#include <pthread.h>
#include <unistd.h>

#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/kernel/core/macros.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Threads besides the calling one, created for one task and joined at its end.
class own_threads {
public:
    /// Creates `count` threads, or as many as the system allows, that call `work(context, number)` with numbers from 1
    /// on.
    own_threads(int count, std::size_t stack, void (*work)(void*, int), void* context)
        : work_(work), context_(context) {
        pthread_attr_t attributes;
        if (pthread_attr_init(&attributes) != 0) return;
        std::size_t usual = 0;
        pthread_attr_getstacksize(&attributes, &usual);
        if (stack > usual / 2) pthread_attr_setstacksize(&attributes, 2 * stack);
        threads_ = new member[static_cast<std::size_t>(count)];
        while (made_ < count) {
            threads_[made_].all = this;
            threads_[made_].number = made_ + 1;
            if (pthread_create(&threads_[made_].handle, &attributes, &begin, &threads_[made_]) != 0) break;
            ++made_;
        }
        pthread_attr_destroy(&attributes);
    }
    own_threads(const own_threads&) = delete;
    own_threads& operator=(const own_threads&) = delete;
    ~own_threads() {
        for (int i = 0; i < made_; ++i) pthread_join(threads_[i].handle, nullptr);
        delete[] threads_;
    }
    int made() const { return made_; }

private:
    struct member {
        own_threads* all;
        int number;
        pthread_t handle;
    };
    static void* begin(void* argument) {
        const auto& self = *static_cast<member*>(argument);
        self.all->work_(self.all->context_, self.number);
        return nullptr;
    }

    void (*work_)(void*, int);
    void* context_;
    member* threads_ = nullptr;
    int made_ = 0;
};

/// How many of `wanted` threads the system allows the program besides the existing ones: found by creating them, as
/// OpenMP's runtime ends the program if it cannot.
inline int obtainable(int wanted) {
    pthread_mutex_t all_made = PTHREAD_MUTEX_INITIALIZER;  // holds the threads, so that all exist at once
    pthread_mutex_lock(&all_made);
    const own_threads probes(
        wanted, 0,
        [](void* gate, int) {
            pthread_mutex_lock(static_cast<pthread_mutex_t*>(gate));
            pthread_mutex_unlock(static_cast<pthread_mutex_t*>(gate));
        },
        &all_made);
    pthread_mutex_unlock(&all_made);
    return probes.made();
}

/// Unused bytes of the calling thread's stack; SIZE_MAX if the system does not tell.
inline std::size_t stack_left() {
    static thread_local const std::uintptr_t end = [] {
        pthread_attr_t attributes;
        if (pthread_getattr_np(pthread_self(), &attributes) != 0) return std::uintptr_t{0};
        void* lowest = nullptr;
        std::size_t size = 0, guard = 0;
        pthread_attr_getstack(&attributes, &lowest, &size);
        pthread_attr_getguardsize(&attributes, &guard);
        pthread_attr_destroy(&attributes);
        return reinterpret_cast<std::uintptr_t>(lowest) + guard;
    }();
    const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
    return end == 0 || here < end ? SIZE_MAX : here - end;
}

/// Known facts about the teams that OpenMP has made for one calling thread.
struct known_teams {
    int last = 1, largest = 1;
    std::size_t least_stack = SIZE_MAX;  // smallest unused one of the other threads
};

/// `all.parts` threads, or as many as are available, which is tested if necessary.
inline int team_of(const openmp::team& all, known_teams& known) {
    if (omp_get_active_level() >= omp_get_max_active_levels()) return 1;
    int threads = std::min(all.parts, omp_get_thread_limit());
    if (threads <= known.largest) return threads;
    threads = known.last + obtainable(threads - known.last);
    std::size_t least = known.least_stack;
#pragma omp parallel num_threads(threads) reduction(min : least)
    if (omp_get_thread_num() != 0) least = std::min(least, stack_left());
    known = {threads, threads, least};
    return threads;
}

inline void work_with_openmp(openmp::team& all, int threads) {
#pragma omp parallel num_threads(threads)
    {
        const default_arithmetic here;
        const int team = omp_get_num_threads(), number = omp_get_thread_num();
        if (number == 0) all.threads = team;
        for (int part = number; part < all.parts; part += team) all.body(all.context, part);
    }
}

/// With threads created for this task alone; the calling thread does the first part.
inline void work_with_own_threads(openmp::team& all) {
    struct supply {
        openmp::team* all;
        std::atomic<int> next;
        static void work(void* context, int part) {
            auto& mine = *static_cast<supply*>(context);
            const default_arithmetic here;
            for (; part < mine.all->parts; part = mine.next++) mine.all->body(mine.all->context, part);
        }
    } parts{&all, all.parts};
    const own_threads others(all.parts - 1, all.stack, &supply::work, &parts);
    all.threads = others.made() + 1;
    parts.next = all.threads;
    supply::work(&parts, 0);
}

inline const pid_t process_at_start = getpid();

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::openmp {

// Weak, as it is in every model's object file; the linker keeps one per instruction set.
__attribute__((weak)) int most_parts(for_set<instruction_set::MYRIAD_INSTRUCTION_SET>) {
    return omp_in_parallel() != 0 ? 1 : omp_get_max_threads();
}

__attribute__((weak)) void in_parts(for_set<instruction_set::MYRIAD_INSTRUCTION_SET>, team& all) {
    static thread_local known_teams known;
    // A child process inherits OpenMP's record of its threads but not the threads, and would wait for them forever.
    const bool forked = process_at_start != 0 && getpid() != process_at_start;
    const int threads = forked || all.parts <= 1 ? 1 : team_of(all, known);
    all.least_stack = std::min(stack_left(), threads > 1 ? known.least_stack : SIZE_MAX);
    if (all.least_stack < all.stack) return;
    if (forked && all.parts > 1) return work_with_own_threads(all);
    if (threads > 1) {
        work_with_openmp(all, threads);
        known.last = all.threads;
    } else {
        const default_arithmetic here;
        for (int part = 0; part < all.parts; ++part) all.body(all.context, part);
    }
}

}  // namespace myriad::openmp
