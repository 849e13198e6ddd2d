// SPDX-License-Identifier: MIT
// The data of ensembles, for both real types.
#include "myriad/host/ensemble/ensemble_data.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "myriad/host/backend/arrays.hpp"
#include "myriad/host/threads/parallel.hpp"

namespace myriad::host::inline MYRIAD_ABI {

using detail::array_kind;
using detail::array_pointer;
using detail::array_presence;
using detail::array_properties;
using detail::for_each_instance_array;
using detail::instance_arrays;

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
    require(size > 0, named_option("ensemble", "the ensemble"), " has ", size,
            " instances (must be positive): there is nothing to integrate");
    ensemble_data<R>::memory_of(shape, size)
        .check(message("an ensemble of ", size, " instances"), "integrate it in smaller parts, one after the other");
    return size;
}

}  // namespace

template <class R>
ensemble_data<R>::ensemble_data(const model_shape& of_model, std::int64_t n)
    : shape(&of_model), size(checked<R>(of_model, n)), identity(next_identity()) {
#define MYRIAD_ALLOCATE_SHARED(kind, plural, words, type) kind = {shape->n_##kind, 1, detail::unset_value<type>};
    MYRIAD_SHARED_KINDS(MYRIAD_ALLOCATE_SHARED)
#undef MYRIAD_ALLOCATE_SHARED
    const auto allocate = [n](const array_properties& of, auto first, auto& array) {
        if (of.presence == array_presence::always) array = {of.components, n, first};
    };
    for_each_instance_array<R>(*shape, allocate, *this);
}
template <class R>
ensemble_data<R>::~ensemble_data() = default;

template <class R>
void ensemble_data<R>::require_present() const {
    require(size > 0, "this ensemble was moved away", cure, "use the one that it was moved to");
}
template <class R>
occupancy::claim ensemble_data<R>::take() {
    require_present();
    return occupied.take(
        "this ensemble is being integrated already, by another thread or by the call whose function "
        "calls this: wait for it, or use an ensemble of its own");
}

template <class R>
void ensemble_data<R>::set_domain(R begin, R end) {
    common_begin = begin;
    common_end = end;
    for (auto* const array : {&this->t_begin, &common_begins})
        if (array->components() > 0) array->fill(begin);
    for (auto* const array : {&this->t_end, &common_ends})
        if (array->components() > 0) array->fill(end);
}
template <class R>
typename ensemble_data<R>::arrays& ensemble_data<R>::own_domains() {
    on_demand(this->t_begin, common_begin);
    on_demand(this->t_end, common_end);
    return *this;
}
template <class R>
const component_array<R>& ensemble_data<R>::read_begins() const {
    return has_common_domain() ? on_demand(common_begins, common_begin) : this->t_begin;
}
template <class R>
const component_array<R>& ensemble_data<R>::read_ends() const {
    return has_common_domain() ? on_demand(common_ends, common_end) : this->t_end;
}

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
    return on_demand(this->tolerance_scale, R(1));
}
template <class R>
const component_array<R>& ensemble_data<R>::next_steps() const {
    return this->h_next.components() > 0 ? this->h_next : on_demand(no_steps, R(0));
}
template <class R>
const component_array<std::int64_t>& ensemble_data<R>::counter(component_array<std::int64_t> arrays::*which) const {
    require(counts(), "no work was counted", cure, "integrate with counting = counting::on");
    const auto& counted = this->*which;
    return counted.components() > 0 ? counted : on_demand(nothing_counted, std::int64_t{0});
}

/// What decides which arrays a call needs. Not in an unnamed namespace: lambdas of members capture it, about which g++
/// warns where files are compiled together.
struct call_needs {
    counting count;
    step_sizes steps;
    bool scales_tolerances, own_domains;

    bool include(array_presence presence) const {
        switch (presence) {
            case array_presence::always:
                return true;
            case array_presence::step_sizes:
                return steps == step_sizes::kept;
            case array_presence::tolerance_scales:
                return scales_tolerances;
            case array_presence::own_domains:
                return own_domains;
            case array_presence::counters:
                return count == counting::on;
            case array_presence::counters_of_step_sizes:
                return count == counting::on && steps == step_sizes::kept;
        }
        return false;
    }
};

template <class R>
void ensemble_data<R>::fill_pointers(instance_arrays<array_pointer, R>& pointers, counting count, step_sizes steps) {
    if (shape->writes_time_domain) own_domains();
    const call_needs call{count, steps, scales_tolerances(), !has_common_domain()};
    const auto point = [&](const array_properties& of, auto first, auto*& pointer, auto& array) {
        const bool needed = of.components > 0 && call.include(of.presence);
        if (needed) on_demand(array, first);
        pointer = needed ? array.data() : nullptr;  // even if an earlier call needed it
    };
    for_each_instance_array<R>(*shape, point, pointers, static_cast<arrays&>(*this));
}
template <class R>
void ensemble_data<R>::fill_domain(instance_arrays<array_pointer, R>& pointers) {
    if (shape->writes_time_domain) own_domains();
    pointers.t_begin = this->t_begin.data();
    pointers.t_end = this->t_end.data();
}

template <class R>
myriad::status ensemble_data<R>::status_of(std::int64_t i) const {
    require_present();
    require(i >= 0 && i < size, "instance ", i, " does not exist: ", named_option("ensemble", "the ensemble"), " has ",
            std::int64_t{size}, " instances");
    return this->status.data()[i];
}

template <class R>
void ensemble_data<R>::keep_history(std::int32_t slots, std::int32_t terms) {
    if (shape->n_kept == 0 || (slots == history_slots && terms == history_terms)) return;
    require(untouched || history_slots == 0, "the past of these instances is kept as ", history_slots, " steps of ",
            history_terms, " numbers, but this call would keep ", slots, " of ", terms, cure,
            "go on with the same method and the same history_steps, or call restart() to begin again");
    const auto numbers = detail::history_numbers(slots, shape->n_kept, terms, shape->jump_numbers);
    history = {static_cast<int>(numbers), size, R(0)};
    history_jumps = {slots, size, std::uint32_t{0}};
    history_place = {2, size, std::int32_t{0}};
    history_slots = slots;
    history_terms = terms;
    if (!pinned()) return;
    history.pin(pinned_for);
    history_jumps.pin(pinned_for);
    history_place.pin(pinned_for);
}
template <class R>
detail::history_arguments<R> ensemble_data<R>::history_pointers() {
    return {history.data(), history_jumps.data(), history_place.data(), history_slots, history_terms};
}
template <class R>
double ensemble_data<R>::history_bytes(const model_shape& shape, std::int64_t size, std::int32_t slots,
                                       std::int32_t terms) {
    if (shape.n_kept == 0) return 0;
    const auto numbers = static_cast<double>(detail::history_numbers(slots, shape.n_kept, terms, shape.jump_numbers));
    return static_cast<double>(size) * (sizeof(R) * numbers + sizeof(std::uint32_t) * slots + 2 * sizeof(std::int32_t));
}

template <class R>
void ensemble_data<R>::restart() {
    phases_asked = 0;
    if (untouched) return;
    untouched = true;
    // One parallel loop for all arrays, because of the overhead of starting and ending one.
    in_parallel(size, 32'768, [this](std::int64_t first, std::int64_t last) {
        const auto clear = [&](const array_properties& of, auto value, auto& array) {
            // Not t, whose first value is NaN: a phase writes it before anything reads it.
            if (of.kind == array_kind::bookkeeping && value == value) array.fill_instances(first, last, value);
        };
        for_each_instance_array<R>(*shape, clear, *this);
        history_place.fill_instances(first, last, std::int32_t{0});
    });
    ended_before.clear();
}
template <class R>
void ensemble_data<R>::pin(int gpu) {
    for_each_instance_array<R>(
        *shape, [gpu](const array_properties&, auto, auto& array) { array.pin(gpu); }, *this);
    history.pin(gpu);
    history_jumps.pin(gpu);
    history_place.pin(gpu);
}

namespace {

/// Bytes of an array for so many instances.
template <class T>
double bytes_of(const array_properties& of, T, std::int64_t size) {
    return static_cast<double>(of.components) * static_cast<double>(sizeof(T)) * static_cast<double>(size);
}

}  // namespace

template <class R>
memory_need ensemble_data<R>::memory_of(const model_shape& shape, std::int64_t size) {
    memory_need need;
    const auto add = [&](const array_properties& of, auto first) {
        if (of.presence == array_presence::always) need.add(of.name, bytes_of(of, first, size));
    };
    for_each_instance_array<R>(shape, add);
    return need;
}
template <class R>
void ensemble_data<R>::add_memory_of_call(memory_need& need, const model_shape& shape, std::int64_t size,
                                          const ensemble_data* there, const options& o, step_sizes steps, bool scales) {
    const arrays none{};
    const call_needs call{o.counting, steps, scales, shape.writes_time_domain};
    const auto add = [&](const array_properties& of, auto first, const auto& array) {
        const bool allocates = of.presence != array_presence::always && array.components() == 0;
        if (allocates && call.include(of.presence)) need.add(of.name, bytes_of(of, first, size));
    };
    for_each_instance_array<R>(shape, add, there != nullptr ? *there : none);
}

template <class R>
void ensemble_data<R>::expect_phases(std::int64_t phases) {
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    if (phases_asked + phases > most)  // those that have ended did fewer
        phases_asked = *std::max_element(this->phase.data(), this->phase.data() + size);
    require(phases_asked + phases <= most, phases, " phases are asked for after ", phases_asked,
            ", and an instance can do ", most, cure, "call restart() to count from zero");
    phases_asked += phases;
}
template <class R>
void ensemble_data<R>::mark_invalid(std::int64_t i) {
    untouched = false;
    this->ended.data()[i] = 1;
    this->status.data()[i] = myriad::status::invalid_input;
}
template <class R>
void ensemble_data<R>::leave(std::int64_t i) {
    if (this->ended.data()[i] != 0) return;
    this->ended.data()[i] = 1;
    this->status.data()[i] = myriad::status::interrupted;
    if (this->phase.data()[i] == 0) this->t.data()[i] = t_begin_of(i);
}
template <class R>
digest ensemble_data<R>::inputs_digest(std::int64_t i) const {
    digest of_all;
    for (int c = 0; c < shape->n_state; ++c) of_all.add(this->state.component(c)[i]);
    for (int c = 0; c < shape->n_parameter; ++c) of_all.add(this->parameter.component(c)[i]);
    return of_all;
}
template <class R>
void ensemble_data<R>::remember_ended() {
    ended_before.add(this->ended.data(), size, [this](std::int64_t i) {
        return ended_instance<R>{i, inputs_digest(i), t_begin_of(i), t_end_of(i)};
    });
}

template <class R>
detail::argument_head<R> inputs_in(ensemble_data<R>& data) {
    detail::argument_head<R> all{};
    all.size = data.size;
    all.first_index = data.first_index;
    using arrays = typename ensemble_data<R>::arrays;
    for_each_instance_array<R>(
        *data.shape, [](auto&&, auto, auto*& pointer, auto& array) { pointer = array.data(); }, all,
        static_cast<arrays&>(data));
    all.common_t_begin = data.common_begin;
    all.common_t_end = data.common_end;
    all.shared = {data.shared.data(), data.shared_integer.data()};
    all.history = data.history_pointers();
    return all;
}
template detail::argument_head<double> inputs_in(ensemble_data<double>&);
template detail::argument_head<float> inputs_in(ensemble_data<float>&);

void refuse_pinning(const memory_need& need, const error& why) {
    throw error(message("an ensemble that takes ", bytes_text(need.bytes()), " or more was not pinned: ", why.what()));
}

template struct ensemble_data<double>;
template struct ensemble_data<float>;

}  // namespace myriad::host::inline MYRIAD_ABI
