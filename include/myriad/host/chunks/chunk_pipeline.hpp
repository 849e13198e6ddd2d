// SPDX-License-Identifier: MIT
// The chunks that one GPU has under way in a call: while one is copied to it, another is integrated, and a third one
// copied back by a thread of its own. Host code only.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/chunks/chunk_plan.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/threads/polling_backoff.hpp"
#include "myriad/host/threads/worker_thread.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// One thread submits chunks, in the order of their instances. A second one downloads results: it submits the download
/// of a chunk before it completes the one before. When all chunks are submitted, the first one helps it.
template <class R>
class chunk_pipeline {
    using engine = cuda::engine<R>;

public:
    chunk_pipeline(const engine_source<R>& source, const any_arguments<R>& arguments)
        : source_(source), arguments_(arguments) {
        engines_.push_back(source.take());
        clock_ = first().start_clock();
    }

    engine& first() { return *engines_.front(); }
    std::int64_t busy_engines() const {
        return std::count_if(engines_.begin(), engines_.end(), [](const auto& e) { return !e->idle(); });
    }
    /// Takes memory for the chunks that a plan has in flight. Throws `error` if there is none for one of them, or for
    /// all if `all` are asked for.
    void reserve(const chunk_plan& plan, bool all) {
        first().reserve(arguments_, plan.largest());
        while (engine_count() < plan.at_a_time()) {
            if (all) {
                add_engine(plan.largest());
            } else if (try_engine(plan.largest()) == nullptr) {
                return;
            }
        }
    }
    /// Another engine while chunks are under way, which go on without it: null if there are many, if less than half of
    /// the remaining memory would be left free, or if there is no memory, and from then on.
    engine* further_engine(const chunk_plan& plan) {
        if (!most_engines_) {
            const std::int64_t fit = first().affordable(plan.bytes_per_instance()) / (2 * plan.largest());
            most_engines_ = std::min(most_chunks_held, engine_count() + fit);
        }
        return engine_count() < *most_engines_ ? try_engine(plan.largest()) : nullptr;
    }
    /// Has the second thread do something before the downloads.
    template <class Work>
    std::shared_future<void> ask(Work&& work) {
        return background_->ask(std::forward<Work>(work)).share();
    }

    /// An engine that has finished. Meanwhile calls `meanwhile`, which may return another one, or null.
    template <class Meanwhile, class Back>
    engine& free_engine(Meanwhile&& meanwhile, Back&& back) {
        if (under_way_.size() < engines_.size()) return *engines_[under_way_.size()];
        for (polling_backoff waiting;;) {
            part& oldest = under_way_.front();
            if (oldest.back.valid() && waiting.is_over(oldest.back)) return take_oldest(back);
            if (engine* const other = meanwhile()) return *other;
            ask_back(oldest);  // of a single engine
        }
    }
    /// Copies a chunk to the device, and integrates it.
    void begin(engine& worker, std::int64_t first, std::int64_t count, cuda::past past) {
        worker.upload(arguments_, first, count, past);
        worker.integrate(arguments_);
    }
    /// The same, and has its results downloaded once `ready` is over, unless that is an error.
    void submit(engine& worker, std::int64_t first, std::int64_t count, cuda::past past,
                const std::shared_future<void>& ready) {
        begin(worker, first, count, past);
        auto asked = ask([this, ready, &worker] {
            ready.get();
            worker.download(arguments_);
        });
        if (!under_way_.empty()) ask_back(under_way_.back());
        under_way_.emplace_back(first, first + count, &worker, std::move(asked));
    }
    /// Waits for all chunks; calls `meanwhile` while it does, and `back` as `free_engine` does.
    template <class Meanwhile, class Back>
    void finish(Meanwhile&& meanwhile, Back&& back) {
        if (!under_way_.empty()) ask_back(under_way_.back());
        for (polling_backoff waiting; !under_way_.empty();) {
            if (waiting.is_over(under_way_.front().back)) {
                take_oldest(back);
            } else {
                help_to_bring_back();
                meanwhile();
            }
        }
    }
    /// Tells the engines what is to become of the chunks under way.
    void stop(stop_request asked) {
        if (!ends_kernels(asked) || asked == std::exchange(told_, asked)) return;
        for (const auto& e : engines_) e->stop(asked);
    }
    /// To be called in the order of chunks, once an engine has finished one.
    void count_time(engine& worker) {
        // Kernels may overlap: a new one fills the multiprocessors that the previous one frees.
        const auto [from, to] = worker.kernel_interval(clock_);
        kernel_seconds_ += std::max(0.0, to - std::max(from, kernels_until_));
        kernels_until_ = std::max(kernels_until_, to);
    }
    double kernel_seconds() const { return kernel_seconds_; }
    /// The first engine, if no other call is to have it. No chunk may be under way.
    std::unique_ptr<engine> take_first() {
        auto taken = std::move(engines_.front());
        engines_.erase(engines_.begin());
        return taken;
    }
    /// Lets later calls have the engines; only after calls without an error.
    void give_back() {
        for (auto& e : engines_) source_.give(std::move(e));
        engines_.clear();
    }

private:
    std::int64_t engine_count() const { return static_cast<std::int64_t>(engines_.size()); }
    engine& add_engine(std::int64_t largest) {
        auto another = source_.take();
        another->reserve(arguments_, largest);
        engines_.push_back(std::move(another));
        return *engines_.back();
    }
    engine* try_engine(std::int64_t largest) {
        if (is_full_) return nullptr;
        try {
            return &add_engine(largest);
        } catch (const error&) {  // another program has taken the memory meanwhile
            is_full_ = true;
            return nullptr;
        }
    }

    /// A chunk in flight.
    struct part {
        std::int64_t begin, end;
        engine* worker;
        std::shared_future<void> asked;  // download submitted
        std::future<void> back = {};
        std::atomic<bool> taken = false;  // by a thread that completes its download

        part(std::int64_t b, std::int64_t e, engine* w, std::shared_future<void> a)
            : begin(b), end(e), worker(w), asked(std::move(a)) {}
        /// Completes the download of results into the ensemble. False if another thread does so.
        bool bring_back() {
            asked.get();
            if (taken.exchange(true)) return false;
            worker->wait();
            return true;
        }
    };

    /// Downloads one chunk that the device has finished, if there is one that the other thread has not taken.
    void help_to_bring_back() {
        for (part& p : under_way_) {
            if (!is_over(p.asked)) return;
            if (!p.taken && p.worker->idle() && p.bring_back()) return;
        }
    }
    /// Has the second thread complete a chunk's download, unless it was asked before.
    void ask_back(part& p) {
        if (!p.back.valid()) p.back = background_->ask([&p] { p.bring_back(); });
    }
    /// Calls `back` with the first instance of the oldest chunk and the end, and returns the engine that this frees.
    template <class Back>
    engine& take_oldest(Back&& back) {
        part& p = under_way_.front();
        p.back.get();
        engine& worker = *p.worker;
        count_time(worker);
        back(p.begin, p.end);
        under_way_.pop_front();
        return worker;
    }

    const engine_source<R>& source_;
    const any_arguments<R>& arguments_;
    std::vector<std::unique_ptr<engine>> engines_;
    std::deque<part> under_way_;
    stop_request told_ = stop_request::none;  // to the engines
    bool is_full_ = false;                    // there is no memory for further engines
    std::optional<std::int64_t> most_engines_;
    void* clock_ = nullptr;
    double kernel_seconds_ = 0, kernels_until_ = 0;
    pooled_worker background_;  // destroyed first: it uses all of the above
};

}  // namespace myriad::host::inline MYRIAD_ABI
