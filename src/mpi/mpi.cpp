// SPDX-License-Identifier: MIT
// Ranks that share a counter, and what is done where one of them dies.
#include "myriad/mpi.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include <sched.h>

#include "myriad/host/core/error.hpp"
#include "myriad/study/store/writer.hpp"

namespace myriad {

namespace {

using clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds poll_every{1};      // where other ranks need this one to make progress
constexpr milliseconds look_every{200};    // whether a process has ended
constexpr milliseconds patience{10'000};   // with the counter, which takes microseconds unless its rank is dead
constexpr milliseconds last_wait{60'000};  // for ranks of other machines, when the study is complete

/// An MPI call that must not fail.
void check(int result, const char* doing) {
    if (result == MPI_SUCCESS) return;
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    MPI_Error_string(result, text.data(), &length);
    throw error(message(doing, " over MPI failed: ", std::string_view(text.data(), static_cast<std::size_t>(length))));
}

/// The counter in the memory of rank 0. Only its own thread calls MPI, so that a call which waits for a dead rank stops
/// nothing else.
class counter {
public:
    /// All ranks make it at the same time.
    counter(MPI_Comm ranks, bool serves) : ranks_(ranks), serves_(serves) {
        check(MPI_Win_allocate(serves ? sizeof(std::int64_t) : 0, sizeof(std::int64_t), MPI_INFO_NULL, ranks, &value_,
                               &window_),
              "making a counter");
        MPI_Win_set_errhandler(window_, MPI_ERRORS_RETURN);
        if (serves) *value_ = 0;
        check(MPI_Barrier(ranks), "making a counter");
        check(MPI_Win_lock_all(MPI_MODE_NOCHECK, window_), "making a counter");
    }

    /// The next number, -1 if the counter does not answer any more.
    std::int64_t next() {
        const std::lock_guard one_at_a_time(asking_);
        std::unique_lock lock(mutex_);
        if (failed_) return -1;
        asked_ = true;
        answer_.reset();
        changed_.notify_all();
        failed_ = !changed_.wait_for(lock, patience, [&] { return answer_.has_value(); });
        failed_ = failed_ || *answer_ < 0;
        return failed_ ? -1 : *answer_;
    }

    /// Waits until all ranks have called it. False if one of them has died; then the counter is left behind.
    /// `is_lost(waited)` says whether one has, called now and then.
    template <class Function>
    bool leave(Function is_lost) {
        const auto begin = clock::now();
        std::unique_lock lock(mutex_);
        leaving_ = true;
        changed_.notify_all();
        while (!changed_.wait_for(lock, look_every, [&] { return all_left_ || broken_; })) {
            lock.unlock();
            const bool lost = is_lost(clock::now() - begin);
            lock.lock();
            // It may have left just before it ended.
            if (lost && !changed_.wait_for(lock, look_every, [&] { return all_left_; })) break;
        }
        ending_ = true;
        changed_.notify_all();
        return all_left_;
    }

    /// What the thread does until all ranks have left.
    void serve() {
        std::unique_lock lock(mutex_);
        while (!leaving_ && !ending_) {
            const auto wanted = [&] { return asked_ || leaving_ || ending_; };
            if (serves_)
                changed_.wait_for(lock, poll_every, wanted);
            else
                changed_.wait(lock, wanted);
            const bool fetches = std::exchange(asked_, false);
            lock.unlock();
            const std::int64_t got = fetches ? fetch() : make_progress();
            lock.lock();
            if (fetches) answer_ = got;
            changed_.notify_all();
        }
        MPI_Request all = MPI_REQUEST_NULL;
        broken_ = MPI_Ibarrier(ranks_, &all) != MPI_SUCCESS;
        while (!all_left_ && !broken_ && !ending_) {
            lock.unlock();
            int done = 0;
            const int result = MPI_Test(&all, &done, MPI_STATUS_IGNORE);
            lock.lock();
            broken_ = result != MPI_SUCCESS;
            all_left_ = !broken_ && done != 0;
            if (!all_left_ && !broken_) changed_.wait_for(lock, poll_every, [&] { return ending_; });
        }
        if (all_left_) {
            MPI_Win_unlock_all(window_);
            MPI_Win_free(&window_);
        }
        ended_ = true;
        changed_.notify_all();
    }
    /// Whether the thread has ended, or does soon.
    bool ends() {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, all_left_ ? patience : milliseconds(1000), [&] { return ended_; });
    }

private:
    std::int64_t fetch() {
        constexpr std::int64_t one = 1;
        std::int64_t got = -1;
        const bool well = MPI_Fetch_and_op(&one, &got, MPI_INT64_T, 0, 0, MPI_SUM, window_) == MPI_SUCCESS &&
                          MPI_Win_flush(0, window_) == MPI_SUCCESS;
        return well ? got : -1;
    }
    /// Lets other ranks reach the counter where hardware does not do it alone.
    std::int64_t make_progress() const {
        int any = 0;
        MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, ranks_, &any, MPI_STATUS_IGNORE);
        return 0;
    }

    const MPI_Comm ranks_;
    const bool serves_;
    std::int64_t* value_ = nullptr;
    MPI_Win window_ = MPI_WIN_NULL;

    std::mutex asking_;
    std::mutex mutex_;  // of what follows
    std::condition_variable changed_;
    bool asked_ = false, failed_ = false, leaving_ = false, all_left_ = false, broken_ = false, ending_ = false,
         ended_ = false;
    std::optional<std::int64_t> answer_;
};

/// The counter with its thread. All ranks make it at the same time.
class served_counter {
public:
    served_counter(MPI_Comm ranks, bool serves) : counter_(std::make_shared<counter>(ranks, serves)) {
        thread_ = std::thread([c = counter_] { c->serve(); });
    }
    ~served_counter() {
        // A call that waits for a dead rank does not return: its thread stays behind.
        if (counter_->ends())
            thread_.join();
        else
            thread_.detach();
    }
    counter& operator*() const { return *counter_; }
    counter* operator->() const { return counter_.get(); }

private:
    std::shared_ptr<counter> counter_;
    std::thread thread_;
};

std::vector<std::string> all_processes(MPI_Comm ranks, int size) {
    constexpr std::size_t length = 512;
    std::string own = studies::process_identity::own(studies::file_system::real(), "/").id;
    own.resize(length);
    std::string all(length * static_cast<std::size_t>(size), '\0');
    check(MPI_Allgather(own.data(), length, MPI_CHAR, all.data(), length, MPI_CHAR, ranks), "naming the processes");
    std::vector<std::string> names;
    for (int r = 0; r < size; ++r)
        names.emplace_back(all.c_str() + length * static_cast<std::size_t>(r));  // up to its end
    return names;
}

/// How many of its machine's cores are this rank's.
int share_of_cores(MPI_Comm here, int rank, int size) {
    cpu_set_t own;
    CPU_ZERO(&own);
    if (::sched_getaffinity(0, sizeof own, &own) != 0) return 1;
    std::vector<cpu_set_t> all(static_cast<std::size_t>(size));
    check(MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, here), "dividing the cores");
    // Ranks that may use the same cores divide them: the first ones get those that are left over.
    double before = 0, after = 0;
    for (int core = 0; core < CPU_SETSIZE; ++core) {
        if (!CPU_ISSET(core, &own)) continue;
        int sharing = 0, earlier = 0;
        for (int r = 0; r < size; ++r) {
            if (!CPU_ISSET(core, &all[static_cast<std::size_t>(r)])) continue;
            ++sharing;
            if (r < rank) ++earlier;
        }
        before += static_cast<double>(earlier) / sharing;
        after += static_cast<double>(earlier + 1) / sharing;
    }
    constexpr double rounding = 1e-6;
    return std::max(1, static_cast<int>(after + rounding) - static_cast<int>(before + rounding));
}

}  // namespace

mpi_ranks::mpi_ranks(MPI_Comm ranks) {
    int is_there = 0, level = MPI_THREAD_SINGLE;
    MPI_Initialized(&is_there);
    if (is_there == 0) {
        check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &level), "the start");
        finalizes_ = true;
    } else {
        MPI_Query_thread(&level);
    }
    require(level >= MPI_THREAD_SERIALIZED, "MPI was initialised for one thread alone", host::cure,
            "call MPI_Init_thread with MPI_THREAD_SERIALIZED, or leave it to myriad::mpi_ranks");
    check(MPI_Comm_dup(ranks, &ranks_), "the start");
    MPI_Comm_set_errhandler(ranks_, MPI_ERRORS_RETURN);
    MPI_Comm_rank(ranks_, &rank_);
    MPI_Comm_size(ranks_, &size_);
    devices_ = own_devices();
    processes_ = all_processes(ranks_, size_);
}

mpi_ranks::~mpi_ranks() {
    int is_over = 0;
    MPI_Finalized(&is_over);
    if (lost_ || is_over != 0) return;
    MPI_Comm_free(&ranks_);
    if (finalizes_) MPI_Finalize();
}

std::vector<device> mpi_ranks::own_devices() const {
    MPI_Comm here = MPI_COMM_NULL;
    check(MPI_Comm_split_type(ranks_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here), "finding the machines");
    int rank = 0, size = 1;
    MPI_Comm_rank(here, &rank);
    MPI_Comm_size(here, &size);
    const int cores = share_of_cores(here, rank, size);
    MPI_Comm_free(&here);
    std::vector<device> gpus, own;
    for (const device& d : myriad::devices())
        if (d.which() != device::kind::cpu) gpus.push_back(d);
    const auto count = static_cast<int>(gpus.size());
    if (count == 0) return {device::cpu(cores)};
    for (int g = rank % count; g < count; g += size) own.push_back(gpus[static_cast<std::size_t>(g)]);
    return own;
}

/// Rank 0 makes the store, or refuses the study, before the others look at it.
void mpi_ranks::begin(any_study& s) const {
    std::exception_ptr failure;
    if (rank_ == 0) {
        try {
            s.check();
        } catch (...) {
            failure = std::current_exception();
        }
    }
    int starts = failure ? 0 : 1;
    check(MPI_Bcast(&starts, 1, MPI_INT, 0, ranks_), "starting a study");
    if (failure) std::rethrow_exception(failure);
    require(starts == 1, "rank 0 does not start the study: its message says why");
}

study_result mpi_ranks::run(any_study& s) {
    const struct restored {  // what is set for this run
        any_study& s;
        std::vector<device> devices = s.devices;
        std::function<std::int64_t()> chunk_counter = s.chunk_counter;
        ~restored() {
            s.devices = std::move(devices);
            s.chunk_counter = std::move(chunk_counter);
        }
    } as_before{s};
    if (s.devices.empty()) s.devices = devices_;
    s.chunk_counter = [] { return std::int64_t{-1}; };  // the claims alone, if there is no counter
    if (lost_) return s.run();

    begin(s);
    const served_counter chunks(ranks_, rank_ == 0);
    s.chunk_counter = [&] { return chunks->next(); };
    std::optional<study_result> result;
    std::exception_ptr failure;
    try {
        result = s.run();
    } catch (...) {
        failure = std::current_exception();
    }
    const bool complete = result && result->complete;
    const auto own = studies::process_identity::of(processes_[static_cast<std::size_t>(rank_)]);
    const auto has_ended = [&](std::size_t r) {
        return own.state_of(studies::process_identity::of(processes_[r])) == studies::process_state::ended;
    };
    lost_ = !chunks->leave([&](clock::duration waited) {
        for (std::size_t r = 0; r < processes_.size(); ++r)
            if (std::cmp_not_equal(r, rank_) && has_ended(r)) return true;
        return complete && waited > last_wait;
    });
    if (failure) std::rethrow_exception(failure);
    return std::move(*result);
}

}  // namespace myriad
