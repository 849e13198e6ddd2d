// SPDX-License-Identifier: MIT
// The data of ensembles, for both real types.
#include "myriad/host/ensemble/ensemble_data.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/host/threads/parallel.hpp"

namespace myriad::host {

namespace {

std::uint64_t next_identity() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}
std::mutex& made_by_readers() {
    static std::mutex mutex;
    return mutex;
}

template <class R>
std::int64_t checked(const model_shape& shape, std::int64_t size) {
    require(size > 0, "the ensemble has ", size, " instances (must be positive): there is nothing to integrate");
    ensemble_data<R>::memory_of(shape, size)
        .check(message("an ensemble of ", size, " instances"), "integrate it in smaller parts, one after the other");
    return size;
}

}  // namespace

template <class R>
ensemble_data<R>::ensemble_data(const model_shape& of_model, std::int64_t n)
    : shape(&of_model), size(checked<R>(of_model, n)), identity(next_identity()), state(shape->n_state, n, unset),
      parameter(shape->n_parameter, n, unset), accessory(shape->n_accessory, n, unset),
      integer_accessory(shape->n_integer_accessory, n, 0), t(1, n, unset), shared(shape->n_shared, 1, unset),
      shared_integer(shape->n_shared_integer, 1, 0), phase(1, n, 0), side(shape->n_event, n, 0), ended(1, n, 0),
      status(1, n, myriad::status::not_started) {}
template <class R>
ensemble_data<R>::~ensemble_data() = default;

template <class R>
void ensemble_data<R>::require_present() const {
    require(size > 0, "this ensemble was moved away: use the one that it was moved to");
}
template <class R>
occupancy::claim ensemble_data<R>::take() {
    require_present();
    return occupied.take(
        "this ensemble is being integrated already, by another thread or by the call whose function "
        "calls this: wait for it, or use an ensemble of its own");
}

template <class R>
void ensemble_data<R>::set_domain(R t_begin, R t_end) {
    common_begin = t_begin;
    common_end = t_end;
    if (common_domain.components() > 0) {
        common_domain.fill_component(0, t_begin);
        common_domain.fill_component(1, t_end);
    }
    if (has_common_domain()) return;
    domain.fill_component(0, t_begin);
    domain.fill_component(1, t_end);
}
template <class R>
component_array<R> ensemble_data<R>::domains_of_all() const {
    component_array<R> made(2, size, common_begin);
    made.fill_component(1, common_end);
    return made;
}
template <class R>
component_array<R>& ensemble_data<R>::own_domains() {
    if (has_common_domain()) {
        component_array<R> made = domains_of_all();
        if (pinned()) made.pin(pinned_for);
        domain = std::move(made);
    }
    return domain;
}
template <class R>
const component_array<R>& ensemble_data<R>::read_domains() const {
    if (!has_common_domain()) return domain;
    const std::lock_guard lock(made_by_readers());
    if (common_domain.components() == 0) common_domain = domains_of_all();
    return common_domain;
}

/// An array of one component, allocated on first use.
template <class R>
template <class T>
component_array<T>& ensemble_data<R>::on_demand(component_array<T>& array, T value) const {
    const std::lock_guard lock(made_by_readers());
    if (array.components() == 0) {
        component_array<T> made(1, size, value);
        if (pinned()) made.pin(pinned_for);
        array = std::move(made);
    }
    return array;
}
template <class R>
component_array<R>& ensemble_data<R>::tolerance_scales() {
    return on_demand(tolerance_scale, R(1));
}
template <class R>
const component_array<R>& ensemble_data<R>::next_steps() const {
    return on_demand(h_next, R(0));
}
template <class R>
const component_array<std::int64_t>& ensemble_data<R>::counter(std::size_t c) const {
    require(counts(), "no work was counted: integrate with counting = counting::on");
    return counted[c].components() > 0 ? counted[c] : on_demand(zeros, std::int64_t{0});
}
template <class R>
std::array<std::int64_t*, 4> ensemble_data<R>::counters_for(step_sizes steps) {
    const auto values = [this](std::size_t c) { return on_demand(counted[c], std::int64_t{0}).data(); };
    return {values(0), steps == step_sizes::kept ? values(1) : nullptr, shape->n_event > 0 ? values(2) : nullptr,
            values(3)};
}

template <class R>
myriad::status ensemble_data<R>::status_of(std::int64_t i) const {
    require_present();
    require(i >= 0 && i < size, "instance ", i, " does not exist: the ensemble has ", std::int64_t{size}, " instances");
    return status.data()[i];
}

/// Calls `visit(array, value)` for the arrays of bookkeeping (host/backend/arrays.hpp), with their values before the
/// first phase; not for t, which a phase writes before anything reads it.
template <class R>
template <class Visit>
void ensemble_data<R>::for_each_bookkeeping(Visit&& visit) {
    visit(h_next, R(0));
    visit(phase, std::int32_t{0});
    visit(side, std::int8_t{0});
    visit(ended, std::uint8_t{0});
    visit(status, myriad::status::not_started);
    for (auto& one : counted) visit(one, std::int64_t{0});
}
template <class R>
void ensemble_data<R>::restart() {
    phases_asked = 0;
    if (untouched) return;
    untouched = true;
    // One parallel loop for all arrays, because of the overhead of starting and ending one.
    in_parallel(size, 32'768, [this](std::int64_t first, std::int64_t last) {
        for_each_bookkeeping([=](auto& array, auto value) { array.fill_instances(first, last, value); });
    });
    ended_before.clear();
}
template <class R>
void ensemble_data<R>::pin(int gpu) {
    for (auto* const array : {&state, &parameter, &accessory, &t, &domain, &tolerance_scale}) array->pin(gpu);
    integer_accessory.pin(gpu);
    for_each_bookkeeping([gpu](auto& array, auto) { array.pin(gpu); });
}

template <class R>
memory_need ensemble_data<R>::memory_of(const model_shape& shape, std::int64_t size) {
    const auto n = static_cast<double>(size);
    memory_need need;
    need.add("states", n * sizeof(R) * shape.n_state);
    need.add("parameters", n * sizeof(R) * shape.n_parameter);
    need.add("accessories", n * (static_cast<double>(sizeof(R)) * shape.n_accessory +
                                 static_cast<double>(sizeof(std::int32_t)) * shape.n_integer_accessory));
    need.add("times, phases and statuses", n * (sizeof(R) + sizeof(std::int32_t) + 2.0 + shape.n_event));
    return need;
}
template <class R>
void ensemble_data<R>::add_memory_of_call(memory_need& need, const model_shape& shape, std::int64_t size,
                                          const ensemble_data* there, const options& o, step_sizes steps, bool scales) {
    const auto values = [&](const auto& array, int count) {
        return array.components() == 0 ? static_cast<double>(size) * static_cast<double>(sizeof(*array.data())) * count
                                       : 0;
    };
    const component_array<R> no_reals;
    const component_array<std::int64_t> no_counters;
    if (steps == step_sizes::kept) need.add("step sizes", values(there ? there->h_next : no_reals, 1));
    if (scales) need.add("tolerance scales", values(there ? there->tolerance_scale : no_reals, 1));
    if (shape.writes_time_domain) need.add("time domains", values(there ? there->domain : no_reals, 2));
    const int counters = 2 + (steps == step_sizes::kept ? 1 : 0) + (shape.n_event > 0 ? 1 : 0);
    if (o.counting == counting::on) need.add("counters", values(there ? there->counted[0] : no_counters, counters));
}

template <class R>
void ensemble_data<R>::expect_phases(std::int64_t phases) {
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    if (phases_asked + phases > most)  // those that have ended did fewer
        phases_asked = *std::max_element(phase.data(), phase.data() + size);
    require(phases_asked + phases <= most, phases, " phases are asked for after ", phases_asked,
            ", and an instance can do ", most, ": call restart() to count from zero");
    phases_asked += phases;
}
template <class R>
void ensemble_data<R>::mark_invalid(std::int64_t i) {
    untouched = false;
    ended.data()[i] = 1;
    status.data()[i] = myriad::status::invalid_input;
}
template <class R>
bool ensemble_data<R>::has_fired_last(int event, std::int64_t i) const {
    return status.data()[i] == myriad::status::stopped_by_event ||
           (side.component(event)[i] == 0 && counts() && counted[0].data()[i] > 0);
}
template <class R>
digest ensemble_data<R>::inputs_digest(std::int64_t i) const {
    digest of_all;
    for (int c = 0; c < shape->n_state; ++c) of_all.add(state.component(c)[i]);
    for (int c = 0; c < shape->n_parameter; ++c) of_all.add(parameter.component(c)[i]);
    return of_all;
}
template <class R>
void ensemble_data<R>::remember_ended() {
    ended_before.add(ended.data(), size, [this](std::int64_t i) {
        return ended_instance<R>{i, inputs_digest(i), t_begin_of(i), t_end_of(i)};
    });
}

void refuse_pinning(const memory_need& need, const error& why) {
    throw error(message("an ensemble that takes ", bytes_text(need.bytes()), " or more was not pinned: ", why.what()));
}

template struct ensemble_data<double>;
template struct ensemble_data<float>;

}  // namespace myriad::host
