// SPDX-License-Identifier: MIT
// Calls whose results stay on a GPU.
#include "resident.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "myriad/host/core/error.hpp"

namespace myriad::python {

using detail::array_access;

namespace {

/// Launches a kernel whose threads take several of so many values each.
gpu::result launch_over(const void* kernel, std::int64_t size, void** arguments, gpu::stream_handle stream) {
    constexpr std::int64_t threads = 256, per_block = 8 * threads, most_blocks = 512;
    const std::int64_t blocks = std::min((size + per_block - 1) / per_block, most_blocks);
    return gpu::launch(kernel, {static_cast<unsigned>(blocks)}, threads, arguments, 0, stream);
}

}  // namespace

template <class R>
resident<R>::resident(const library& kernel, const host::called_model<R>& model, const host::solve_call<R>& call,
                      ensemble<R>& instances, const options& o)
    : program_(*kernel.gpu()), source_(model.on_gpus.front()), call_(call.prepared()), instances_(instances),
      marks_invalid_(o.invalid_instances == invalid_instances::mark) {}

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
bool resident<R>::fit(const cuda::engine<R>& worker) {
    constexpr std::int64_t many = 16;
    const auto room = worker.affordable(detail::bytes_per_instance(call_->arguments));
    const bool has_inputs = !instances_.on_device.empty();
    if (instances_.data.size <= (has_inputs ? room : room / many)) return true;
    require(!has_inputs,
            "the sweep has arrays on the GPU, whose memory does not suffice to "
            "integrate all of it at once",
            host::cure, "divide it into smaller parts");
    instances_.samples.clear();
    return false;
}

template <class R>
void resident<R>::take_inputs(study_engine& worker) {
    if (instances_.on_device.empty()) return;
    require(!marks_invalid_, "arrays on a GPU cannot be marked where they are not finite", host::cure,
            "copy them to the host, or give invalid=\"refuse\"");
    constexpr unsigned long long none = std::numeric_limits<unsigned long long>::max();
    const device_program::kernels& all = program_.on(number());
    const std::int64_t size = instances_.data.size;
    const auto stream = worker.in_stream();
    const cuda::current_device here(number());
    scratch_.reserve(sizeof(host::work_count));  // for `work` too, as to get memory anew takes longer than to copy
    for (const device_input<R>& input : instances_.on_device) {
        std::byte* const to = worker.find(call_->arguments, input.component).address;
        MYRIAD_GPU_CALL(
            gpu::copy(to, input.values, static_cast<std::size_t>(size) * sizeof(R), gpu::direction::on_device, stream));
        MYRIAD_GPU_CALL(gpu::fill(scratch_.data(), 0xff, sizeof none, stream));
        void *values = to, *first = scratch_.data();
        std::int64_t count = size;
        void* arguments[] = {&values, &count, &first};
        cuda::check(launch_over(all.find_not_finite, size, arguments, stream), "the check of the inputs");
        unsigned long long found = none;
        worker.copy_to_host(&found, static_cast<const std::byte*>(scratch_.data()), sizeof found);
        if (found == none) continue;
        R value{};
        worker.copy_to_host(&value, to + found * sizeof(R), sizeof value);
        const auto& d = instances_.data;
        const std::int64_t in_states = input.component - d.state.data(), n_states = size * d.shape->n_state;
        const bool is_state = in_states >= 0 && in_states < n_states;
        const auto number = static_cast<int>((is_state ? in_states : input.component - d.parameter.data()) / size);
        throw error(message(is_state ? d.shape->state(*d.shape, number) : d.shape->parameter(*d.shape, number), " is ",
                            value, " in instance ", found, ", and must be finite"));
    }
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
void resident<R>::upload(cuda::engine<R>& worker, cuda::past of_instances) {
    auto& here = static_cast<study_engine&>(worker);
    for (const device_input<R>& input : instances_.on_device) given_there_.insert(input.component);
    here.upload(call_->arguments, 0, instances_.data.size, of_instances,
                [&](const void* component) { return given_there_.count(component) > 0; });
    take_inputs(here);
}

template <class R>
void resident<R>::keep(std::unique_ptr<cuda::engine<R>> worker, report_of<R>& result) {
    engine_.reset(static_cast<study_engine*>(worker.release()));
    auto& data = instances_.data;
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
