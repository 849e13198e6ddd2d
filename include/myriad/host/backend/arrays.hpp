// SPDX-License-Identifier: MIT
// The arrays of an ensemble and of a kernel's arguments as a list: how many components each has, when it is allocated,
// what it holds at first, and whether a kernel reads or writes it. Allocating, clearing, pinning and copying them
// follows from it.
#pragma once

#include <cstdint>
#include <limits>

#include "myriad/host/backend/any_arguments.hpp"

namespace myriad::detail {

/// How a kernel uses an array.
enum class array_access { read, update, write };

/// What an array holds, for callers that need only some of them. Bookkeeping is what an instance needs in order to
/// continue in a later call; before the first it is zero, or, for t, never read.
enum class array_kind {
#define MYRIAD_NAME_KIND(kind, ...) kind,
    MYRIAD_RECORDED_KINDS(MYRIAD_NAME_KIND)
#undef MYRIAD_NAME_KIND
        input,
    bookkeeping,
    samples,
    records
};

/// When an ensemble allocates an array.
enum class array_presence {
    always,
    step_sizes,        // for a method with step-size control
    tolerance_scales,  // once the user sets them
    own_domains,       // once instances have domains of their own
    counters,          // for a call that counts work
    counters_of_step_sizes,
};

// What is counted of each instance: the name in results, the array, and what it is for people.
#define MYRIAD_COUNTERS(row)                                                                        \
    row(accepted_steps, accepted, "accepted steps") row(rejected_steps, rejected, "rejected steps") \
        row(located_steps, located, "steps that ended at a located event")                          \
            row(rhs_evaluations, evaluations, "evaluations of the right-hand side")

struct array_properties {
    int components;
    array_access access;
    array_kind kind;
    array_presence presence;
    const char* name;  // in messages on memory
};

/// A component before the user sets it.
template <class T>
inline constexpr T unset_value = std::numeric_limits<T>::has_quiet_NaN ? std::numeric_limits<T>::quiet_NaN() : T(0);

/// Calls `visit(properties, first value, array of each of the arguments...)` for all arrays of the instances of such a
/// model; each argument is an `instance_arrays`. The first value is that before the user sets one, or before the first
/// phase. The order puts arrays that are only read, those that are set and read, and bookkeeping next to each other
/// where a backend copies them.
template <class R, class Visit, class... Arrays>
void for_each_instance_array(const model_numbers& m, Visit&& visit, Arrays&... a) {
    using access = array_access;
    using kind = array_kind;
    using presence = array_presence;
    constexpr R unset = unset_value<R>;
    constexpr const char *domains = "time domains", *counters = "counters", *rest = "times, phases and statuses";
    const access times = m.writes_time_domain ? access::update : access::read;
    const access parameters = m.writes_parameters ? access::update : access::read;
    const int with_events = m.n_event > 0 ? 1 : 0;
    const auto add = [&](int components, access how, kind what, presence when, const char* name, auto first,
                         auto&... array) {
        visit(array_properties{components, how, what, when, name}, first, array...);
    };
    const auto keep = [&](int components, presence when, const char* name, auto first, auto&... array) {
        add(components, access::update, kind::bookkeeping, when, name, first, array...);
    };
    add(1, access::read, kind::input, presence::tolerance_scales, "tolerance scales", R(1), a.tolerance_scale...);
    add(1, times, kind::input, presence::own_domains, domains, unset, a.t_begin...);
    add(1, times, kind::input, presence::own_domains, domains, unset, a.t_end...);
#define MYRIAD_ADD_INPUT(which, plural, words, type) \
    add(m.n_##which, parameters, kind::input, presence::always, #plural, unset_value<type>, a.which...);
    MYRIAD_PARAMETER_KINDS(MYRIAD_ADD_INPUT)
#undef MYRIAD_ADD_INPUT
#define MYRIAD_ADD_RESULT(which, plural, words, type) \
    add(m.n_##which, access::update, kind::which, presence::always, #plural, unset_value<type>, a.which...);
    MYRIAD_RECORDED_KINDS(MYRIAD_ADD_RESULT)
#undef MYRIAD_ADD_RESULT
    keep(1, presence::always, rest, unset, a.t...);
    keep(1, presence::step_sizes, "step sizes", R(0), a.h_next...);
    keep(1, presence::always, rest, std::int32_t{0}, a.phase...);
    keep(m.n_event, presence::always, rest, std::int32_t{0}, a.side...);
    keep(1, presence::always, rest, std::uint8_t{0}, a.ended...);
    keep(1, presence::always, rest, myriad::status::not_started, a.status...);
    keep(1, presence::counters, counters, std::int64_t{0}, a.accepted...);
    keep(1, presence::counters_of_step_sizes, counters, std::int64_t{0}, a.rejected...);
    keep(with_events, presence::counters, counters, std::int64_t{0}, a.located...);
    keep(1, presence::counters, counters, std::int64_t{0}, a.evaluations...);
}

/// Calls `visit(pointer, components, access, kind)` for every array that a kernel's arguments have, the pointer by
/// reference: component c of instance i is at `pointer[c * size + i]`.
template <class R, class Visit>
void for_each_array(any_arguments<R>& a, Visit&& visit) {
    const auto visit_array = [&](auto*& array, std::int64_t components, array_access how, array_kind what) {
        if (array != nullptr && components > 0) visit(array, components, how, what);
    };
    visit_array(a.sample.own_times, a.sample.count, array_access::read, array_kind::input);
    for_each_instance_array<R>(
        *a.model,
        [&](const array_properties& of, auto, auto*& array) { visit_array(array, of.components, of.access, of.kind); },
        a);
    const std::int64_t slots = a.history.slots;
    const int kept = a.model->n_kept;
    const auto past = array_access::update;
    visit_array(a.history.ring, history_numbers(slots, kept, a.history.terms, a.model->jump_numbers), past,
                array_kind::bookkeeping);
    visit_array(a.history.jumps, slots, past, array_kind::bookkeeping);
    visit_array(a.history.place, 2, past, array_kind::bookkeeping);
    const std::int64_t capacity = a.sample.capacity;
    const auto update = array_access::update;
    visit_array(a.sample.stored, 1, update, array_kind::samples);
    visit_array(a.sample.time, capacity, update, array_kind::samples);
    visit_array(a.sample.values, a.sample_columns * capacity, update, array_kind::samples);
}

/// The same for the records of one call, which kernels only write.
template <class R, class Visit>
void for_each_record(any_arguments<R>& a, Visit&& visit) {
    const auto visit_array = [&](auto*& array, std::int64_t columns) {
        if (array != nullptr && columns > 0)
            visit(array, columns * a.record.phases, array_access::write, array_kind::records);
    };
    visit_array(a.record.values, a.record_columns);
    visit_array(a.record.integers, a.integer_record_columns);
}

/// The bytes that each instance takes in all of these.
template <class R>
std::int64_t bytes_per_instance(any_arguments<R> a) {
    std::int64_t bytes = 0;
    const auto add = [&](auto* array, std::int64_t components, auto...) {
        bytes += components * static_cast<std::int64_t>(sizeof(*array));
    };
    for_each_array(a, add);
    for_each_record(a, add);
    return bytes;
}

}  // namespace myriad::detail
