// SPDX-License-Identifier: MIT
// `solve` on a GPU: chunk by chunk, so that the host prepares one, others are copied, and one is integrated at the same time.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "myriad/backend.hpp"
#include "myriad/core/background.hpp"
#include "myriad/core/kept.hpp"
#include "myriad/device.hpp"
#include "myriad/ensemble/ensemble.hpp"
#include "myriad/ensemble/input_check.hpp"
#include "myriad/ensemble/report.hpp"
#include "myriad/integrator/options.hpp"
#include "myriad/progress_relay.hpp"

namespace myriad::host {

/// Chunks under way at a time: one is copied in, one is integrated, one is copied out by a thread of its own.
inline constexpr std::size_t chunks_at_a_time = 3;
/// Chunks on the device while the last ones are still being checked and none may be copied out.
inline constexpr std::size_t most_chunks_held = 16;
/// Ensembles of fewer instances are not worth several.
inline constexpr std::int64_t worth_chunks = 131'072;

/// What makes an engine of a model and a real type: one for each method.
template <class Model, class R>
using engine_maker = std::unique_ptr<cuda::engine<Model, R>> (*)(const cuda::engine_options&);

/// Engines between two calls of `solve`, since making one takes longer than integrating a small ensemble.
template <class Model, class R>
class idle_engines {
    using engine = std::unique_ptr<cuda::engine<Model, R>>;
    using maker = engine_maker<Model, R>;
    struct use {
        maker make;
        cuda::engine_options how;
        bool operator==(const use& other) const { return make == other.make && how == other.how; }
    };
    using idle = kept<use, cuda::engine<Model, R>>;

public:
    static engine take(maker make, const cuda::engine_options& how) {
        engine found = idle::all().take({make, how});
        return found != nullptr ? std::move(found) : make(how);
    }
    /// Only for engines that have finished without an error. Of each method the last few are kept.
    static void give(maker make, const cuda::engine_options& how, engine e) {
        e->rest();
        idle::all().give({make, how}, std::move(e));
        idle::all().keep_at_most(most_chunks_held, [make](const use& other) { return other.make == make; });
    }
};

/// For a thread that waits for one of several things: it looks again at once while that may save some of the time of a chunk, and
/// later sleeps in between.
class patience {
public:
    /// Whether what the future promises has come.
    template <class Future>
    bool is_over(const Future& awaited) {
        const bool sleeps = std::chrono::steady_clock::now() - begin_ > std::chrono::milliseconds{5};
        if (!sleeps) std::this_thread::yield();
        return awaited.wait_for(std::chrono::microseconds{sleeps ? 50 : 0}) == std::future_status::ready;
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// One call of `solve` on a GPU.
template <class Model, class R>
class chunked_solve {
    using engine = cuda::engine<Model, R>;
    using engines = idle_engines<Model, R>;

public:
    chunked_solve(const device& where, const options& o, engine_maker<Model, R> make, ensemble<Model, R>& instances,
                  kernel_arguments<Model, R>& arguments, input_check<Model, R>& check, progress_relay& relay,
                  report<Model, R>& result)
        : options_(o), make_(make), instances_(instances), arguments_(arguments), check_(check), relay_(relay), result_(result),
          how_{where.number(), o.block_size, o.shared_placement, o.schedule}, size_(instances.size()),
          checked_(size_ <= worth_chunks ? size_ : 0),  // small ones by `solve`
          past_(instances.untouched() ? cuda::past::none : cuda::past::kept) {}

    /// Nothing is written to the ensemble before all of it is checked.
    void run() {
        engines_.push_back(engines::take(make_, how_));
        engine& first = *engines_.front();
        clock_ = first.start_clock();
        const std::int64_t chunk = chunk_size();
        first.reserve(arguments_, chunk);
        check(chunk);
        if (chunk == size_) {
            count_earlier_work();
            instances_.touch();
            begin(first, 0, chunk);
            first.download(arguments_);
            bring_back(first, 0, chunk);
            progress_relay::call(&relay_, chunk);
        } else {
            run_chunks(chunk);
        }
        if (options_.counting == counting::on) set_work(result_, work_before_, work_after_);
        result_.kernel = first.facts();
        for (auto& e : engines_) engines::give(make_, how_, std::move(e));
    }

private:
    struct part {
        std::int64_t first, count;
        engine* worker;
        std::shared_future<void> asked;
        std::future<void> back;
    };

    /// This thread begins chunks. A second one checks those that come, and afterwards brings back those that went: it asks for
    /// the results of a chunk before it puts those of the one before in their places.
    void run_chunks(std::int64_t chunk) {
        // All before the first result is written: where there is no memory for them, the ensemble is as it was.
        while (engines_.size() < chunks_at_a_time && static_cast<std::int64_t>(engines_.size()) * chunk < size_) add_engine(chunk);
        checking_ = background_->ask([this, step = std::max(chunk, worth_chunks)] {
            while (checked_ < size_) check(std::min(checked_ + step, size_));
            count_earlier_work();
            instances_.touch();
        }).share();
        for (std::int64_t first = 0; first < size_; first += chunk) {
            engine* const worker = &free_engine(chunk);
            if (relay_.failure) break;
            const std::int64_t count = std::min(chunk, size_ - first);
            wait_for_check(first + count);
            begin(*worker, first, count);
            auto asked = background_->ask([this, worker] {
                checking_.get();  // nothing is brought back if that was refused
                worker->download(arguments_);
            });
            if (!under_way_.empty()) ask_back(under_way_.back());
            under_way_.push_back({first, count, worker, asked.share(), {}});
        }
        ask_back(under_way_.back());
        while (!under_way_.empty()) wait_for_oldest();
    }
    /// Has the second thread bring back a chunk whose results were asked for.
    void ask_back(part& p) {
        p.back = background_->ask([this, worker = p.worker, first = p.first, count = p.count, asked = p.asked] {
            asked.get();
            bring_back(*worker, first, count);
        });
    }

    struct bytes {
        std::int64_t kept = 0, copied = 0;
    };
    bytes of_an_instance() const {
        bytes sum;
        const auto add = [&](auto* array, std::int64_t components, array_access access, array_kind) {
            const auto all = components * static_cast<std::int64_t>(sizeof(*array));
            sum.kept += all;
            sum.copied += access == array_access::update ? 2 * all : all;
        };
        for_each_array(arguments_, add);
        for_each_record(arguments_.record, add);
        return sum;
    }

    /// As many chunks as overlap most of the transfers, each with enough to do for the GPU and for the bus.
    std::int64_t chunk_size() const {
        if (options_.chunk_size > 0) return std::min(options_.chunk_size, size_);
        const auto [memory, copied] = of_an_instance();
        constexpr std::int64_t most_chunks = 32, worthwhile_bytes = std::int64_t{8} << 20, all_memory_has = std::int64_t{64} << 20;
        const std::int64_t least =
            std::max({worth_chunks, engines_.front()->full_load(), worthwhile_bytes / copied});
        const std::int64_t chunks = std::clamp(size_ / least, std::int64_t{1}, most_chunks);
        const std::int64_t chunk = (size_ + chunks - 1) / chunks;
        const std::int64_t at_a_time = std::min(chunks, static_cast<std::int64_t>(chunks_at_a_time));
        if (at_a_time * chunk * memory <= all_memory_has) return chunk;
        const std::int64_t fits = engines_.front()->affordable(memory);
        return fits >= at_a_time * chunk
                   ? chunk
                   : std::clamp(fits / static_cast<std::int64_t>(chunks_at_a_time), std::int64_t{1}, chunk);
    }

    /// An engine with nothing to do: one that has finished, or another one, where too few keep the device busy since nothing may
    /// be brought back yet.
    engine& free_engine(std::int64_t chunk) {
        if (under_way_.size() < engines_.size()) return *engines_[under_way_.size()];
        for (patience waiting;;) {
            if (waiting.is_over(under_way_.front().back)) return wait_for_oldest();
            if (checked_ < size_ && may_hold_more(chunk) && keeps_too_few_busy()) {
                try {
                    return add_engine(chunk);
                } catch (const error&) {  // someone else has taken the memory since
                    most_engines_ = engines_.size();
                }
            }
        }
    }
    engine& add_engine(std::int64_t chunk) {
        auto another = engines::take(make_, how_);
        another->reserve(arguments_, chunk);
        engines_.push_back(std::move(another));
        return *engines_.back();
    }
    /// Whether there is memory for more than `chunks_at_a_time`: half of what the device then has left stays free.
    bool may_hold_more(std::int64_t chunk) {
        if (options_.chunk_size > 0) return false;
        if (!most_engines_) {
            const std::int64_t fit = engines_.front()->affordable(of_an_instance().kept) / (2 * chunk);
            most_engines_ = std::min(most_chunks_held, engines_.size() + static_cast<std::size_t>(fit));
        }
        return engines_.size() < *most_engines_;
    }
    bool keeps_too_few_busy() const {
        const auto idle = std::count_if(engines_.begin(), engines_.end(), [](const auto& e) { return e->idle(); });
        return engines_.size() - static_cast<std::size_t>(idle) < chunks_at_a_time;
    }

    /// Sees to it that the data of the first `count` instances are fine, or marked.
    void check(std::int64_t count) {
        if (checked_ >= count) return;
        if (check_.passes(checked_, count - checked_)) {
            checked_ = count;
            return;
        }
        check_.run();
        past_ = cuda::past::kept;  // some are marked
        checked_ = size_;
    }
    /// Throws what the check throws.
    void wait_for_check(std::int64_t count) const {
        for (patience waiting; checked_ < count;)
            if (waiting.is_over(checking_)) checking_.get();
    }

    void count_earlier_work() {
        if (past_ == cuda::past::kept) add_work(work_before_, 0, size_);
    }

    void begin(engine& worker, std::int64_t first, std::int64_t count) {
        worker.upload(arguments_, first, count, past_);
        worker.integrate(arguments_);
    }

    /// Puts results that were asked for into the ensemble, and looks at them; in the order of chunks.
    void bring_back(engine& worker, std::int64_t first, std::int64_t count) {
        worker.wait();
        // Kernels may overlap: a new one fills the places that the one before leaves.
        const auto [from, to] = worker.kernel_interval(clock_);
        result_.kernel_seconds += std::max(0.0, to - std::max(from, kernels_until_));
        kernels_until_ = std::max(kernels_until_, to);
        add_work(work_after_, first, count);
        add_summary(instances_, result_, first, count);
    }

    /// Returns the engine that is free then.
    engine& wait_for_oldest() {
        part p = std::move(under_way_.front());
        under_way_.pop_front();
        p.back.get();
        progress_relay::call(&relay_, p.first + p.count);
        return *p.worker;
    }

    void add_work(work_count& sum, std::int64_t first, std::int64_t count) const {
        if (options_.counting == counting::off) return;
        const work_count work = counted_work(instances_, count, first);
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += work[c];
    }

    const options& options_;
    engine_maker<Model, R> make_;
    ensemble<Model, R>& instances_;
    kernel_arguments<Model, R>& arguments_;
    input_check<Model, R>& check_;
    progress_relay& relay_;
    report<Model, R>& result_;
    cuda::engine_options how_;
    std::int64_t size_;
    std::atomic<std::int64_t> checked_;  // so many are fine, or marked
    std::atomic<cuda::past> past_;
    std::shared_future<void> checking_;
    std::optional<std::size_t> most_engines_;
    std::vector<std::unique_ptr<engine>> engines_;
    std::deque<part> under_way_;
    void* clock_ = nullptr;
    double kernels_until_ = 0;
    work_count work_before_{}, work_after_{};
    lent_background background_;  // destroyed first: it uses all of the above
};

}  // namespace myriad::host
