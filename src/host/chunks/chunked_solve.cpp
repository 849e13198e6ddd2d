// SPDX-License-Identifier: MIT
// `solve` on a GPU, in chunks.
#include "myriad/host/chunks/chunked_solve.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <deque>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include "myriad/host/core/error.hpp"
#include "myriad/host/threads/polling_backoff.hpp"
#include "myriad/host/threads/worker_thread.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

/// One call of `solve` on a GPU.
template <class R>
class chunked_solve {
    using engine = cuda::engine<R>;

public:
    chunked_solve(const options& o, const engine_source<R>& source, const any_arguments<R>& arguments,
                  ensemble_data<R>& instances, data_check<R>& check, progress_relay& relay, report_of<R>& result)
        : options_(o), source_(source), arguments_(arguments), instances_(instances), check_(check), relay_(relay),
          result_(result), size_(instances.size),
          checked_(size_ <= worth_chunks ? size_ : 0),  // `solve` has checked small ensembles
          past_(instances.untouched ? cuda::past::none : cuda::past::kept) {}

    /// Nothing is written to the ensemble before all of its data are checked.
    void run() {
        relay_.last_call = progress_relay::clock::now();
        engines_.push_back(source_.take());
        engine& first = *engines_.front();
        clock_ = first.start_clock();
        plan_ = chunk_plan(options_, arguments_, first);
        first.reserve(arguments_, plan_.largest());
        check(plan_.count_from(0));
        if (plan_.has_one_chunk()) {
            count_earlier_work();
            instances_.untouched = false;
            begin(first, 0, size_);
            first.download(arguments_);
            for (polling_backoff waiting; relay_.may_stop() && !first.idle(); waiting.pause()) ask_whether_to_stop();
            first.wait();
            take_back(first, size_);
            sum_up_results();
        } else {
            run_chunks();
            leave_the_rest();
        }
        if (options_.counting == counting::on) set_work(result_, work_before_, work_after_);
        result_.kernel = first.facts();
        for (auto& e : engines_) source_.give(std::move(e));
    }

private:
    /// A chunk in flight.
    struct part {
        std::int64_t end;
        engine* worker;
        std::shared_future<void> asked;  // download submitted
        std::future<void> back;
        std::atomic<bool> taken = false;  // by a thread that completes its download

        part(std::int64_t e, engine* w, std::shared_future<void> a) : end(e), worker(w), asked(std::move(a)) {}
        /// Completes the download of results into the ensemble. False if another thread does so.
        bool bring_back() {
            asked.get();
            if (taken.exchange(true)) return false;
            worker->wait();
            return true;
        }
    };

    /// This thread submits chunks, and sums up the results of those that have been downloaded. A second one first
    /// checks the inputs, and then downloads results: it submits the download of a chunk before it completes that of
    /// the previous one. When all chunks are submitted, this thread helps it.
    void run_chunks() {
        // All before the first result is written: if there is no memory for them, the ensemble is unchanged.
        while (engine_count() < plan_.at_a_time()) add_engine();
        checking_ =
            background_
                ->ask([this] {
                    while (checked_ < size_)
                        check(std::min(checked_ + std::max(plan_.count_from(checked_), worth_chunks / 4), size_));
                    count_earlier_work();
                    instances_.untouched = false;
                })
                .share();
        for (std::int64_t first = 0, count = 0; first < size_; first += count) {
            engine* const worker = &free_engine();
            if (first > 0 && ask_whether_to_stop()) break;
            count = plan_.count_from(first);
            wait_for_check(first + count);
            begin(*worker, first, count);
            auto asked = background_->ask([this, worker] {
                checking_.get();  // nothing is downloaded if the inputs were refused
                worker->download(arguments_);
            });
            if (!under_way_.empty()) ask_back(under_way_.back());
            under_way_.emplace_back(first + count, worker, asked.share());
            sum_up_results();
        }
        ask_back(under_way_.back());
        for (polling_backoff waiting; !under_way_.empty();) {
            if (waiting.is_over(under_way_.front().back)) {
                wait_for_oldest();
                sum_up_results();
            } else {
                help_to_bring_back();
                ask_whether_to_stop();
            }
        }
    }
    /// Whether no further chunk is to be begun. Tells the engines what is to become of those under way.
    bool ask_whether_to_stop() {
        if (!relay_.may_stop()) return false;
        const stop_request asked = progress_relay::ask(&relay_);
        if (ends_kernels(asked) && asked != std::exchange(told_, asked))
            for (const auto& e : engines_) e->stop(asked);
        return asked != stop_request::none;
    }
    /// What becomes of the instances of chunks that were not begun.
    void leave_the_rest() {
        if (back_until_ == size_) return;
        for (std::int64_t i = back_until_; i < size_ && relay_.over; ++i) instances_.leave(i);
        back_until_ = size_;
        sum_up_results();
        if (relay_.over) progress_relay::call(&relay_, size_);
    }
    /// Downloads one chunk that the device has finished, if there is one that the other thread has not taken.
    void help_to_bring_back() {
        for (part& p : under_way_) {
            if (!is_over(p.asked)) return;
            if (!p.taken && p.worker->idle() && p.bring_back()) return;
        }
    }
    /// Has the second thread complete a chunk's download.
    void ask_back(part& p) {
        p.back = background_->ask([&p] { p.bring_back(); });
    }

    /// An idle engine: one that has finished, or a new one if too few keep the device busy while nothing may be
    /// downloaded yet.
    engine& free_engine() {
        if (under_way_.size() < engines_.size()) return *engines_[under_way_.size()];
        for (polling_backoff waiting;;) {
            if (waiting.is_over(under_way_.front().back)) return wait_for_oldest();
            ask_whether_to_stop();
            if (checked_ < size_ && may_hold_more() && keeps_too_few_busy()) {
                try {
                    return add_engine();
                } catch (const error&) {  // another program has taken the memory meanwhile
                    most_engines_ = engine_count();
                }
            }
        }
    }
    engine& add_engine() {
        auto another = source_.take();
        another->reserve(arguments_, plan_.largest());
        engines_.push_back(std::move(another));
        return *engines_.back();
    }
    /// Whether there is memory for more than `chunks_at_a_time`, with half of the device's remaining memory left free.
    bool may_hold_more() {
        if (options_.chunk_size > 0) return false;
        if (!most_engines_) {
            const std::int64_t fit = engines_.front()->affordable(plan_.bytes_per_instance()) / (2 * plan_.largest());
            most_engines_ = std::min(most_chunks_held, engine_count() + fit);
        }
        return engine_count() < *most_engines_;
    }
    bool keeps_too_few_busy() const {
        const auto idle = std::count_if(engines_.begin(), engines_.end(), [](const auto& e) { return e->idle(); });
        return engine_count() - idle < chunks_at_a_time;
    }
    std::int64_t engine_count() const { return static_cast<std::int64_t>(engines_.size()); }

    /// Ensures that the data of the first `count` instances are valid, or marked.
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
    /// Rethrows what the check throws.
    void wait_for_check(std::int64_t count) const {
        for (polling_backoff waiting; checked_ < count;)
            if (waiting.is_over(checking_)) checking_.get();
    }

    void count_earlier_work() {
        if (past_ == cuda::past::kept) add_work(work_before_, 0, size_);
    }

    /// Copies a chunk to the device, and integrates it.
    void begin(engine& worker, std::int64_t first, std::int64_t count) {
        worker.upload(arguments_, first, count, past_);
        worker.integrate(arguments_);
    }

    /// To be called in the order of chunks, when the results up to instance `end` are in the ensemble.
    void take_back(engine& worker, std::int64_t end) {
        back_until_ = end;
        progress_relay::call(&relay_, end);
        // Kernels may overlap: a new one fills the multiprocessors that the previous one frees.
        const auto [from, to] = worker.kernel_interval(clock_);
        result_.kernel_seconds += std::max(0.0, to - std::max(from, kernels_until_));
        kernels_until_ = std::max(kernels_until_, to);
    }
    /// Sums up the results downloaded since the last time.
    void sum_up_results() {
        const std::int64_t count = back_until_ - seen_until_;
        if (count == 0) return;
        add_work(work_after_, seen_until_, count);
        add_summary(instances_, result_, seen_until_, count);
        seen_until_ = back_until_;
    }

    /// Returns the engine that this frees.
    engine& wait_for_oldest() {
        part& p = under_way_.front();
        p.back.get();
        engine& worker = *p.worker;
        take_back(worker, p.end);
        under_way_.pop_front();
        return worker;
    }

    void add_work(work_count& sum, std::int64_t first, std::int64_t count) const {
        if (options_.counting == counting::off) return;
        const work_count work = counted_work(instances_, count, first);
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += work[c];
    }

    const options& options_;
    const engine_source<R>& source_;
    const any_arguments<R>& arguments_;
    ensemble_data<R>& instances_;
    data_check<R>& check_;
    progress_relay& relay_;
    report_of<R>& result_;
    std::int64_t size_;
    chunk_plan plan_{size_};
    std::int64_t back_until_ = 0, seen_until_ = 0;  // instances downloaded, and summed up
    std::atomic<std::int64_t> checked_;             // instances found valid, or marked
    std::atomic<cuda::past> past_;
    std::shared_future<void> checking_;
    std::optional<std::int64_t> most_engines_;
    std::vector<std::unique_ptr<engine>> engines_;
    std::deque<part> under_way_;
    stop_request told_ = stop_request::none;  // to the engines
    void* clock_ = nullptr;
    double kernels_until_ = 0;
    work_count work_before_{}, work_after_{};
    pooled_worker background_;  // destroyed first: it uses all of the above
};

}  // namespace

template <class R>
void solve_in_chunks(const options& o, const engine_source<R>& source, const any_arguments<R>& arguments,
                     ensemble_data<R>& instances, data_check<R>& check, progress_relay& relay, report_of<R>& result) {
    chunked_solve<R>(o, source, arguments, instances, check, relay, result).run();
}
template void solve_in_chunks(const options&, const engine_source<double>&, const any_arguments<double>&,
                              ensemble_data<double>&, data_check<double>&, progress_relay&, report_of<double>&);
template void solve_in_chunks(const options&, const engine_source<float>&, const any_arguments<float>&,
                              ensemble_data<float>&, data_check<float>&, progress_relay&, report_of<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
