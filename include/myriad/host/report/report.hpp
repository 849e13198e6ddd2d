// SPDX-License-Identifier: MIT
// The outcome of a call: how the instances ended, the first failure with its inputs, the work, the records.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <locale>
#include <mutex>
#include <numeric>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/core/left_behind.hpp"
#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad {

/// The name of a status, as in the code.
inline const char* name_of(status s) {
    constexpr const char* names[status_count] = {
        "not_started",    "success",    "stopped_by_event",   "stopped_by_user",   "max_steps",
        "step_underflow", "not_finite", "event_accumulation", "singular_jacobian", "invalid_input"};
    return names[static_cast<int>(s)];
}

/// States and accessories kept at the end of every recorded phase. Each accessor returns a map with one row per
/// instance and one column per recorded phase. Phases after an instance has ended are NaN (0 for integers). Maps point
/// into the records, so those of a temporary, as in `solve(...).records.state(0)`, are refused: give the report a name.
template <class Model, class R>
class phase_records {
public:
    /// An array of Eigen with one row per instance and one column per recorded phase.
    template <class T>
    using map = Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, Eigen::Dynamic>>;

    /// Made by `solve` and `solver`, for `size` instances and `phases` phases.
    phase_records() = default;
    phase_records(const record_options& o, std::int64_t phases, std::int64_t size) : size_(size) {
        if (o.empty()) return;
        phases_ = phases - o.from_phase;
        from_phase_ = o.from_phase;
        for (const int c : o.states) state_[static_cast<std::size_t>(c)] = columns_++;
        for (const int c : o.accessories) accessory_[static_cast<std::size_t>(c)] = columns_++;
        if (o.time) time_ = columns_++;
        for (const int c : o.integer_accessories) integer_accessory_[static_cast<std::size_t>(c)] = integer_columns_++;
        values_ = host::component_array<R>(columns_, size * phases_, std::numeric_limits<R>::quiet_NaN());
        integers_ = host::component_array<std::int32_t>(integer_columns_, size * phases_, 0);
    }

    /// The memory they take.
    static double bytes_for(const record_options& o, std::int64_t phases, std::int64_t size) {
        const std::size_t reals = o.states.size() + o.accessories.size() + (o.time ? 1 : 0);
        return static_cast<double>(size) * static_cast<double>(phases - o.from_phase) *
               static_cast<double>(sizeof(R) * reals + sizeof(std::int32_t) * o.integer_accessories.size());
    }

    /// Number of recorded phases.
    std::int64_t phases() const { return phases_; }
    /// State component c at the end of each recorded phase. Throws `error` if it was not recorded.
    template <class C>
    map<R> state(C c) const& {
        return column(state_, host::state_numbering<Model>::index(c), "state", values_);
    }
    /// Accessory c at the end of each recorded phase. Throws `error` if it was not recorded.
    template <class C>
    map<R> accessory(C c) const& {
        return column(accessory_, host::accessory_numbering<Model>::index(c), "accessory", values_);
    }
    /// Integer accessory c at the end of each recorded phase. Throws `error` if it was not recorded.
    template <class C>
    map<std::int32_t> integer_accessory(C c) const& {
        return column(integer_accessory_, host::integer_accessory_numbering<Model>::index(c), "integer accessory",
                      integers_);
    }
    template <class C>
    map<R> state(C) const&& = delete;
    template <class C>
    map<R> accessory(C) const&& = delete;
    template <class C>
    map<std::int32_t> integer_accessory(C) const&& = delete;
    /// Time at the end of the phase.
    map<R> time() const& { return column(std::array<int, 1>{time_}, 0, "time", values_); }
    map<R> time() const&& = delete;

    /// Forgets what was recorded.
    void clear() {
        values_.fill(std::numeric_limits<R>::quiet_NaN());
        integers_.fill(0);
    }

    /// Pins their memory, for copies from GPUs.
    void pin(int device) {
        values_.pin(device);
        integers_.pin(device);
    }

    /// Passes their memory to a kernel; used by the library.
    void describe(detail::record_arguments<Model, R>& a) {
        a.values = values_.data();
        a.integers = integers_.data();
        a.from_phase = static_cast<std::int32_t>(from_phase_);
        a.phases = static_cast<std::int32_t>(phases_);
        a.time_column = static_cast<std::int16_t>(time_);
        for (std::size_t c = 0; c < state_.size(); ++c) a.state_column[c] = static_cast<std::int16_t>(state_[c]);
        for (std::size_t c = 0; c < accessory_.size(); ++c)
            a.accessory_column[c] = static_cast<std::int16_t>(accessory_[c]);
        for (std::size_t c = 0; c < integer_accessory_.size(); ++c)
            a.integer_accessory_column[c] = static_cast<std::int16_t>(integer_accessory_[c]);
    }

private:
    template <int n>
    static constexpr std::array<int, static_cast<std::size_t>(n)> none() {
        std::array<int, static_cast<std::size_t>(n)> columns{};
        for (int& c : columns) c = -1;
        return columns;
    }
    template <class Columns, class T>
    map<T> column(const Columns& columns, std::int64_t c, const char* what,
                  const host::component_array<T>& from) const {
        require(c >= 0 && c < static_cast<std::int64_t>(columns.size()) && columns[static_cast<std::size_t>(c)] >= 0,
                what, " ", c, " was not recorded: name it in options::record");
        require(size_ > 0, "these records were moved away: ask those that they were moved to");
        return map<T>(from.component(columns[static_cast<std::size_t>(c)]), size_, phases_);
    }

    host::moved_number<std::int64_t> size_ = 0, phases_ = 0;
    std::int64_t from_phase_ = 0;
    int columns_ = 0, integer_columns_ = 0;
    std::array<int, static_cast<std::size_t>(detail::n_state<Model>)> state_ = none<detail::n_state<Model>>();
    std::array<int, static_cast<std::size_t>(detail::n_accessory<Model>)> accessory_ =
        none<detail::n_accessory<Model>>();
    std::array<int, static_cast<std::size_t>(detail::n_integer_accessory<Model>)> integer_accessory_ =
        none<detail::n_integer_accessory<Model>>();
    int time_ = -1;
    host::component_array<R> values_;
    host::component_array<std::int32_t> integers_;
};

/// The outcome of one call to solve.
template <class Model, class R>
struct report {
    std::int64_t instances = 0;                          ///< number of instances of the call
    std::array<std::int64_t, status_count> by_status{};  ///< number of instances with each status

    std::int64_t first_failed = -1;                     ///< index of the first instance with a failure status, or -1
    myriad::status first_status = status::not_started;  ///< its status
    R first_t = 0;                                      ///< the time at which it failed
    R first_t_begin = 0;                                ///< the begin of its time domain
    R first_t_end = 0;                                  ///< the end of its time domain
    std::vector<R> first_state;  ///< its last finite state; empty if that or its parameters were set since it failed
    std::vector<R> first_parameter;  ///< its parameters; empty in the same case

    std::int64_t accepted_steps = 0;   ///< of all instances in this call; zero with `counting::off`
    std::int64_t rejected_steps = 0;   ///< trial steps that failed the error test, of all instances
    std::int64_t located_steps = 0;    ///< trial steps redone to locate events
    std::int64_t rhs_evaluations = 0;  ///< evaluations of `rhs`, of all instances
    std::int64_t lane_turns = 0;       ///< trial steps times lanes, including idle lanes
    int lanes = 1;                     ///< instances side by side in one pack, or CUDA threads in a block
    int threads = 1;                   ///< that did some work; may be fewer than the device has
    double seconds = 0;                ///< wall time of the integration, on a GPU with transfers
    std::string device;                ///< its name, as in device::parse
    std::string instruction_set;       ///< on the CPU, of the kernel that ran: avx512, avx2, sse2 or generic
    cuda::kernel_facts kernel;         ///< on a GPU: the kernel's registers, block size and shared parameters
    double kernel_seconds = 0;         ///< on a GPU: time of the kernels alone
    phase_records<Model, R> records;   ///< what `options::record` asked for
    std::vector<std::string> notes;    ///< tolerances raised; from `solve` also that the equations are stiff, or
                                       ///< phases too long for the smallest Lyapunov exponent

    /// Number of instances with that status.
    std::int64_t count(status s) const { return by_status[static_cast<std::size_t>(s)]; }
    /// Instances with a failure status.
    std::int64_t failed() const {
        std::int64_t sum = 0;
        for (int s = 0; s < status_count; ++s)
            if (is_failure(static_cast<status>(s))) sum += by_status[static_cast<std::size_t>(s)];
        return sum;
    }
    /// Fraction of lane iterations in which the lane was idle, from 0 to 1; zero with `counting::off`. A fixed step
    /// that ends an instance because its result is not finite counts as idle.
    double idle_share() const {
        const std::int64_t used = accepted_steps + rejected_steps + located_steps;
        return used == 0 || lane_turns == 0 ? 0 : 1 - static_cast<double>(used) / static_cast<double>(lane_turns);
    }
};

/// Prints a human-readable report, with the stream's precision, but not its locale.
template <class Model, class R>
std::ostream& operator<<(std::ostream& stream, const report<Model, R>& r) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(stream.precision());
    out << r.instances << " instances:";
    const char* separator = " ";
    for (int s = 0; s < status_count; ++s) {
        const std::int64_t n = r.by_status[static_cast<std::size_t>(s)];
        if (n == 0) continue;
        out << separator << n << ' ' << name_of(static_cast<status>(s));
        separator = ", ";
    }
    out << "; " << r.seconds << " s on ";
    if (r.kernel.block_size > 0) {
        out << r.device << ", of them " << r.kernel_seconds << " s in kernels of " << r.kernel.registers
            << " registers and " << r.kernel.local_bytes << " bytes of local memory per thread, " << r.kernel.block_size
            << " threads per block, shared parameters in " << name_of(r.kernel.shared_placement) << '\n';
    } else {
        out << r.threads << (r.threads == 1 ? " thread of " : " threads of ") << r.lanes
            << (r.lanes == 1 ? " lane, " : " lanes, ") << r.instruction_set << '\n';
    }
    if (r.accepted_steps + r.rejected_steps > 0) {
        out << r.accepted_steps << " steps accepted, " << r.rejected_steps << " rejected, " << r.located_steps
            << " redone to locate events; " << r.rhs_evaluations << " evaluations of the right-hand side\n";
    }
    if (r.first_failed >= 0) {
        out << "first failure: instance " << r.first_failed << " ended as " << name_of(r.first_status)
            << " at t = " << r.first_t << " of [" << r.first_t_begin << ", " << r.first_t_end << ']'
            << (r.first_state.empty() ? "; its state or parameters were set anew since" : "; state");
        for (const R v : r.first_state) out << ' ' << v;
        if (!r.first_parameter.empty()) out << "; parameters";
        for (const R v : r.first_parameter) out << ' ' << v;
        out << '\n';
    }
    for (const std::string& note : r.notes) out << "note: " << note << '\n';
    return stream << out.str();
}

namespace host {

/// Accepted, rejected and located steps, evaluations.
using work_count = std::array<std::int64_t, 4>;

/// The work that `count` instances from `first` on have counted so far.
template <class Model, class R>
work_count counted_work(const ensemble<Model, R>& e, std::int64_t count, std::int64_t first = 0) {
    work_count work{};
    if (!e.counted() || ensemble_access::untouched(e)) return work;
    const auto counters = ensemble_access::counters(e);
    std::array<std::atomic<std::int64_t>, 4> sums{};
    in_parallel(count, 16'384, [&](std::int64_t begin, std::int64_t end) {
        for (std::size_t c = 0; c < sums.size(); ++c)
            if (counters[c] != nullptr)
                sums[c] += std::accumulate(counters[c] + first + begin, counters[c] + first + end, std::int64_t{0});
    });
    for (std::size_t c = 0; c < sums.size(); ++c) work[c] = sums[c];
    return work;
}

/// How many of the first `count` instances ended in earlier calls and were given new states or parameters since.
template <class Model, class R>
std::int64_t count_given_anew(const ensemble<Model, R>& e, std::int64_t count) {
    const auto& before = ensemble_access::ended_before(e);
    return std::count_if(before.begin(), before.end(),
                         [&](const auto& i) { return i.index < count && ensemble_access::given_anew(e, i); });
}

template <class Model, class R>
void set_work(report<Model, R>& r, const work_count& before, const work_count& after) {
    r.accepted_steps = after[0] - before[0];
    r.rejected_steps = after[1] - before[1];
    r.located_steps = after[2] - before[2];
    r.rhs_evaluations = after[3] - before[3];
}

/// Counts of each value among `count` statuses, and the index of the first failure, or `count`.
class status_count_of {
public:
    status_count_of(const status* statuses, std::int64_t count) : first_failed_(count) {
        in_parallel(count, 262'144, [&](std::int64_t begin, std::int64_t end) { add(statuses, begin, end); });
    }
    const std::array<std::int64_t, status_count>& by_status() const { return by_status_; }
    std::int64_t first_failed() const { return first_failed_; }

private:
    void add(const status* statuses, std::int64_t begin, std::int64_t end) {
        std::array<std::int64_t, status_count> found{};
        std::int64_t failed = end;
        for (constexpr std::int64_t block = 4096; begin < end; begin += block) {
            const std::int64_t size = std::min(block, end - begin);
            // In most blocks all are equal, which vector instructions detect quickly.
            const status first = statuses[begin];
            unsigned char differs = 0;
            for (std::int64_t i = begin; i < begin + size; ++i)
                differs |= static_cast<unsigned char>(static_cast<unsigned char>(statuses[i]) ^
                                                      static_cast<unsigned char>(first));
            if (differs == 0 && !is_failure(first)) {
                found[static_cast<std::size_t>(first)] += size;
                continue;
            }
            for (std::int64_t i = begin; i < begin + size; ++i) {
                ++found[static_cast<std::size_t>(statuses[i])];
                if (is_failure(statuses[i])) failed = std::min(failed, i);
            }
        }
        const std::lock_guard lock(mutex_);
        for (std::size_t s = 0; s < found.size(); ++s) by_status_[s] += found[s];
        if (failed < end) first_failed_ = std::min(first_failed_, failed);
    }

    std::mutex mutex_;
    std::array<std::int64_t, status_count> by_status_{};
    std::int64_t first_failed_;
};

/// Adds how instances [first, first + count) ended; to be called in the order of instances.
template <class Model, class R>
void add_summary(const ensemble<Model, R>& e, report<Model, R>& r, std::int64_t first, std::int64_t count) {
    const status_count_of found(e.statuses() + first, count);
    r.instances += count;
    for (std::size_t s = 0; s < r.by_status.size(); ++s) r.by_status[s] += found.by_status()[s];
    if (r.first_failed >= 0 || found.first_failed() == count) return;
    const std::int64_t i = first + found.first_failed();
    r.first_failed = i;
    r.first_status = e.statuses()[i];
    r.first_t = e.t()[i];
    const ended_instance<R>* const before = ensemble_access::ended_before(e).find(i);
    r.first_t_begin = before != nullptr ? before->t_begin : e.t_begin_of(i);
    r.first_t_end = before != nullptr ? before->t_end : e.t_end_of(i);
    r.first_state.clear();
    r.first_parameter.clear();
    if (before != nullptr && ensemble_access::given_anew(e, *before)) return;
    for (int c = 0; c < detail::n_state<Model>; ++c) r.first_state.push_back(e.state(c)[i]);
    for (int c = 0; c < detail::n_parameter<Model>; ++c) r.first_parameter.push_back(e.parameter(c)[i]);
}

/// How the first `count` instances ended.
template <class Model, class R>
void summarise(const ensemble<Model, R>& e, report<Model, R>& r, std::int64_t count) {
    r.instances = 0;
    r.by_status = {};
    r.first_failed = -1;
    add_summary(e, r, 0, count);
}

}  // namespace host
}  // namespace myriad
