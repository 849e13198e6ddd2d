// SPDX-License-Identifier: MIT
// `solve` on GPUs, in chunks.
#include "myriad/host/chunks/chunk_driver.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <future>
#include <memory>
#include <mutex>

#include "myriad/host/chunks/chunk_pipeline.hpp"
#include "myriad/host/chunks/chunk_plan.hpp"
#include "myriad/host/chunks/chunk_queue.hpp"
#include "myriad/host/threads/polling_backoff.hpp"
#include "myriad/host/threads/worker_thread.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

/// The check of a call's inputs, which goes on while the first chunks are under way.
template <class R>
class checked_inputs {
public:
    checked_inputs(ensemble_data<R>& instances, data_check<R>& check)
        : size_(instances.size), check_(check),
          checked_(size_ <= worth_chunks ? size_ : 0),  // `solve` has checked small ensembles
          past_(instances.untouched ? cuda::past::none : cuda::past::kept) {}

    bool are_all() const { return checked_ == size_; }
    cuda::past past() const { return past_; }
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
    void check_all(const chunk_plan& plan) {
        while (!are_all()) check(std::min(checked_ + std::max(plan.count_from(checked_), worth_chunks / 4), size_));
    }
    /// Waits until the first `count` are checked by a thread that is done when `over` is, whose error it rethrows.
    void wait_for(std::int64_t count, const std::shared_future<void>& over) const {
        for (polling_backoff waiting; checked_ < count;)
            if (waiting.is_over(over)) over.get();
    }

private:
    const std::int64_t size_;
    data_check<R>& check_;
    std::atomic<std::int64_t> checked_;  // instances found valid, or marked
    std::atomic<cuda::past> past_;
};

template <class R>
class chunk_driver {
    using pipeline = chunk_pipeline<R>;
    using engine = cuda::engine<R>;

public:
    chunk_driver(const options& o, const std::vector<engine_source<R>>& gpus, const any_arguments<R>& arguments,
                 ensemble_data<R>& instances, data_check<R>& check, progress_relay& relay, report_of<R>& result)
        : options_(o), arguments_(arguments), instances_(instances), relay_(relay), result_(result),
          size_(instances.size), inputs_(instances, check) {
        for (const engine_source<R>& source : gpus) pipelines_.push_back(std::make_unique<pipeline>(source, arguments));
    }

    void run(results_on_gpu<R>* stay) {
        if (stay != nullptr && stay->fit(caller().first())) {
            run_where_results_stay(*stay);
        } else {
            run_and_copy();
        }
        for (const auto& gpu : pipelines_) {
            result_.kernel_seconds = std::max(result_.kernel_seconds, gpu->kernel_seconds());
            gpu->give_back();
        }
    }

private:
    /// The GPU that the calling thread drives.
    pipeline& caller() { return *pipelines_.front(); }

    void run_where_results_stay(results_on_gpu<R>& stay) {
        inputs_.check(size_);
        engine& worker = caller().first();
        stay.upload(worker, inputs_.past());
        worker.integrate(arguments_);
        wait_for(worker);
        result_.kernel = worker.facts();
        result_.kernel_seconds = worker.kernel_seconds();
        stay.keep(caller().take_first(), result_);
        progress_relay::call(&relay_, size_);
    }

    /// Nothing is written to the ensemble before all of its data are checked, and each GPU has its memory.
    void run_and_copy() {
        std::vector<chunk_plan> alone;
        for (const auto& gpu : pipelines_) alone.emplace_back(options_, arguments_, gpu->first());
        const chunk_plan plan(alone);
        for (const auto& gpu : pipelines_) gpu->reserve(plan, options_.chunk_size > 0);
        inputs_.check(plan.count_from(0));
        chunk_queue chunks(plan, size_);
        plan.has_one_chunk() ? run_one(chunks) : run_all(plan, chunks);

        const bool are_all_done = chunks.back() == size_;
        chunks.give_up([this](std::int64_t i) {
            if (relay_.over) instances_.leave(i);
        });
        sum_up_results(chunks);
        if (are_all_done || relay_.over) progress_relay::call(&relay_, size_);
        if (options_.counting == counting::on) set_work(result_, work_before_, work_after_);
        result_.kernel = caller().first().facts();
    }

    /// A single chunk needs no second thread.
    void run_one(chunk_queue& chunks) {
        begin_to_write();
        engine& worker = caller().first();
        caller().begin(worker, 0, size_, inputs_.past());
        worker.download(arguments_);
        wait_for(worker);
        caller().count_time(worker);
        chunks.bring_back(0, size_);
    }
    /// Until the first GPU is done with the only chunk.
    void wait_for(engine& worker) {
        for (polling_backoff waiting; relay_.may_stop() && !worker.idle(); waiting.pause()) is_to_stop(caller(), 0);
        worker.wait();
    }

    /// Each GPU has a thread, the first one the caller's, which also sums up results and listens to the user. The
    /// second thread of the first one checks the inputs before it downloads.
    void run_all(const chunk_plan& plan, chunk_queue& chunks) {
        checking_ = caller().ask([this, plan] {
            inputs_.check_all(plan);
            begin_to_write();
        });
        const chunk first = chunks.take();  // each GPU has one to begin with
        std::vector<pooled_worker> others(pipelines_.size() - 1);
        std::vector<std::future<void>> done;
        for (std::size_t i = 0; i < others.size(); ++i)
            done.push_back(others[i]->ask([&, gpu = pipelines_[i + 1].get(), its_first = chunks.take()] {
                drive(*gpu, plan, chunks, its_first);
            }));
        drive(caller(), plan, chunks, first);
        for (const auto& other : done)
            for (polling_backoff waiting; !waiting.is_over(other); sum_up_results(chunks))
                is_to_stop(caller(), chunks.back());
        if (failure_) std::rethrow_exception(failure_);
    }

    /// Takes chunks through a GPU, from that one on, until none is left or the call is to end.
    void drive(pipeline& gpu, const chunk_plan& plan, chunk_queue& chunks, chunk next) {
        const bool is_caller = &gpu == &caller();
        const auto back = [&](std::int64_t begin, std::int64_t end) {
            const std::int64_t done = chunks.bring_back(begin, end);
            if (is_caller && done < size_) progress_relay::call(&relay_, done);
        };
        // A new engine if too few keep the GPU busy while nothing may be downloaded yet, or null.
        const auto meanwhile = [&]() -> engine* {
            is_to_stop(gpu, chunks.back());
            const bool may_hold_more = !inputs_.are_all() && options_.chunk_size == 0;
            return may_hold_more && gpu.busy_engines() < chunks_at_a_time ? gpu.further_engine(plan) : nullptr;
        };
        try {
            for (bool begun = false; next.count > 0; next = chunks.take(), begun = true) {
                engine& worker = gpu.free_engine(meanwhile, back);
                if (begun && is_to_stop(gpu, chunks.back())) break;
                inputs_.wait_for(next.first + next.count, checking_);
                gpu.submit(worker, next.first, next.count, inputs_.past(), checking_);  // nothing comes back if refused
                if (is_caller) sum_up_results(chunks);
            }
            gpu.finish([&] { is_to_stop(gpu, chunks.back()); },
                       [&](std::int64_t begin, std::int64_t end) {
                           back(begin, end);
                           if (is_caller) sum_up_results(chunks);
                       });
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!failure_) failure_ = std::current_exception();
            has_failed_ = true;
        }
    }
    /// Whether no further chunk is to be begun, with that many instances done. Tells the engines what is to become of
    /// chunks under way.
    bool is_to_stop(pipeline& gpu, std::int64_t done) {
        if (&gpu == &caller() && relay_.may_stop()) {
            if (done < size_) relay_.last_done = done;
            asked_ = progress_relay::ask(&relay_);
        }
        gpu.stop(asked_);
        return asked_ != stop_request::none || has_failed_;
    }

    /// Once all inputs are valid, or marked.
    void begin_to_write() {
        if (inputs_.past() == cuda::past::kept) add_work(work_before_, 0, size_);
        instances_.untouched = false;
    }
    /// Sums up the results that came back since the last time.
    void sum_up_results(const chunk_queue& chunks) {
        const std::int64_t count = chunks.back_until() - seen_until_;
        if (count == 0) return;
        add_work(work_after_, seen_until_, count);
        add_summary(instances_, result_, seen_until_, count);
        seen_until_ += count;
    }
    void add_work(work_count& sum, std::int64_t first, std::int64_t count) const {
        if (options_.counting == counting::off) return;
        const work_count work = counted_work(instances_, count, first);
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += work[c];
    }

    const options& options_;
    const any_arguments<R>& arguments_;
    ensemble_data<R>& instances_;
    progress_relay& relay_;
    report_of<R>& result_;
    const std::int64_t size_;
    std::int64_t seen_until_ = 0;  // instances summed up
    work_count work_before_{}, work_after_{};
    checked_inputs<R> inputs_;
    std::shared_future<void> checking_;
    std::atomic<stop_request> asked_{stop_request::none};
    std::atomic<bool> has_failed_{false};
    std::mutex mutex_;
    std::exception_ptr failure_;
    std::vector<std::unique_ptr<pipeline>> pipelines_;  // destroyed first: their threads use all of the above
};

}  // namespace

template <class R>
void solve_in_chunks(const options& o, const std::vector<engine_source<R>>& gpus, const any_arguments<R>& arguments,
                     ensemble_data<R>& instances, data_check<R>& check, progress_relay& relay, report_of<R>& result,
                     results_on_gpu<R>* stay) {
    chunk_driver<R>(o, gpus, arguments, instances, check, relay, result).run(stay);
}
template void solve_in_chunks(const options&, const std::vector<engine_source<double>>&, const any_arguments<double>&,
                              ensemble_data<double>&, data_check<double>&, progress_relay&, report_of<double>&,
                              results_on_gpu<double>*);
template void solve_in_chunks(const options&, const std::vector<engine_source<float>>&, const any_arguments<float>&,
                              ensemble_data<float>&, data_check<float>&, progress_relay&, report_of<float>&,
                              results_on_gpu<float>*);

}  // namespace myriad::host::inline MYRIAD_ABI
