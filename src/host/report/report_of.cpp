// SPDX-License-Identifier: MIT
// Reports and records, for both real types.
#include "myriad/host/report/report_of.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <locale>
#include <mutex>
#include <numeric>
#include <ostream>
#include <sstream>
#include <type_traits>

#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/options/option_checks.hpp"
#include "myriad/host/threads/parallel.hpp"

namespace myriad {

namespace {

template <class R>
std::ostream& print(std::ostream& stream, const report_of<R>& r) {
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
            << " threads per block, ";
        if (r.kernel.threads_per_instance > 1) out << r.kernel.threads_per_instance << " of them per instance, ";
        out << "shared parameters in " << name_of(r.kernel.shared_placement) << '\n';
    } else {
        out << r.threads << (r.threads == 1 ? " thread of " : " threads of ") << r.lanes
            << (r.lanes == 1 ? " lane, " : " lanes, ") << r.instruction_set << '\n';
    }
    if (r.accepted_steps + r.rejected_steps > 0) {
        out << r.accepted_steps << " steps accepted, " << r.rejected_steps << " rejected, " << r.located_steps
            << " redone to locate events; " << r.rhs_evaluations << " evaluations of the right-hand side\n";
    }
    if (r.matrix.states > 0) {
        out << "of " << r.matrix.states * r.matrix.states << " entries of the Jacobian " << r.matrix.jacobian_entries
            << " may differ from zero";
        if (r.matrix.jacobian_evaluations > 0)
            out << ", found by " << r.matrix.jacobian_evaluations << " evaluations of rhs with dual numbers";
        out << "; its factors have " << r.matrix.factor_entries << '\n';
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
    for (const statement& note : r.notes) out << "note: " << note << '\n';
    return stream << out.str();
}

}  // namespace

std::ostream& operator<<(std::ostream& stream, const report_of<double>& r) { return print(stream, r); }
std::ostream& operator<<(std::ostream& stream, const report_of<float>& r) { return print(stream, r); }

namespace host::inline MYRIAD_ABI {

template <class R>
record_data<R>::record_data(const model_shape& shape, const record_options& o, std::int64_t of_phases,
                            std::int64_t of_instances)
    : size(of_instances) {
    if (o.empty()) return;
    recorded = true;
    phases = of_phases - o.from_phase;
    from_phase = o.from_phase;
    std::int16_t columns = 0, integer_columns = 0;
    const auto number = [&](std::vector<std::int16_t>& of, int count, const component_list& chosen, auto type) {
        of.assign(static_cast<std::size_t>(count), -1);
        for (const int c : chosen)
            of[static_cast<std::size_t>(c)] = std::is_same_v<decltype(type), R> ? columns++ : integer_columns++;
    };
#define MYRIAD_NUMBER_COLUMNS(kind, plural, words, type) number(kind, shape.n_##kind, o.plural, type());
    MYRIAD_RECORDED_KINDS(MYRIAD_NUMBER_COLUMNS)
#undef MYRIAD_NUMBER_COLUMNS
    if (o.time) time = columns++;
    values = component_array<R>(columns, size * phases, std::numeric_limits<R>::quiet_NaN());
    integers = component_array<std::int32_t>(integer_columns, size * phases, 0);
}
template <class R>
double record_data<R>::bytes_for(const record_options& o, std::int64_t phases, std::int64_t size) {
    std::size_t bytes = o.time ? sizeof(R) : 0;
#define MYRIAD_ADD_BYTES(kind, plural, words, type) bytes += sizeof(type) * o.plural.size();
    MYRIAD_RECORDED_KINDS(MYRIAD_ADD_BYTES)
#undef MYRIAD_ADD_BYTES
    return static_cast<double>(size) * static_cast<double>(phases - o.from_phase) * static_cast<double>(bytes);
}
template <class R>
int record_data<R>::find(const std::vector<std::int16_t>& columns, std::int64_t c, const char* what) const {
    require(size > 0 || !recorded, "these records were moved away", cure, "ask those that they were moved to");
    require(c >= 0 && c < static_cast<std::int64_t>(columns.size()) && columns[static_cast<std::size_t>(c)] >= 0, what,
            " ", c, " was not recorded", cure, cures::name_in_record);
    return columns[static_cast<std::size_t>(c)];
}
template <class R>
void record_data<R>::clear() {
    values.fill(std::numeric_limits<R>::quiet_NaN());
    integers.fill(0);
}
template <class R>
void record_data<R>::pin(int device) {
    values.pin(device);
    integers.pin(device);
}
template struct record_data<double>;
template struct record_data<float>;

template <class R>
work_count counted_work(const ensemble_data<R>& e, std::int64_t count, std::int64_t first) {
    work_count work{};
    if (!e.counts() || e.untouched) return work;
    const auto counters = e.counters();
    std::array<std::atomic<std::int64_t>, 4> sums{};
    in_parallel(count, 16'384, [&](std::int64_t begin, std::int64_t end) {
        for (std::size_t c = 0; c < sums.size(); ++c)
            if (counters[c] != nullptr)
                sums[c] += std::accumulate(counters[c] + first + begin, counters[c] + first + end, std::int64_t{0});
    });
    for (std::size_t c = 0; c < sums.size(); ++c) work[c] = sums[c];
    return work;
}

namespace {

/// Counts of each value among `count` statuses, and the index of the first failure, or `count`.
class status_tally {
public:
    status_tally(const status* statuses, std::int64_t count) : first_failed_(count) {
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

}  // namespace

template <class R>
void add_summary(const ensemble_data<R>& e, report_of<R>& r, std::int64_t first, std::int64_t count) {
    const status_tally found(e.status.data() + first, count);
    r.instances += count;
    for (std::size_t s = 0; s < r.by_status.size(); ++s) r.by_status[s] += found.by_status()[s];
    if (r.first_failed >= 0 || found.first_failed() == count) return;
    const std::int64_t i = first + found.first_failed();
    r.first_failed = i;
    r.first_status = e.status.data()[i];
    r.first_t = e.t.data()[i];
    const ended_instance<R>* const before = e.ended_before.find(i);
    r.first_t_begin = before != nullptr ? before->t_begin : e.t_begin_of(i);
    r.first_t_end = before != nullptr ? before->t_end : e.t_end_of(i);
    r.first_state.clear();
    r.first_parameter.clear();
    if (before != nullptr && e.given_anew(*before)) return;
    for (int c = 0; c < e.shape->n_state; ++c) r.first_state.push_back(e.state.component(c)[i]);
    for (int c = 0; c < e.shape->n_parameter; ++c) r.first_parameter.push_back(e.parameter.component(c)[i]);
}

template <class R>
void summarise(const ensemble_data<R>& e, report_of<R>& r, std::int64_t count) {
    r.instances = 0;
    r.by_status = {};
    r.first_failed = -1;
    add_summary(e, r, 0, count);
}

template <class R>
void note_ended(report_of<R>& r, const ensemble_data<R>& e, std::int64_t count) {
    const std::int64_t anew = count_given_anew(e, count);
    if (anew == 0) return;
    r.notes.push_back(
        statement_of(anew, anew == 1 ? " instance that" : " instances that",
                     " ended in earlier calls took no part, though states or parameters were set anew since: "
                     "restart() starts all instances again"));
}

// Without numbers of instances, which the report has, so that parts of a study say the same.
template <class R>
void note_failures(report_of<R>& r, const ensemble_data<R>& e, const options& o, std::int64_t max_steps,
                   std::int64_t count) {
    const auto any = [&](status s) { return r.by_status[static_cast<std::size_t>(s)] > 0; };
    if (any(status::max_steps)) {
        const bool can_rise = max_steps < most_steps(std::numeric_limits<R>::digits);
        r.notes.push_back(statement_of(
            named_option("max_steps"), ": ", max_steps, " trial steps did not take an instance to the end of its phase",
            cure, can_rise ? "raise " : "no more are counted, so take longer steps than with this ",
            named_option("max_steps"), ", or look at why the steps are so short"));
    }
    if (any(status::interrupted) && o.time_limit > 0)
        r.notes.push_back(
            statement_of("interrupted: ", named_option("time_limit"), " = ", o.time_limit, " s was over"));
    if (!any(status::step_underflow)) return;
    // Steps end at the resolution of time, unless a longer smallest step was given.
    double coarsest = 0;
    for (std::int64_t i = 0; i < count; ++i) {
        if (e.status.data()[i] != status::step_underflow) continue;
        const R t = std::abs(e.t.data()[i]), spacing = std::nextafter(t, std::numeric_limits<R>::infinity()) - t;
        if (o.minimum_step <= static_cast<double>(spacing)) coarsest = std::max(coarsest, static_cast<double>(spacing));
    }
    constexpr bool single = std::is_same_v<R, float>;
    if (coarsest > 0)
        r.notes.push_back(statement_of(
            "step_underflow: time, which ", single ? "single" : "double", " precision resolves to ", coarsest,
            " there, is too coarse for the steps needed: ", single ? "use double precision, or let" : "let",
            " time begin near 0, or scale it; if that does not help, the right-hand side jumps or "
            "runs away there, or the tolerance is below its rounding"));
}

template <class R>
void end_call(report_of<R>& r, const ensemble_data<R>& e, const options& o, std::int64_t max_steps, std::string device,
              std::chrono::steady_clock::time_point begin, const std::exception_ptr& failure) {
    note_failures(r, e, o, max_steps, e.size);
    r.device = std::move(device);
    r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (failure) std::rethrow_exception(failure);
}

template <class R>
void note_raised_tolerances(report_of<R>& r, const options& o) {
    for (std::size_t c = 0; c < o.relative_tolerance.size(); ++c) {
        if (static_cast<R>(o.relative_tolerance[c]) >= least_relative_tolerance<R>) continue;
        r.notes.push_back(statement_of(named_option("relative_tolerance"), " ", o.relative_tolerance[c],
                                       " is below what the precision can reach: ", least_relative_tolerance<R>,
                                       " was used"));
        return;
    }
}

void add_note(std::vector<statement>& notes, const stiffness& found) {
    if (2 * found.limited < found.looked_at || found.limited == 0) return;
    notes.push_back(statement_of("stability, not accuracy, limits the step in ", found.limited, " of ", found.looked_at,
                                 " instances looked at (step times fastest rate is up to ", found.share,
                                 " of the method's limit, and of rodas_5p, a method for stiff equations, one ",
                                 worthwhile_stretch,
                                 " times as long meets the tolerances): if the equations are stiff all "
                                 "along, rodas_5p takes far fewer steps"));
}

template work_count counted_work(const ensemble_data<double>&, std::int64_t, std::int64_t);
template void add_summary(const ensemble_data<double>&, report_of<double>&, std::int64_t, std::int64_t);
template void summarise(const ensemble_data<double>&, report_of<double>&, std::int64_t);
template void note_ended(report_of<double>&, const ensemble_data<double>&, std::int64_t);
template void note_failures(report_of<double>&, const ensemble_data<double>&, const options&, std::int64_t,
                            std::int64_t);
template void end_call(report_of<double>&, const ensemble_data<double>&, const options&, std::int64_t, std::string,
                       std::chrono::steady_clock::time_point, const std::exception_ptr&);
template void note_raised_tolerances(report_of<double>&, const options&);
template work_count counted_work(const ensemble_data<float>&, std::int64_t, std::int64_t);
template void add_summary(const ensemble_data<float>&, report_of<float>&, std::int64_t, std::int64_t);
template void summarise(const ensemble_data<float>&, report_of<float>&, std::int64_t);
template void note_ended(report_of<float>&, const ensemble_data<float>&, std::int64_t);
template void note_failures(report_of<float>&, const ensemble_data<float>&, const options&, std::int64_t, std::int64_t);
template void end_call(report_of<float>&, const ensemble_data<float>&, const options&, std::int64_t, std::string,
                       std::chrono::steady_clock::time_point, const std::exception_ptr&);
template void note_raised_tolerances(report_of<float>&, const options&);

}  // namespace host::inline MYRIAD_ABI
}  // namespace myriad
