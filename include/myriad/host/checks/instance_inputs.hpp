// SPDX-License-Identifier: MIT
// The inputs of a model's functions for one instance, for host code that calls them.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

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
    return p;
}
/// Its state, and the time at which it begins.
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

}  // namespace myriad::detail::inline MYRIAD_TARGET
