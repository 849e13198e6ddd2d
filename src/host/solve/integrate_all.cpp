// SPDX-License-Identifier: MIT
// What every call of `solve` does, for both real types.
#include "myriad/host/solve/integrate_all.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <vector>

#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/chunks/progress_relay.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

void check_kernel(const device& where, bool exists) {
    const bool on_cpu = where.which() == device::kind::cpu;
    require(exists, "this model was not instantiated for this method and real type", on_cpu ? "" : " on CUDA devices",
            ", or with other numbers of components, or its source file was not linked: write MYRIAD_INSTANTIATE(model, "
            "method) (MYRIAD_INSTANTIATE_FLOAT for float) in the model's source file, and name that file in "
            "myriad_add_models for the program or an OBJECT library",
            on_cpu ? "" : ", with MYRIAD_ENABLE_CUDA on");
    require(on_cpu || may_use_gpus(),
            "this process was forked from one that has used a GPU, which a fork cannot: fork before that, use the CPU, "
            "or start a new program (exec)");
}

namespace {

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
void integrate_all(const device& where, const options& o, const any_run* on_cpu, chunk_source* on_gpu,
                   ensemble_data<R>& instances, data_check<R>& check, report_of<R>& result) {
    progress_relay relay{o.progress, instances.size, nullptr};
    relay.deadline = progress_relay::deadline_in(o.time_limit);
    const phases_done_before<R> before(o, instances, where.which() != device::kind::cpu);
    const auto begin = std::chrono::steady_clock::now();
    if (where.which() == device::kind::cpu) {
        const auto work = [&] {
            return o.counting == counting::on ? counted_work(instances, instances.size) : work_count{};
        };
        const auto work_before = work();
        instances.untouched = false;
        run_options how;
        how.threads = where.threads();
        how.schedule = o.schedule;
        how.progress = &progress_relay::call;
        if (relay.may_stop()) how.stop = &progress_relay::ask;
        how.context = &relay;
        const run_statistics used = run_kernel(*on_cpu, how);
        if (relay.failure) before.leave_those_begun(instances);
        result.lane_turns = used.lane_turns;
        result.lanes = used.lanes;
        result.threads = used.threads;
        result.instruction_set = used.instruction_set;
        set_work(result, work_before, work());
        summarise(instances, result, instances.size);
    } else {
        solve_in_chunks(o, *on_gpu, instances, check, relay, result);
        if (relay.failure) before.leave_those_begun(instances);
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    note_ended(result, instances, instances.size);
    note_failures(result, instances, o, instances.size);
    instances.remember_ended();
    if (relay.failure) std::rethrow_exception(relay.failure);
    result.device = where.name();
}
template void integrate_all(const device&, const options&, const any_run*, chunk_source*, ensemble_data<double>&,
                            data_check<double>&, report_of<double>&);
template void integrate_all(const device&, const options&, const any_run*, chunk_source*, ensemble_data<float>&,
                            data_check<float>&, report_of<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
