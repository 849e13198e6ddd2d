// SPDX-License-Identifier: MIT
// The samples of an ensemble without its model's type: compiled in the library, free of Eigen. Host code only.
#pragma once

#include <cstdint>
#include <vector>

#include "myriad/host/core/left_behind.hpp"
#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// What a call does with samples that it allocates: left unset are those that it sets before anyone looks at them.
enum class new_samples : std::uint8_t { cleared, unset };

/// `trajectory_samples` of any model.
template <class R>
struct sample_data {
    sample_data() = default;
    /// Times and values are not set: `clear` does that, before a call that does not set them all.
    sample_data(int n_state, const sample_options& o, std::int64_t of_instances);
    /// The memory they take for an ensemble of that size.
    static double bytes_for(const sample_options& o, std::int64_t size);

    /// The samples of state c. Throws `error` if it was not sampled.
    const R* component(std::int64_t c) const;
    void clear();
    void pin(int device);

    moved_number<std::int64_t> size = 0, capacity = 0;
    component_list chosen;
    std::vector<std::int16_t> column;  // of each state; -1: not sampled
    component_array<std::int32_t> stored;
    component_array<R> time, values;
};
extern template struct sample_data<double>;
extern template struct sample_data<float>;

}  // namespace myriad::host::inline MYRIAD_ABI
