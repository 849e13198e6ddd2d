// SPDX-License-Identifier: MIT
// What every call of `solve` does, for both real types.
#include "myriad/host/solve/integrate_all.hpp"

#include <chrono>
#include <exception>

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

template <class R>
void integrate_all(const device& where, const options& o, const any_run* on_cpu, chunk_source* on_gpu,
                   ensemble_data<R>& instances, data_check<R>& check, report_of<R>& result) {
    progress_relay relay{o.progress, instances.size, nullptr};
    relay.deadline = progress_relay::deadline_in(o.time_limit);
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
        result.lane_turns = used.lane_turns;
        result.lanes = used.lanes;
        result.threads = used.threads;
        result.instruction_set = used.instruction_set;
        set_work(result, work_before, work());
        summarise(instances, result, instances.size);
    } else {
        solve_in_chunks(o, *on_gpu, instances, check, relay, result);
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
