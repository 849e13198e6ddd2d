// SPDX-License-Identifier: MIT
// What a report says of a call that does not depend on the model's type, and how it is gathered: compiled in the
// library. Host code only.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <exception>
#include <iosfwd>
#include <string>
#include <vector>

#include "myriad/host/backend/facts.hpp"
#include "myriad/host/core/left_behind.hpp"
#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/status_names.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/model/matrix_facts.hpp"

namespace myriad {

/// How the instances ended, the first failure with its inputs, the work.
template <class R>
struct report_of {
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
    matrix_facts matrix;               ///< of a stiff method: entries of the Jacobian and of its factors
    std::vector<statement> notes;      ///< tolerances raised; from `solve` also that the equations are stiff, or
                                       ///< phases too long for the smallest Lyapunov exponent

    /// Number of instances with that status.
    std::int64_t count(status s) const { return by_status[static_cast<std::size_t>(s)]; }
    /// Instances with a failure status.
    std::int64_t failed() const { return host::failed_in(by_status); }
    /// Fraction of lane iterations in which the lane was idle, from 0 to 1; zero with `counting::off`. A fixed step
    /// that ends an instance because its result is not finite counts as idle.
    double idle_share() const {
        const std::int64_t used = accepted_steps + rejected_steps + located_steps;
        return used == 0 || lane_turns == 0 ? 0 : 1 - static_cast<double>(used) / static_cast<double>(lane_turns);
    }
};

/// Prints a human-readable report, with the stream's precision, but not its locale.
std::ostream& operator<<(std::ostream& stream, const report_of<double>& r);
std::ostream& operator<<(std::ostream& stream, const report_of<float>& r);

namespace host::inline MYRIAD_ABI {

/// `phase_records` of any model.
template <class R>
struct record_data {
    record_data() = default;
    record_data(const model_shape& shape, const record_options& o, std::int64_t of_phases, std::int64_t of_instances);
    /// The memory they take.
    static double bytes_for(const record_options& o, std::int64_t phases, std::int64_t size);

    /// The column of component c. Throws `error` if it was not recorded, or the records were moved away.
    int find(const std::vector<std::int16_t>& columns, std::int64_t c, const char* what) const;
    void clear();
    void pin(int device);

    moved_number<std::int64_t> size = 0, phases = 0;
    std::int64_t from_phase = 0;
#define MYRIAD_DECLARE_COLUMNS(kind, ...) std::vector<std::int16_t> kind;  // -1: not recorded
    MYRIAD_RECORDED_KINDS(MYRIAD_DECLARE_COLUMNS)
#undef MYRIAD_DECLARE_COLUMNS
    std::int16_t time = -1;
    bool recorded = false;  // also of records that were moved away
    component_array<R> values;
    component_array<std::int32_t> integers;
    /// Those of components of that type.
    template <class T>
    const component_array<T>& of_type() const {
        if constexpr (std::is_same_v<T, R>) {
            return values;
        } else {
            return integers;
        }
    }
};
extern template struct record_data<double>;
extern template struct record_data<float>;

/// Accepted, rejected and located steps, evaluations.
using work_count = std::array<std::int64_t, 4>;

/// The work that `count` instances from `first` on have counted so far.
template <class R>
work_count counted_work(const ensemble_data<R>& e, std::int64_t count, std::int64_t first = 0);
template <class R>
void set_work(report_of<R>& r, const work_count& before, const work_count& after) {
    r.accepted_steps = after[0] - before[0];
    r.rejected_steps = after[1] - before[1];
    r.located_steps = after[2] - before[2];
    r.rhs_evaluations = after[3] - before[3];
}
/// Adds how instances [first, first + count) ended; to be called in the order of instances.
template <class R>
void add_summary(const ensemble_data<R>& e, report_of<R>& r, std::int64_t first, std::int64_t count);
/// How the first `count` instances ended.
template <class R>
void summarise(const ensemble_data<R>& e, report_of<R>& r, std::int64_t count);
/// What was found of instances whose steps may be limited by stability.
struct stiffness {
    std::int64_t looked_at = 0;
    std::int64_t limited = 0;  // by stability
    double share = 0;          // largest h lambda over the stability limit
};
/// How many times longer the steps of a stiff method must be to recommend it: one of them costs as much as several of
/// an explicit method.
inline constexpr double worthwhile_stretch = 20;
/// Adds a note if half of them or more are.
void add_note(std::vector<statement>& notes, const stiffness& found);
/// Adds a note if instances that have ended were given new inputs, which `invalid_instances::mark` allows.
template <class R>
void note_ended(report_of<R>& r, const ensemble_data<R>& e, std::int64_t count);
/// Adds notes on instances that ended because of a limit, with what to do: `max_steps`, `time_limit`, or the resolution
/// of time.
template <class R>
void note_failures(report_of<R>& r, const ensemble_data<R>& e, const options& o, std::int64_t max_steps,
                   std::int64_t count);
/// What every call ends with: notes on instances that ended because of a limit, device and time; throws what a progress
/// function has thrown.
template <class R>
void end_call(report_of<R>& r, const ensemble_data<R>& e, const options& o, std::int64_t max_steps, std::string device,
              std::chrono::steady_clock::time_point begin, const std::exception_ptr& failure);
/// Adds a note if a relative tolerance was below what the precision can reach.
template <class R>
void note_raised_tolerances(report_of<R>& r, const options& o);

}  // namespace host::inline MYRIAD_ABI
}  // namespace myriad
