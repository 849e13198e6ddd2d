// SPDX-License-Identifier: MIT
// The one-shot call: checks everything once, hands the ensemble to the device's backend, reports.
#pragma once

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>

#include "myriad/backend.hpp"
#include "myriad/cpu_kernel.hpp"
#include "myriad/device.hpp"
#include "myriad/ensemble/ensemble.hpp"
#include "myriad/ensemble/notes.hpp"
#include "myriad/ensemble/report.hpp"
#include "myriad/integrator/arguments.hpp"
#include "myriad/integrator/options.hpp"

namespace myriad {
namespace host {

/// Forwards progress from a backend, which must not see exceptions, to the user's function, which may throw.
struct progress_relay {
    const std::function<void(std::int64_t, std::int64_t)>& function;
    std::int64_t total;
    std::exception_ptr failure;

    /// False once it has thrown: no further instance is to be begun.
    static bool call(void* context, std::int64_t begun) {
        auto& relay = *static_cast<progress_relay*>(context);
        if (relay.failure || !relay.function) return !relay.failure;
        try {
            relay.function(begun, relay.total);
        } catch (...) {
            relay.failure = std::current_exception();
        }
        return !relay.failure;
    }
};

/// Throws `error` if the program has no kernel of the model and method for that device.
template <class Model, class Method, class R>
void require_kernel(const device& where) {
    const bool on_cpu = where.which() == device::kind::cpu;
    require(
        on_cpu ? choose_cpu_kernel<Model, Method, R>().run != nullptr
               : if_defined(&cuda::make_engine<Model, Method, R>) != nullptr,
        "this model was not instantiated for this method and real type", on_cpu ? "" : " on CUDA devices",
        ", or its source file was not linked: write MYRIAD_INSTANTIATE(model, method) (MYRIAD_INSTANTIATE_FLOAT for "
        "float) in the model's source file, and name that file in myriad_add_models for the program or an OBJECT "
        "library",
        on_cpu ? "" : ", with MYRIAD_ENABLE_CUDA on");
}

template <class Model, class Method, class R>
void solve_on_cpu(const device& where, const options& o, const kernel_arguments<Model, R>& arguments, progress_relay& relay,
                  report<Model, R>& result) {
    run_options how;
    how.threads = where.threads();
    how.schedule = o.schedule;
    how.progress = &progress_relay::call;
    how.context = &relay;
    const run_statistics used = openmp::run<Model, Method, R>(arguments, how);
    result.lane_turns = used.lane_turns;
    result.lanes = used.lanes;
    result.threads = used.threads;
    result.instruction_set = used.instruction_set;
}

/// Chunk by chunk on two engines in turns, so that one's transfers overlap the other's work.
template <class Model, class Method, class R>
void solve_on_cuda(const device& where, const options& o, kernel_arguments<Model, R>& arguments, progress_relay& relay,
                   report<Model, R>& result) {
    std::int64_t bytes = 0;
    const auto add = [&](auto* array, std::int64_t components, array_access, array_kind) {
        bytes += components * static_cast<std::int64_t>(sizeof(*array));
    };
    for_each_array(arguments, add);
    for_each_record(arguments.record, add);

    std::unique_ptr<cuda::engine<Model, R>> engines[2];
    const cuda::engine_options how{where.number(), o.block_size, o.shared_placement, o.schedule};
    engines[0] = cuda::make_engine<Model, Method, R>(how);
    const std::int64_t size = arguments.size;
    std::int64_t chunk = o.chunk_size;
    if (chunk == 0) {
        const std::int64_t affordable = engines[0]->affordable(bytes);
        chunk = size <= affordable ? size : std::max(affordable / 2, std::int64_t{1});
    }
    chunk = std::min(chunk, size);
    if (chunk < size) engines[1] = cuda::make_engine<Model, Method, R>(how);

    const auto finish = [&](cuda::engine<Model, R>& engine, std::int64_t done) {
        engine.download(arguments);
        engine.wait();
        result.kernel_seconds += engine.kernel_seconds();
        progress_relay::call(&relay, done);
    };
    cuda::engine<Model, R>* running = nullptr;
    std::int64_t first = 0;
    for (int turn = 0; first < size && !relay.failure; turn = 1 - turn) {
        auto& engine = *engines[turn];
        const std::int64_t count = std::min(chunk, size - first);
        engine.upload(arguments, first, count);
        engine.integrate(arguments);
        if (running != nullptr) finish(*running, first);
        running = &engine;
        first += count;
    }
    finish(*running, first);
    result.kernel = engines[0]->facts();
}

}  // namespace host

/// Takes every instance of the ensemble through `options.phases` integration phases with the given method, in place, and
/// reports. A further call goes on from there with the next phases; instances that failed or ended themselves stay as
/// they are until `ensemble::restart`. The result of an instance depends on nothing but its own data and the options.
/// Throws `error` before any work if an input is invalid, if the device is not there, or if the program has no kernel for
/// the model and method.
template <class Method, class Model, class R>
report<Model, R> solve(const device& where, ensemble<Model, R>& instances, const options& options = {}) {
    check_options<Model, Method, R>(options);
    host::require_kernel<Model, Method, R>(where);
    host::check_inputs<Method>(instances, options, instances.size());

    report<Model, R> result;
    host::prepared_arguments<Model, Method, R> prepared(instances, options);
    const auto work_before = host::counted_work(instances);
    host::progress_relay relay{options.progress, instances.size(), nullptr};
    const auto begin = std::chrono::steady_clock::now();
    if (where.which() == device::kind::cpu) {
        host::solve_on_cpu<Model, Method, R>(where, options, prepared.get(), relay, result);
    } else {
        host::solve_on_cuda<Model, Method, R>(where, options, prepared.get(), relay, result);
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (relay.failure) std::rethrow_exception(relay.failure);

    result.device = where.name();
    result.records = std::move(prepared.records());
    if (options.counting == counting::on) host::set_work(result, work_before, host::counted_work(instances));
    host::summarise(instances, result, instances.size());
    host::note_tolerances(result, options);
    host::note_stiffness<Method>(result, instances, options);
    return result;
}

}  // namespace myriad
