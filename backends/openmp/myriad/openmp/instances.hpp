// SPDX-License-Identifier: MIT
// Hands out instances to the lanes of the OpenMP backend: chunks of consecutive indices, to any thread that asks, so
// that no thread waits for another.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>

#include "myriad/host/backend/cpu_backend.hpp"
#include "myriad/kernel/core/macros.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The shared state of a run's threads.
struct common_supply {
    std::atomic<std::int64_t> begun{0};  // instances handed out
    std::atomic<std::int64_t> done{0};   // reported as done by the threads
    std::atomic<bool> stopped{false};    // the progress function returned false, or a function of the model threw
    std::atomic<bool> given_up{false};   // instances under way are to end, too
    std::atomic<bool> over{false};       // those not begun are handed out to be left as they are

    /// Makes sure that none of the `size` instances is started any more.
    void stop(std::int64_t size) {
        stopped = true;
        begun.store(size, std::memory_order_relaxed);
    }
    /// Stops as far as the host asks for it.
    void follow(const run_options& options, std::int64_t size) {
        const stop_request asked = options.stop(options.context);
        if (asked == stop_request::none) return;
        if (asked == stop_request::end_all) {
            over = true;
        } else {
            stop(size);
        }
        if (asked != stop_request::begin_no_more) given_up = true;
    }
};

/// One thread's source of instances; the loop uses only `next()` and `gives_up()`.
class chunked_instances {
public:
    /// `lanes` lanes ask for instances in turn; `order`, if not null, maps positions to instances. `reports`: this
    /// thread calls the progress function.
    chunked_instances(common_supply& all, std::int64_t size, std::int64_t chunk, int lanes, const std::uint32_t* order,
                      const run_options& options, bool reports)
        : all_(all), size_(size), chunk_(chunk), order_(order), options_(options), reports_(reports), done_(-lanes),
          tell_at_(options.progress ? interval_ : std::numeric_limits<std::int64_t>::max()),
          ask_at_(options.stop ? ask_every : std::numeric_limits<std::int64_t>::max()) {}

    /// The next instance, or -1 when all are taken. Once the progress function returns false, no more are handed out.
    std::int64_t next() {
        // A lane that asks again has finished its last instance; at first it had none.
        if (++done_ >= tell_at_) tell();
        ask_after_many();
        if (next_ == end_) {
            next_ = std::min(all_.begun.fetch_add(chunk_, std::memory_order_relaxed), size_);
            end_ = std::min(next_ + chunk_, size_);
            if (next_ == end_) return -1;
        }
        const std::int64_t place = next_++;
        return order_ != nullptr ? order_[place] : place;
    }

    /// Whether instances under way are to end as they are. The loop asks now and then, with its iterations so far.
    bool gives_up(std::int64_t iterations) { return iterations >= ask_at_ && ask(iterations); }
    /// The same between two phases of an instance, of which many may be too short for `gives_up` to be asked.
    bool gives_up_before(std::int32_t) {
        ask_after_many();
        return all_.given_up.load(std::memory_order_relaxed);
    }
    /// Whether the instance given last is to be left as it is.
    bool is_over() const { return all_.over.load(std::memory_order_relaxed); }

private:
    static constexpr std::int64_t ask_every = 1024;

    /// Asks after many instances or phases, which may all be too short for `gives_up` to be asked in them.
    void ask_after_many() {
        if (options_.stop == nullptr || --phases_before_asking_ > 0) return;
        phases_before_asking_ = ask_every;
        ask(ask_at_ - ask_every);  // when `gives_up` asks next stays as it is
    }
    __attribute__((noinline)) bool ask(std::int64_t iterations) {
        if (reports_) all_.follow(options_, size_);
        if (all_.stopped) next_ = end_;
        const bool over = all_.given_up;
        ask_at_ = over ? 0 : iterations + ask_every;
        return over;
    }

    void tell() {
        tell_at_ = done_ + interval_;
        const std::int64_t since = done_ - told_;
        told_ = done_;
        const std::int64_t done = all_.done.fetch_add(since, std::memory_order_relaxed) + since;
        // The last report is made after all threads are done.
        if (reports_ && done < size_ && !options_.progress(options_.context, done)) all_.stop(size_);
        if (all_.stopped) next_ = end_;
    }

    common_supply& all_;
    std::int64_t size_, chunk_, interval_ = std::clamp<std::int64_t>(size_ / 1024, 1, 16);
    const std::uint32_t* order_;
    const run_options& options_;
    bool reports_;
    std::int64_t done_;      // instances that this thread has finished; negative: lanes that have not asked yet
    std::int64_t told_ = 0;  // instances already added to the shared count
    std::int64_t tell_at_;
    std::int64_t ask_at_;  // iterations
    std::int64_t phases_before_asking_ = ask_every;
    std::int64_t next_ = 0, end_ = 0;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
