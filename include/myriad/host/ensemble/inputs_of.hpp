// SPDX-License-Identifier: MIT
// The inputs of a model's functions for one instance, for host code that calls them.
#pragma once

#include <cstdint>

#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/lane.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The argument p of instance i. It points into the ensemble.
template <class Model, class R>
inputs<Model, R> inputs_of(ensemble<Model, R>& e, std::int64_t i) {
    inputs<Model, R> p;
    for (int c = 0; c < detail::n_parameter<Model>; ++c) p.parameter[c] = e.parameter(c)[i];
    if constexpr (!detail::accessories_are_outputs<Model>) {
        for (int c = 0; c < detail::n_accessory<Model>; ++c) p.accessory[c] = e.accessory(c)[i];
        for (int c = 0; c < detail::n_integer_accessory<Model>; ++c) p.integer_accessory[c] = e.integer_accessory(c)[i];
    }
    if constexpr ((detail::n_shared<Model>) > 0) p.shared = &e.shared(0);
    if constexpr ((detail::n_shared_integer<Model>) > 0) p.shared_integer = &e.shared_integer(0);
    return p;
}

/// Calls visit(i) for a thousand or so of the first `count` instances, evenly spread, except those that have ended for
/// good.
template <class Model, class R, class Visit>
void for_sampled_instances(const ensemble<Model, R>& e, std::int64_t count, Visit&& visit) {
    const std::int64_t stride = count / 1024 > 1 ? count / 1024 : 1;
    for (std::int64_t i = 0; i < count; i += stride)
        if (!e.ended(i)) visit(i);
}

}  // namespace myriad::host::inline MYRIAD_ABI
