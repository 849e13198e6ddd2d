// SPDX-License-Identifier: MIT
// The threads of a running study.
#include "myriad/study/run/runner.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

#include "chunk_values.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/study/run/work_sharing.hpp"
#include "study_reductions.hpp"
#include "used_device.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

class run {
public:
    run(const any_model& model, const study_plan& plan, result_keeper& keeper, const run_settings& settings)
        : model_(model), plan_(plan), keeper_(keeper), settings_(settings),
          sharing_(settings.devices, keeper.content().chunk, settings.tried_after), earlier_(keeper.instances_done()),
          committed_(earlier_) {
        for (const device& d : settings.devices) devices_.emplace_back(d, devices_.size());
    }

    run_outcome all() {
        warnings_ = keeper_.warnings();
        if (!keeper_.complete()) run_threads();
        tell_warnings();
        show();
        outcome_.seconds = seconds_since(begin_);
        if (failure_) std::rethrow_exception(failure_);
        outcome_.complete = keeper_.complete();
        outcome_.by_status = of_all_.by_status;
        outcome_.notes = of_all_.notes;
        if (outcome_.complete) finish_reductions(plan_, keeper_);
        return std::move(outcome_);
    }

private:
    static constexpr int threads_per_device = 2;
    static constexpr auto look_every = std::chrono::milliseconds(100);    // for signals, and to show progress
    static constexpr auto ask_every = std::chrono::milliseconds(500);     // for chunks of other processes
    static constexpr auto compare_every = std::chrono::milliseconds(10);  // with slower devices
    static constexpr auto count_every = std::chrono::seconds(5);          // what other processes have done

    // -- The calling thread -------------------------------------------------------------------------------------------

    void run_threads() {
        std::vector<std::thread> threads;
        for (const used_device& d : devices_)
            for (int t = 0; t < threads_per_device; ++t) under_way_.emplace_back(d.number);
        try {
            for (thread_work& mine : under_way_) {
                const std::lock_guard lock(mutex_);
                threads.emplace_back([this, &mine] { work_until_the_end(devices_[mine.number], mine); });
                ++working_;
            }
            watch();
        } catch (...) {
            fail(std::current_exception());
        }
        for (std::thread& t : threads) t.join();
    }
    void watch() {
        auto counted = clock::now();
        std::unique_lock lock(mutex_);
        while (working_ > 0) {
            changed_.wait_for(lock, look_every);
            lock.unlock();
            if (settings_.stops && settings_.stops()) stop();
            if (clock::now() - counted > count_every) {
                counted = clock::now();
                const std::int64_t done = keeper_.instances_done();
                const std::lock_guard again(mutex_);
                committed_ = std::max(committed_, done);
            }
            tell_warnings();
            show();
            lock.lock();
        }
    }
    void show() {
        if (!settings_.progress || failure_told_) return;
        work_progress now;
        {
            const std::lock_guard lock(mutex_);
            now = {.done = committed_,
                   .total = plan_.content.instances(),
                   .earlier = earlier_,
                   .seconds = seconds_since(begin_),
                   .by_status = of_all_.by_status};
            for (const thread_work& t : under_way_) now.done += t.done;
        }
        now.done = shown_ = std::clamp(now.done, shown_, now.total);  // a device that failed loses what it had
        call([&] { settings_.progress(now); });
    }
    void tell_warnings() {
        std::vector<std::string> told;
        {
            const std::lock_guard lock(mutex_);
            std::swap(told, warnings_);
        }
        for (std::string& text : told) {
            if (settings_.warning && !failure_told_) call([&] { settings_.warning(text); });
            outcome_.warnings.push_back(std::move(text));
        }
    }
    /// An exception of the user's function ends the run.
    template <class Function>
    void call(Function&& function) {
        try {
            function();
        } catch (...) {
            failure_told_ = true;
            fail(std::current_exception());
        }
    }

    // -- The threads of devices ---------------------------------------------------------------------------------------

    void work_until_the_end(used_device& d, thread_work& mine) {
        try {
            work(d, mine);
        } catch (const given_up&) {  // by the next run it is done again
        } catch (const std::exception& e) {
            // A GPU whose memory does not suffice for anything is none; the CPU's is all that there is.
            if (d.where.which() != device::kind::cpu && is_out_of_memory(e)) drop(d, e);
            if (!d.failed) {
                fail(std::current_exception());
            } else if (std::all_of(devices_.begin(), devices_.end(),
                                   [](const used_device& u) { return u.failed.load(); })) {
                fail(std::make_exception_ptr(
                    error(statement_of("no device is left: the last one failed with: ", d.why))));
            }
        } catch (...) {
            fail(std::current_exception());
        }
        const std::lock_guard lock(mutex_);
        --working_;
        changed_.notify_all();
    }

    void work(used_device& d, thread_work& mine) {
        std::unique_ptr<chunk_solver> solver = model_.make_device_solver(plan_, d.where);
        if (solver == nullptr) solver = model_.make_solver(plan_, d.where);
        const std::vector<bool> wanted =
            solver->on_device() ? plan_.needed_on_host() : std::vector<bool>(plan_.quantities.size(), true);
        std::int64_t piece = content().chunk;
        if (settings_.piece > 0 && !solver->on_device()) piece = std::min(settings_.piece, piece);
        as_device(d, *solver, [&] { piece = std::min(piece, solver->most_at_a_time()); });
        while (const std::optional<std::int64_t> chunk = next_chunk(d, mine)) {
            const chunk_range range = range_of(content(), *chunk);
            const auto begin = clock::now();
            const auto leave = [&] {
                mine.done = mine.rest = 0;
                mine.is_wanted = false;
                d.exploring = false;
            };
            try {
                chunk_values made(plan_, wanted);
                compute(d, *solver, range, piece, made, mine);
                const double seconds = seconds_since(begin);
                made.commit(keeper_, *chunk, {d.where.description(), seconds, {}, model_.arithmetic_on(d.where)});
                const std::lock_guard lock(mutex_);
                committed_ += range.count;
                outcome_.instances += range.count;
                of_all_.add(made.how());
                leave();
            } catch (const handed_back&) {
                solver->clear();
                sharing_.gave_back(d.number, mine.done, seconds_since(begin));
                leave();
                give_back(*chunk);
            } catch (...) {
                leave();
                give_back(*chunk);
                throw;
            }
            changed_.notify_all();
        }
    }
    const layout& content() const { return keeper_.content(); }

    /// The next chunk for this device; nothing if it is to end.
    std::optional<std::int64_t> next_chunk(used_device& d, thread_work& mine) {
        for (;;) {
            if (stopping_ || d.failed || (settings_.stops && settings_.stops())) return {};
            // A CPU's first chunk alone, as long as it is not known how fast it is.
            const bool may_have_two = d.where.which() != device::kind::cpu || sharing_.is_known(d.number);
            if (is_worthwhile(d, content().chunk, left()) && (may_have_two || !d.exploring.exchange(true))) {
                if (const auto chunk = keeper_.claim_next()) {
                    mine.begun = clock::now().time_since_epoch().count();
                    mine.rest = range_of(content(), *chunk).count;
                    return chunk;
                }
                d.exploring = false;
            }
            if (keeper_.complete()) return {};
            // Others are at work on the rest. They may be slow, fail, or be in other processes, and die.
            const auto until = clock::now() + ask_every;
            do {
                ask_for_a_chunk(d);
                std::unique_lock lock(mutex_);
                if (stopping_ || changed_.wait_for(lock, compare_every) == std::cv_status::no_timeout) break;
            } while (clock::now() < until);
        }
    }
    /// Instances that are not done.
    std::int64_t left() {
        std::int64_t left = content().instances();
        const std::lock_guard lock(mutex_);
        left -= committed_;
        for (const thread_work& t : under_way_) left -= t.done;
        return left;
    }
    /// Whether a device should do so many instances beside those that its threads have, or go on with these.
    bool is_worthwhile(const used_device& d, std::int64_t more, std::int64_t left) {
        for (const thread_work& t : under_way_)
            if (t.number == d.number) more += t.rest;
        return sharing_.is_worthwhile(d.number, more, left, seconds_since(begin_));
    }
    /// Asks another device for a chunk that this one, which has nothing to do, is done with earlier.
    void ask_for_a_chunk(const used_device& d) {
        for (thread_work& t : under_way_) {
            if (t.rest == 0 || t.is_wanted) continue;
            const double seconds = seconds_since(clock::time_point(clock::duration(t.begun)));
            if (!sharing_.is_better_off_with(d.number, t.number, t.rest, t.done, seconds)) continue;
            t.is_wanted = true;
            return;
        }
    }

    /// Sets and integrates a chunk, in pieces if memory is short or the device may be slow, and copies or reduces what
    /// is kept.
    void compute(used_device& d, chunk_solver& solver, const chunk_range& range, std::int64_t& piece,
                 chunk_values& made, thread_work& mine) {
        for (std::int64_t at = 0; at < range.count;) {
            if (mine.is_wanted || (at > 0 && !is_worthwhile(d, 0, left() + at))) throw handed_back();
            const std::int64_t rest = range.count - at;
            const std::int64_t count = std::min(piece, sharing_.part(d.number, rest, left()));
            try {
                made.make_room(range.count, at + count);
                as_device(d, solver, [&] { solver.prepare(range.first + at, count); });
                const auto progress = [&](std::int64_t done) {
                    mine.done = at + done;
                    mine.rest = rest - done;
                    if (done < count && is_over()) throw given_up();
                    if (done < count && mine.is_wanted) throw handed_back();
                };
                double seconds = 0;
                const solved how = integrate(d, solver, progress, seconds);
                const bool was_known = sharing_.is_known(d.number);
                sharing_.measured(d.number, count, seconds);
                if (!was_known) changed_.notify_all();
                as_device(d, solver, [&] { made.take(solver, at, how); });
            } catch (const out_of_memory& e) {
                halve(piece, count, solver, e.what());
                continue;
            } catch (const std::bad_alloc&) {
                halve(piece, count, solver, "out of memory");
                continue;
            }
            at += count;
        }
    }
    solved integrate(used_device& d, chunk_solver& solver, const std::function<void(std::int64_t)>& progress,
                     double& seconds) {
        const std::lock_guard turn(d.turn);
        if (d.failed) throw device_lost();
        const auto begin = clock::now();
        // A GPU is lost with a driver's error. On the CPU, it is the model or the study that is wrong.
        solved how =
            losing(d, d.where.which() != device::kind::cpu, [&] { return solver.integrate(d.where, progress); });
        seconds += seconds_since(begin);
        return how;
    }
    /// Does what a solver that works on the device by itself does there.
    template <class Work>
    void as_device(used_device& d, const chunk_solver& solver, Work&& work) {
        if (solver.on_device() && d.failed) throw device_lost();
        losing(d, solver.on_device(), work);
    }
    /// Drops the device if the work on it fails.
    template <class Work>
    std::invoke_result_t<Work&> losing(used_device& d, bool on_device, Work&& work) {
        try {
            return work();
        } catch (const out_of_memory&) {
            throw;
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const ended_early&) {
            throw;
        } catch (const std::exception& e) {
            if (on_device) drop(d, e);
            throw;
        }
    }
    static bool is_out_of_memory(const std::exception& e) {
        return dynamic_cast<const out_of_memory*>(&e) != nullptr || dynamic_cast<const std::bad_alloc*>(&e) != nullptr;
    }
    void halve(std::int64_t& piece, std::int64_t count, chunk_solver& solver, const std::string& why) {
        solver.clear();
        if (count == 1)
            throw out_of_memory(statement_of("there is not enough memory for the values of chunks of ", content().chunk,
                                             " instances", host::cure, host::cures::smaller_chunk,
                                             ", keep less, or use fewer devices (", why, ')'));
        piece = (count + 1) / 2;
        warn(message("memory is short, so ", piece, " instances are integrated at a time: ", why));
    }

    // -- Both ---------------------------------------------------------------------------------------------------------

    void give_back(std::int64_t chunk) {
        try {
            keeper_.release(chunk);
        } catch (...) {  // the reason why it is given back is what matters
        }
        changed_.notify_all();
    }
    /// Leaves a device out, once, whichever of its threads finds that it has failed.
    void drop(used_device& d, const std::exception& why) {
        const auto* const known = dynamic_cast<const error*>(&why);
        {
            const std::lock_guard lock(mutex_);
            if (d.failed) return;
            d.why = known != nullptr ? known->said() : statement(why.what());
            d.failed = true;
        }
        sharing_.drop(d.number);
        warn(message("device ", d.where.name(),
                     " is left out, and its chunks are done by others, as it failed: ", why.what()));
    }
    void warn(std::string text) {
        const std::lock_guard lock(mutex_);
        warnings_.push_back(std::move(text));
    }
    void stop() {
        stopping_ = true;
        changed_.notify_all();
    }
    /// Whether the run was to end so long ago that chunks under way are given up.
    bool is_over() {
        if (!stopping_ && !(settings_.stops && settings_.stops())) return false;
        const clock::rep now = clock::now().time_since_epoch().count();
        clock::rep none = 0;
        stopped_at_.compare_exchange_strong(none, now);
        return clock::duration(now - stopped_at_) >= settings_.patience;
    }
    void fail(std::exception_ptr why) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::move(why);
        stopping_ = true;
        changed_.notify_all();
    }
    const any_model& model_;
    const study_plan& plan_;
    result_keeper& keeper_;
    const run_settings& settings_;
    std::deque<used_device> devices_;
    work_sharing sharing_;
    std::deque<thread_work> under_way_;  // all there before the first thread
    clock::time_point begin_ = clock::now();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::atomic<bool> stopping_{false};
    std::atomic<clock::rep> stopped_at_{0};  // when that was first seen, by the clock; 0: not yet
    int working_ = 0;                        // threads
    std::int64_t earlier_, committed_;
    std::vector<std::string> warnings_;  // not told yet
    std::exception_ptr failure_;
    solved of_all_;
    run_outcome outcome_;

    bool failure_told_ = false;  // an exception came from a callback
    std::int64_t shown_ = 0;
};

}  // namespace

run_outcome run_study(const any_model& model, const study_plan& plan, result_keeper& keeper,
                      const run_settings& settings) {
    return run(model, plan, keeper, settings).all();
}

}  // namespace myriad::studies::inline MYRIAD_ABI
