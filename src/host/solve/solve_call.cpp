// SPDX-License-Identifier: MIT
// What every call of `solve` does, for both real types.
#include "myriad/host/solve/solve_call.hpp"

#include <chrono>
#include <cstddef>
#include <exception>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "myriad/host/checks/consistency.hpp"
#include "myriad/host/checks/event_tolerances.hpp"
#include "myriad/host/checks/path_check.hpp"
#include "myriad/host/chunks/chunk_driver.hpp"
#include "myriad/host/chunks/progress_relay.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/report/stiffness.hpp"
#include "myriad/host/report/tangent_note.hpp"
#include "myriad/host/threads/parallel.hpp"

namespace myriad::host::inline MYRIAD_ABI {

template <class R>
void called_model<R>::check_options(const options& o) const {
    option_limits{*components,
                  shape->n_event,
                  shape->writes_time_domain,
                  facts.adaptive(),
                  facts.samples_trajectory,
                  shape->has_diffusion,
                  std::numeric_limits<R>::digits,
                  [](double value) { return static_cast<double>(static_cast<R>(value)); }}
        .check(o);
}

template <class R>
void called_model<R>::check_kernel(device::kind which) const {
    const bool on_cpu = which == device::kind::cpu;
    require(on_cpu ? this->on_cpu.run != nullptr : !on_gpus.empty(),
            "this model was not instantiated for this method and real type", on_cpu ? "" : " on CUDA devices",
            ", or with other numbers of components, or its source file was not linked", cure,
            "write MYRIAD_INSTANTIATE(model, method) (MYRIAD_INSTANTIATE_FLOAT for float) in the model's source "
            "file, and name that file in myriad_add_models for the program or an OBJECT library",
            on_cpu ? "" : ", with MYRIAD_ENABLE_CUDA on");
    if (!on_cpu) check_may_use_gpus();
}

template <class R>
double called_model<R>::bytes_per_instance(const options& o) const {
    memory_need need = ensemble_data<R>::memory_of(*shape, 1);
    add_memory_of_call<R>(need, *shape, 1, nullptr, false, o, facts);
    return need.bytes();
}

template <class R>
phases_left called_model<R>::check_uses(ensemble_data<R>& data, const options& o, std::int64_t count) const {
    check_ended(data, o, count);
    check_scales(data, facts.scales_tolerances);
    check_sample_times(data, o, count);
    check_paths(data, o, count, facts.adaptive());
    const argument_head<R> inputs = inputs_in(data);
    if (enter_thread) enter_thread();
    check_event_tolerances<R>(data, o, count, {functions, inputs});
    if (functions.check_jacobian != nullptr) functions.check_jacobian(inputs, count);
    check_consistency<R>(data, o, count, {functions, inputs});
    return find_phases_left(data, o, count, may_end_early(o));
}

template <class R>
void called_model<R>::add_notes(report_of<R>& result, ensemble_data<R>& data, const options& o,
                                const argument_head<R>& arguments) const {
    if (facts.adaptive()) note_raised_tolerances<R>(result, o);
    if (enter_thread) enter_thread();
    note_stiffness<R>(result, data, o, {functions, arguments});
    note_exponents<R>(result, data, o, facts);
}

template <class R>
void called_model<R>::generate(ensemble_data<R>& data, std::uint64_t seed) const {
    require(functions.generate != nullptr,
            "the model's struct has no generate to set instances: it must be `MYRIAD_FUNCTION static void "
            "generate(auto& instance)`, and public");
    const argument_head<R> inputs = inputs_in(data);
    std::mutex mutex;
    std::exception_ptr failure;
    in_parallel(data.size, 4096, [&](std::int64_t begin, std::int64_t end) {
        try {
            if (enter_thread) enter_thread();
            functions.generate(inputs, seed, begin, end);
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
        }
    });
    if (failure) std::rethrow_exception(failure);
}
template struct called_model<double>;
template struct called_model<float>;

namespace {

/// "cuda:0, cuda:1".
std::string names_of(const std::vector<device>& all) {
    std::string names;
    for (const device& d : all) names += (names.empty() ? "" : ", ") + d.name();
    return names;
}

/// Sorting by cost gives all instances one phase before it gives any the others. A progress function that throws may
/// stop the call between the two, where no kernel ends the instances that have begun.
template <class R>
class phases_done_before {
public:
    phases_done_before(const options& o, const ensemble_data<R>& instances, bool on_gpu) {
        const bool sorts = o.schedule == schedule::by_cost || (on_gpu && o.schedule == schedule::automatic);
        wanted_ = sorts && o.phases > 1 && o.progress;
        if (wanted_ && !instances.untouched)
            done_.assign(instances.phase.data(), instances.phase.data() + instances.size);
        phases_ = o.phases;
    }
    /// Ends the instances that have completed some of the call's phases, and not all, as `interrupted`.
    void leave_those_begun(ensemble_data<R>& instances) const {
        if (!wanted_) return;
        for (std::int64_t i = 0; i < instances.size; ++i) {
            const std::int64_t before = done_.empty() ? 0 : done_[static_cast<std::size_t>(i)];
            const std::int64_t done = instances.phase.data()[i] - before;
            if (done > 0 && done < phases_) instances.leave(i);
        }
    }

private:
    bool wanted_;
    std::int64_t phases_;
    std::vector<std::int32_t> done_;  // none where none had done any
};

}  // namespace

template <class R>
ensemble_data<R>& solve_call<R>::checked(const std::vector<device>& where, const options& o,
                                         const called_model<R>& model, ensemble_data<R>& data) {
    require(!where.empty(), "no device is given");
    for (const device& d : where)
        require(where.size() == 1 || d.which() == device::kind::cuda, "the devices are ", names_of(where),
                ", and several devices of a call must be GPUs");
    model.check_options(o);
    model.check_kernel(where.front().which());
    return data;
}

template <class R>
solve_call<R>::solve_call(const std::vector<device>& where, const options& o, const called_model<R>& model,
                          ensemble_data<R>& data, sample_data<R>& samples, record_data<R>& records, new_samples are)
    : where_(where), options_(o), model_(model), data_(data), claim_(data.take()),
      left_(model.check_uses(checked(where, o, model, data), o, data.size)),
      check_(model.values_of(data, o, data.size)) {
    left_.require_for(0, o.phases);
    // On a GPU the data of large ensembles are checked chunk by chunk, while the GPU works on others.
    if (is_on_cpu() || data.size <= worth_chunks) check_.run();
    data.expect_phases(o.phases);
    prepared_ = std::make_shared<prepared_call<R>>(data, samples, records, o, model.facts, are);
}

template <class R>
void solve_call<R>::integrate(report_of<R>& result, results_on_gpu<R>* stay) {
    const options& o = options_;
    ensemble_data<R>& instances = data_;
    progress_relay relay{o.progress, instances.size, nullptr};
    relay.deadline = progress_relay::deadline_in(o.time_limit);
    const phases_done_before<R> before(o, instances, !is_on_cpu());
    const auto begin = std::chrono::steady_clock::now();
    if (is_on_cpu()) {
        const auto work = [&] {
            return o.counting == counting::on ? counted_work(instances, instances.size) : work_count{};
        };
        const auto work_before = work();
        instances.untouched = false;
        run_options how;
        how.threads = where_.front().threads();
        how.schedule = o.schedule;
        how.progress = &progress_relay::call;
        if (relay.may_stop()) how.stop = &progress_relay::ask;
        how.context = &relay;
        const run_statistics used = run_kernel(model_.on_cpu, arguments(), how);
        if (relay.failure) before.leave_those_begun(instances);
        result.lane_turns = used.lane_turns;
        result.lanes = used.lanes;
        result.threads = used.threads;
        result.instruction_set = used.instruction_set;
        set_work(result, work_before, work());
        summarise(instances, result, instances.size);
    } else {
        solve_in_chunks(o, model_.on_gpus, arguments(), instances, check_, relay, result, stay);
        if (relay.failure) before.leave_those_begun(instances);
    }
    note_ended(result, instances, instances.size);
    instances.remember_ended();
    end_call(result, instances, o, arguments().max_steps, names_of(where_), begin, relay.failure);
}

template <class R>
void solve_call<R>::add_notes(report_of<R>& result, bool cut_short) const {
    if (!left_.note.empty()) result.notes.emplace_back(left_.note);
    if (!cut_short) model_.add_notes(result, data_, options_, prepared_->arguments);
}
template class solve_call<double>;
template class solve_call<float>;

}  // namespace myriad::host::inline MYRIAD_ABI
