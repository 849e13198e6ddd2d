// SPDX-License-Identifier: MIT
// `solve` on a GPU, in chunks.
#include "myriad/host/chunks/chunked_solve.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <optional>

#include "myriad/host/chunks/chunk_pipeline.hpp"
#include "myriad/host/threads/polling_backoff.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

/// One call of `solve` on a GPU.
template <class R>
class chunked_solve {
    using engine = cuda::engine<R>;

public:
    chunked_solve(const options& o, const engine_source<R>& source, const any_arguments<R>& arguments,
                  ensemble_data<R>& instances, data_check<R>& check, progress_relay& relay, report_of<R>& result)
        : options_(o), arguments_(arguments), instances_(instances), check_(check), relay_(relay), result_(result),
          size_(instances.size), checked_(size_ <= worth_chunks ? size_ : 0),  // `solve` has checked small ensembles
          past_(instances.untouched ? cuda::past::none : cuda::past::kept), pipeline_(source, arguments) {}

    /// Nothing is written to the ensemble before all of its data are checked.
    void run() {
        engine& first = pipeline_.first();
        plan_ = chunk_plan(options_, arguments_, first);
        first.reserve(arguments_, plan_.largest());
        check(plan_.count_from(0));
        if (plan_.has_one_chunk()) {
            count_earlier_work();
            instances_.untouched = false;
            pipeline_.begin(first, 0, size_, past_);
            first.download(arguments_);
            for (polling_backoff waiting; relay_.may_stop() && !first.idle(); waiting.pause()) ask_whether_to_stop();
            first.wait();
            pipeline_.count_time(first);
            take_back(size_);
            sum_up_results();
        } else {
            run_chunks();
            leave_the_rest();
        }
        if (options_.counting == counting::on) set_work(result_, work_before_, work_after_);
        result_.kernel = first.facts();
        result_.kernel_seconds = pipeline_.kernel_seconds();
        pipeline_.give_back();
    }

private:
    /// This thread submits chunks, and sums up the results that have been downloaded. The second one first
    /// checks the inputs.
    void run_chunks() {
        // All before the first result is written: if there is no memory for them, the ensemble is unchanged.
        while (pipeline_.engine_count() < plan_.at_a_time()) pipeline_.add_engine(plan_.largest());
        checking_ = pipeline_.ask([this] {
            while (checked_ < size_)
                check(std::min(checked_ + std::max(plan_.count_from(checked_), worth_chunks / 4), size_));
            count_earlier_work();
            instances_.untouched = false;
        });
        const auto back = [this](std::int64_t, std::int64_t end) { take_back(end); };
        for (std::int64_t first = 0, count = 0; first < size_; first += count) {
            engine& worker = pipeline_.free_engine([this] { return meanwhile(); }, back);
            if (first > 0 && ask_whether_to_stop()) break;
            count = plan_.count_from(first);
            wait_for_check(first + count);
            pipeline_.submit(worker, first, count, past_, checking_);  // nothing comes back if the inputs were refused
            sum_up_results();
        }
        pipeline_.finish([this] { ask_whether_to_stop(); },
                         [&](std::int64_t first, std::int64_t end) {
                             back(first, end);
                             sum_up_results();
                         });
    }
    /// Whether no further chunk is to be begun. Tells the engines what is to become of chunks under way.
    bool ask_whether_to_stop() {
        if (!relay_.may_stop()) return false;
        const stop_request asked = progress_relay::ask(&relay_);
        pipeline_.stop(asked);
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

    /// A new engine if too few keep the device busy while nothing may be downloaded yet, or null.
    engine* meanwhile() {
        ask_whether_to_stop();
        if (checked_ == size_ || !may_hold_more() || pipeline_.busy_engines() >= chunks_at_a_time) return nullptr;
        return pipeline_.further_engine(plan_.largest());
    }
    /// Whether there is memory for more than `chunks_at_a_time`, with half of the device's remaining memory left free.
    bool may_hold_more() {
        if (options_.chunk_size > 0) return false;
        if (!most_engines_) {
            const std::int64_t fit = pipeline_.first().affordable(plan_.bytes_per_instance()) / (2 * plan_.largest());
            most_engines_ = std::min(most_chunks_held, pipeline_.engine_count() + fit);
        }
        return pipeline_.engine_count() < *most_engines_;
    }

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

    /// To be called in the order of chunks, when the results up to instance `end` are in the ensemble.
    void take_back(std::int64_t end) {
        back_until_ = end;
        progress_relay::call(&relay_, end);
    }
    /// Sums up the results downloaded since the last time.
    void sum_up_results() {
        const std::int64_t count = back_until_ - seen_until_;
        if (count == 0) return;
        add_work(work_after_, seen_until_, count);
        add_summary(instances_, result_, seen_until_, count);
        seen_until_ = back_until_;
    }

    void add_work(work_count& sum, std::int64_t first, std::int64_t count) const {
        if (options_.counting == counting::off) return;
        const work_count work = counted_work(instances_, count, first);
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += work[c];
    }

    const options& options_;
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
    work_count work_before_{}, work_after_{};
    chunk_pipeline<R> pipeline_;  // destroyed first: its thread uses all of the above
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
