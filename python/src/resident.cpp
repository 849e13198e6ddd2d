// SPDX-License-Identifier: MIT
// Calls whose results stay on a GPU.
#include "resident.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/host/threads/polling_backoff.hpp"

namespace myriad::python {

using detail::array_access;
using detail::array_kind;

namespace {

/// Launches a kernel whose threads take several of so many values each.
gpu::result launch_over(const void* kernel, std::int64_t size, void** arguments, gpu::stream_handle stream) {
    constexpr std::int64_t threads = 256, per_block = 8 * threads, most_blocks = 512;
    const std::int64_t blocks = std::min((size + per_block - 1) / per_block, most_blocks);
    return gpu::launch(kernel, {static_cast<unsigned>(blocks)}, threads, arguments, 0, stream);
}

}  // namespace

template <class R>
resident<R>::resident(const library& kernel, const host::called_model<R>& model, const host::solve_call<R>& call)
    : program_(*kernel.gpu()), source_(model.on_gpus.front()), call_(call.prepared()) {}

template <class R>
resident<R>::~resident() {
    if (engine_ == nullptr) return;
    try {
        const cuda::current_device here(number());
        scratch_.release();
        engine_->wait();
        source_.give(std::move(engine_));
    } catch (const error&) {  // the next call finds it too, and says so
    }
}

template <class R>
std::size_t resident<R>::bytes_per_instance() const {
    detail::any_arguments<R> all = call_->arguments;
    std::size_t bytes = 0;
    const auto add = [&](auto* array, std::int64_t components, array_access, array_kind) {
        bytes += static_cast<std::size_t>(components) * sizeof(*array);
    };
    for_each_array(all, add);
    for_each_record(all, add);
    return bytes;
}

template <class R>
bool resident<R>::fits(const ensemble<R>& instances) {
    constexpr std::int64_t many = 16;
    engine_.reset(static_cast<cuda::study_engine<R>*>(source_.take().release()));
    const auto room = engine_->affordable(static_cast<std::int64_t>(bytes_per_instance()));
    if (instances.data.size <= (instances.on_device.empty() ? room / many : room)) return true;
    source_.give(std::move(engine_));
    return false;
}

template <class R>
void resident<R>::take_inputs(const ensemble<R>& instances, bool mark_invalid) {
    if (instances.on_device.empty()) return;
    require(!mark_invalid, "arrays on a GPU cannot be marked where they are not finite", host::cure,
            "copy them to the host, or give invalid=\"refuse\"");
    constexpr unsigned long long none = std::numeric_limits<unsigned long long>::max();
    const device_program::kernels& all = program_.on(number());
    const std::int64_t size = instances.data.size;
    const auto stream = engine_->in_stream();
    const cuda::current_device here(number());
    scratch_.reserve(sizeof(host::work_count));  // for `work` too, as to get memory anew takes longer than to copy
    for (const device_input<R>& input : instances.on_device) {
        std::byte* const to = engine_->find(call_->arguments, input.component).address;
        MYRIAD_GPU_CALL(
            gpu::copy(to, input.values, static_cast<std::size_t>(size) * sizeof(R), gpu::direction::on_device, stream));
        MYRIAD_GPU_CALL(gpu::fill(scratch_.data(), 0xff, sizeof none, stream));
        void *values = to, *first = scratch_.data();
        std::int64_t count = size;
        void* arguments[] = {&values, &count, &first};
        cuda::check(launch_over(all.find_not_finite, size, arguments, stream), "the check of the inputs");
        unsigned long long found = none;
        engine_->copy_to_host(&found, static_cast<const std::byte*>(scratch_.data()), sizeof found);
        if (found == none) continue;
        R value{};
        engine_->copy_to_host(&value, to + found * sizeof(R), sizeof value);
        const auto& d = instances.data;
        const std::int64_t in_states = input.component - d.state.data(), n_states = size * d.shape->n_state;
        const bool is_state = in_states >= 0 && in_states < n_states;
        const auto number = static_cast<int>((is_state ? in_states : input.component - d.parameter.data()) / size);
        throw error(message(is_state ? d.shape->state(*d.shape, number) : d.shape->parameter(*d.shape, number), " is ",
                            value, " in instance ", found, ", and must be finite"));
    }
}

template <class R>
void resident<R>::wait(const options& o, std::int64_t size, clock::time_point deadline) {
    host::progress_relay relay{o.progress, size, nullptr};
    relay.deadline = deadline;
    auto told = detail::stop_request::none;
    for (host::polling_backoff waiting; !engine_->idle(); waiting.pause()) {
        const auto asked = host::progress_relay::ask(&relay);
        if (ends_kernels(asked) && asked != std::exchange(told, asked)) engine_->stop(asked);
    }
    host::progress_relay::call(&relay, size);
    if (relay.failure) std::rethrow_exception(relay.failure);
}

template <class R>
host::work_count resident<R>::work() {
    const auto& a = call_->arguments;
    const std::array<const std::int64_t*, 4> counters{a.accepted, a.rejected, a.located, a.evaluations};
    host::work_count sums{};
    const auto stream = engine_->in_stream();
    const cuda::current_device here(number());
    scratch_.reserve(sizeof sums);
    MYRIAD_GPU_CALL(gpu::fill(scratch_.data(), 0, sizeof sums, stream));
    std::int64_t size = a.size;
    for (std::size_t c = 0; c < sums.size(); ++c) {
        if (counters[c] == nullptr) continue;
        void *values = engine_->find(a, counters[c]).address, *sum = static_cast<std::int64_t*>(scratch_.data()) + c;
        void* arguments[] = {&values, &size, &sum};
        cuda::check(launch_over(program_.on(number()).sum, size, arguments, stream), "the sum of all steps");
    }
    engine_->copy_to_host(&sums, static_cast<const std::byte*>(scratch_.data()), sizeof sums);
    return sums;
}

template <class R>
void resident<R>::integrate(ensemble<R>& instances, const options& o, host::data_check<R>& check,
                            report_of<R>& result) {
    const auto begin = clock::now();
    const auto deadline = host::progress_relay::deadline_in(o.time_limit);
    auto& data = instances.data;
    for (const device_input<R>& input : instances.on_device) given_there_.insert(input.component);
    if (!check.passes(0, data.size)) check.run();
    const auto past = data.untouched ? cuda::past::none : cuda::past::kept;  // kept where some are marked
    engine_->upload(call_->arguments, 0, data.size, past,
                    [&](const void* component) { return given_there_.count(component) > 0; });
    take_inputs(instances, o.invalid_instances == invalid_instances::mark);
    engine_->integrate(call_->arguments);
    std::exception_ptr failure;
    try {
        wait(o, data.size, deadline);
    } catch (...) {
        failure = std::current_exception();
    }
    bring(data.status.data(), static_cast<std::size_t>(data.size));
    host::summarise(data, result, data.size);
    if (result.first_failed >= 0) {  // whose values the report has
        const auto one = [&](auto& array) {
            for (int c = 0; c < array.components(); ++c) {
                auto* const value = array.component(c) + result.first_failed;
                const auto there = engine_->find(call_->arguments, value);
                if (there.address != nullptr) engine_->copy_to_host(value, there.address, sizeof *value);
            }
        };
        bring(data.t.data(), static_cast<std::size_t>(data.size) * sizeof data.t.data()[0]);  // for notes on all
        one(data.state);
        one(data.parameter);
        one(data.t_begin);
        one(data.t_end);
        host::summarise(data, result, data.size);
    }
    host::set_work(result, {}, work());
    result.kernel = engine_->facts();
    result.kernel_seconds = engine_->kernel_seconds();
    host::end_call(result, data, o, call_->arguments.max_steps, device::cuda(number()).name(), begin, failure);
}

template <class R>
bool resident<R>::left_bookkeeping(const host::ensemble_data<R>& data) const {
    const auto is_untouched = [this](const void* values) { return brought_.count(values) == 0; };
    return data.untouched && is_untouched(data.t.data()) && is_untouched(data.phase.data()) &&
           is_untouched(data.accepted.data()) && is_untouched(data.rejected.data()) &&
           is_untouched(data.located.data()) && is_untouched(data.evaluations.data());
}

template <class R>
void resident<R>::bring(const void* values, std::size_t bytes) {
    if (engine_ == nullptr || bytes == 0 || brought_.count(values) > 0) return;
    const auto there = engine_->find(call_->arguments, values);
    const bool differs = there.access != array_access::read || given_there_.count(values) > 0;
    if (there.address == nullptr || !differs) return;
    engine_->copy_to_host(const_cast<void*>(values), there.address, bytes);
    brought_.insert(values);
}

template class resident<double>;
template class resident<float>;

}  // namespace myriad::python
