// SPDX-License-Identifier: MIT
// The arrays of a kernel's arguments as a list, for backends that have to copy them: how many components each has, and
// whether a kernel reads or writes it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail {

/// How a kernel uses an array.
enum class array_access { read, update, write };

/// What an array holds, for callers that need only some of them. Bookkeeping is what an instance needs in order to
/// continue in a later call; before the first it is zero, or, for t, never read.
enum class array_kind { state, accessory, integer_accessory, input, bookkeeping, samples, records };

template <int n>
constexpr int columns_in(const std::int16_t (&column)[n]) {
    int count = 0;
    for (const std::int16_t c : column) count = c >= count ? c + 1 : count;
    return count;
}

/// Calls `visit(pointer, components, access, kind)` for every array that the ensemble has, the pointer by reference:
/// component c of instance i is at `pointer[c * size + i]`. Parameters and times are written only if the model declares
/// it. The order puts arrays that are only read, those that are set and read, and bookkeeping next to each other where
/// a backend copies them.
template <class Model, class R, class Visit>
void for_each_array(kernel_arguments<Model, R>& a, Visit&& visit) {
    using access = array_access;
    using kind = array_kind;
    const auto visit_array = [&](auto*& array, std::int64_t components, array_access how, array_kind what) {
        if (array != nullptr && components > 0) visit(array, components, how, what);
    };
    constexpr access times = writes_time_domain<Model> ? access::update : access::read;
    const std::int64_t capacity = a.sample.capacity;
    visit_array(a.tolerance_scale, 1, access::read, kind::input);
    visit_array(a.sample.own_times, a.sample.count, access::read, kind::input);
    visit_array(a.t_begin, 1, times, kind::input);
    visit_array(a.t_end, 1, times, kind::input);
    visit_array(a.parameter, n_parameter<Model>, writes_parameters<Model> ? access::update : access::read, kind::input);
    visit_array(a.state, n_state<Model>, access::update, kind::state);
    visit_array(a.accessory, n_accessory<Model>, access::update, kind::accessory);
    visit_array(a.integer_accessory, n_integer_accessory<Model>, access::update, kind::integer_accessory);
    visit_array(a.t, 1, access::update, kind::bookkeeping);
    visit_array(a.h_next, 1, access::update, kind::bookkeeping);
    visit_array(a.phase, 1, access::update, kind::bookkeeping);
    visit_array(a.side, n_event<Model>, access::update, kind::bookkeeping);
    visit_array(a.ended, 1, access::update, kind::bookkeeping);
    visit_array(a.status, 1, access::update, kind::bookkeeping);
    visit_array(a.accepted, 1, access::update, kind::bookkeeping);
    visit_array(a.rejected, 1, access::update, kind::bookkeeping);
    visit_array(a.located, 1, access::update, kind::bookkeeping);
    visit_array(a.evaluations, 1, access::update, kind::bookkeeping);
    visit_array(a.sample.stored, 1, access::update, kind::samples);
    visit_array(a.sample.time, capacity, access::update, kind::samples);
    visit_array(a.sample.values, columns_in(a.sample.column) * capacity, access::update, kind::samples);
}

/// The same for the records of one call, which kernels only write.
template <class Model, class R, class Visit>
void for_each_record(record_arguments<Model, R>& r, Visit&& visit) {
    const std::int64_t reals =
        std::max({columns_in(r.state_column), columns_in(r.accessory_column), r.time_column + 1});
    const std::int64_t integers = columns_in(r.integer_accessory_column);
    if (r.values != nullptr && reals > 0) visit(r.values, reals * r.phases, array_access::write, array_kind::records);
    if (r.integers != nullptr && integers > 0)
        visit(r.integers, integers * r.phases, array_access::write, array_kind::records);
}

}  // namespace myriad::detail
