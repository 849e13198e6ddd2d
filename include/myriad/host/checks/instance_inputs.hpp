// SPDX-License-Identifier: MIT
// The inputs of a model's functions for one instance, for host code that calls them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The state of instance i, and the time at which it begins.
template <class Model, class R>
vec<R, n_state<Model>> state_of(const argument_head<R>& a, std::int64_t i) {
    vec<R, n_state<Model>> y;
    for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) y[c] = a.state[c * a.size + i];
    return y;
}
template <class R>
R begin_of(const argument_head<R>& a, std::int64_t i) {
    return a.t_begin != nullptr ? a.t_begin[i] : a.common_t_begin;
}

/// A past in which the states were always what they are at the start: for checks before an integration.
template <class Model, class R>
void put_constant_past(inputs<Model, R>& p, const argument_head<R>& a, std::int64_t i) {
    if constexpr (has_delays<Model>) {
        constexpr int slots = 8, steps = slots * history_fields(0, 0);
        thread_local std::unique_ptr<R[]> ring;  // the inputs are used at once
        ring.reset(new R[static_cast<std::size_t>(steps + MYRIAD_LENGTH(n_kept<Model>) + 2)]());
        detail::for_each_kept_state<Model>([&](auto at, int state) { ring[steps + at] = a.state[state * a.size + i]; });
        p.past = {};  // without steps
        p.later = {};
        p.past.ring = ring.get();
        p.past.stride = 1;
        p.past.slots = slots;
        p.past.terms = 1;  // which is read, and not used
        p.past.row = history_fields(0, 0);
        p.past.reached = std::numeric_limits<R>::infinity();
        p.past.begin_of(0) = std::numeric_limits<R>::infinity();
        for (int g = 0; g < MYRIAD_LENGTH(n_lag<Model>); ++g) {
            p.past.lane[0].from[g] = -1;
            p.past.lane[0].before[g] = p.past.lane[0].none;
        }
        for (int j = 0; j < MYRIAD_LENGTH(n_delayed<Model>); ++j) p.past.lane[0].seen[j].number = -1;
        p.past.lane[0].forget();
        detail::recall<Model>(detail::begin_of(a, i), detail::state_of<Model>(a, i), p);
    }
}

/// The argument p of instance i. It points into the arrays.
template <class Model, class R>
inputs<Model, R> inputs_of(const argument_head<R>& a, std::int64_t i) {
    inputs<Model, R> p;
#define MYRIAD_READ_KIND(kind, ...) \
    for (int c = 0; c < MYRIAD_LENGTH(n_##kind<Model>); ++c) p.kind[c] = a.kind[c * a.size + i];
    MYRIAD_PARAMETER_KINDS(MYRIAD_READ_KIND)
    if constexpr (!accessories_are_outputs<Model>) {
        MYRIAD_ACCESSORY_KINDS(MYRIAD_READ_KIND)
    }
#undef MYRIAD_READ_KIND
    p.shared.values = a.shared.real;
    p.shared_integer.values = a.shared.integer;
    detail::put_constant_past(p, a, i);
    return p;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
