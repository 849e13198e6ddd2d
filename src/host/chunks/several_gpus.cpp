// SPDX-License-Identifier: MIT
// `solve` on several GPUs.
#include "myriad/host/chunks/several_gpus.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <thread>

#include "myriad/host/chunks/chunk_pipeline.hpp"
#include "myriad/host/chunks/chunk_plan.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

/// What the threads of all GPUs share.
struct parts_of_call {
    parts_of_call(std::int64_t instances, cuda::past of_instances) : size(instances), past(of_instances) {}

    const std::int64_t size;
    const cuda::past past;
    std::int64_t part = 1;                       // instances of a part
    std::atomic<std::int64_t> next{0}, done{0};  // instances
    std::atomic<stop_request> asked{stop_request::none};
    std::atomic<bool> stopped{false};

    std::mutex mutex;
    std::condition_variable changed;
    std::size_t working = 0;  // threads
    std::exception_ptr failure;
    std::vector<std::int64_t> left;  // the first instances of parts that were given to a thread and not begun
    double kernel_seconds = 0;       // of the GPU that took longest
    cuda::kernel_facts facts{};
};

/// The work of one GPU, in a thread of its own.
template <class R>
class gpu_worker {
public:
    gpu_worker(const engine_source<R>& source, const any_arguments<R>& arguments, const options& o, parts_of_call& all)
        : all_(all), pipeline_(source, arguments), plan_(o, arguments, pipeline_.first()) {}

    /// Instances of the largest part that it takes.
    std::int64_t largest() const { return plan_.largest(); }

    /// From the part that begins with that instance on.
    void work(std::int64_t first) {
        try {
            std::promise<void> ready;
            ready.set_value();  // all inputs are checked
            const std::shared_future<void> checked = ready.get_future().share();
            const auto back = [this](std::int64_t begin, std::int64_t end) { all_.done += end - begin; };
            const auto meanwhile = [this]() -> cuda::engine<R>* {
                pipeline_.stop(all_.asked);
                const bool may_add = pipeline_.engine_count() < std::max(plan_.at_a_time(), std::int64_t{2});
                return may_add ? pipeline_.further_engine(all_.part) : nullptr;
            };
            for (; first < all_.size && !all_.stopped; first = all_.next.fetch_add(all_.part)) {
                cuda::engine<R>& engine = pipeline_.free_engine(meanwhile, back);
                pipeline_.submit(engine, first, std::min(all_.part, all_.size - first), all_.past, checked);
            }
            pipeline_.finish([this] { pipeline_.stop(all_.asked); }, back);
            const std::lock_guard lock(all_.mutex);
            if (first < all_.size) all_.left.push_back(first);
            all_.kernel_seconds = std::max(all_.kernel_seconds, pipeline_.kernel_seconds());
            all_.facts = pipeline_.first().facts();
            pipeline_.give_back();
        } catch (...) {
            const std::lock_guard lock(all_.mutex);
            if (!all_.failure) all_.failure = std::current_exception();
            all_.stopped = true;
        }
        const std::lock_guard lock(all_.mutex);
        --all_.working;
        all_.changed.notify_all();
    }

private:
    parts_of_call& all_;
    chunk_pipeline<R> pipeline_;
    chunk_plan plan_;
};

/// Ends the instances of parts that were not begun as they are.
template <class R>
void leave(ensemble_data<R>& data, parts_of_call& all) {
    for (std::int64_t first = all.next; first < all.size; first += all.part) all.left.push_back(first);
    for (const std::int64_t first : all.left)
        for (std::int64_t i = first; i < std::min(first + all.part, all.size); ++i) data.leave(i);
}

template <class R>
void share_out(const options& o, const std::vector<engine_source<R>>& sources, const any_arguments<R>& arguments,
               ensemble_data<R>& instances, data_check<R>& check, progress_relay& relay, report_of<R>& result) {
    const std::int64_t size = instances.size;
    if (!check.passes(0, size)) check.run();
    const auto work = [&] { return o.counting == counting::on ? counted_work(instances, size) : work_count{}; };
    const work_count work_before = instances.untouched ? work_count{} : work();
    parts_of_call all(size, instances.untouched ? cuda::past::none : cuda::past::kept);
    std::vector<std::unique_ptr<gpu_worker<R>>> workers;
    for (const auto& source : sources) workers.push_back(std::make_unique<gpu_worker<R>>(source, arguments, o, all));
    // As many for each GPU as on one alone, so that the faster ones take more of them, but none too small.
    constexpr std::int64_t worth_a_part = 65'536, most = 8;
    const auto gpus = static_cast<std::int64_t>(sources.size());
    const std::int64_t parts = gpus * std::clamp<std::int64_t>(size / (gpus * worth_a_part), 1, most);
    all.part = (size + parts - 1) / parts;
    for (const auto& w : workers) all.part = std::min(all.part, w->largest());
    all.next = gpus * all.part;  // each has one to begin with

    instances.untouched = false;
    std::vector<std::thread> threads;
    try {
        for (std::size_t w = 0; w < workers.size(); ++w) {
            const std::lock_guard lock(all.mutex);
            threads.emplace_back(
                [&one = *workers[w], first = static_cast<std::int64_t>(w) * all.part] { one.work(first); });
            ++all.working;
        }
    } catch (...) {
        const std::lock_guard lock(all.mutex);
        all.failure = std::current_exception();
        all.stopped = true;
    }
    {
        std::unique_lock lock(all.mutex);
        while (all.working > 0) {
            all.changed.wait_for(lock, std::chrono::milliseconds{20});
            lock.unlock();
            const std::int64_t done = all.done;
            if (done < size) relay.last_done = done;
            all.asked = progress_relay::ask(&relay);
            if (all.asked != stop_request::none) all.stopped = true;
            lock.lock();
        }
    }
    for (std::thread& t : threads) t.join();
    if (all.failure) std::rethrow_exception(all.failure);
    if (relay.over) leave(instances, all);
    if (all.done == size || relay.over) progress_relay::call(&relay, size);

    summarise(instances, result, size);
    if (o.counting == counting::on) set_work(result, work_before, work());
    result.kernel = all.facts;
    result.kernel_seconds = all.kernel_seconds;
}

}  // namespace

template <class R>
void solve_on_several_gpus(const options& o, const std::vector<engine_source<R>>& sources,
                           const any_arguments<R>& arguments, ensemble_data<R>& instances, data_check<R>& check,
                           progress_relay& relay, report_of<R>& result) {
    share_out(o, sources, arguments, instances, check, relay, result);
}
template void solve_on_several_gpus(const options&, const std::vector<engine_source<double>>&,
                                    const any_arguments<double>&, ensemble_data<double>&, data_check<double>&,
                                    progress_relay&, report_of<double>&);
template void solve_on_several_gpus(const options&, const std::vector<engine_source<float>>&,
                                    const any_arguments<float>&, ensemble_data<float>&, data_check<float>&,
                                    progress_relay&, report_of<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
