// SPDX-License-Identifier: MIT
// Storage of dense output, for both real types.
#include "myriad/host/ensemble/sample_data.hpp"

#include <limits>

#include "myriad/host/core/error.hpp"

namespace myriad::host::inline MYRIAD_ABI {

template <class R>
sample_data<R>::sample_data(int n_state, const sample_options& o, std::int64_t of_instances)
    : size(of_instances), capacity(o.capacity), chosen(o.states), column(static_cast<std::size_t>(n_state), -1),
      stored(1, of_instances, 0) {
    std::int16_t columns = 0;
    for (const int c : o.states) column[static_cast<std::size_t>(c)] = columns++;
    require(capacity <= std::numeric_limits<std::int64_t>::max() / size, named_option("samples.capacity"), " ",
            o.capacity, " times ", of_instances, " instances exceeds any memory", cure, "take fewer samples");
    const std::int64_t cells = size * capacity;
    time = component_array<R>(1, cells);
    values = component_array<R>(columns, cells);
}
template <class R>
double sample_data<R>::bytes_for(const sample_options& o, std::int64_t size) {
    const auto cells = static_cast<double>(o.capacity) * static_cast<double>(o.states.size() + 1);
    return static_cast<double>(size) * (sizeof(std::int32_t) + sizeof(R) * cells);
}
template <class R>
const R* sample_data<R>::component(std::int64_t c) const {
    const bool exists = c >= 0 && c < static_cast<std::int64_t>(column.size());
    const int at = exists ? column[static_cast<std::size_t>(c)] : -1;
    require(at >= 0, "state ", c, " was not sampled", cure, cures::name_in_samples);
    return values.component(at);
}
template <class R>
void sample_data<R>::clear() {
    if (capacity == 0) return;
    stored.fill(0);
    time.fill(std::numeric_limits<R>::quiet_NaN());
    values.fill(std::numeric_limits<R>::quiet_NaN());
}
template <class R>
void sample_data<R>::pin(int device) {
    stored.pin(device);
    time.pin(device);
    values.pin(device);
}

template struct sample_data<double>;
template struct sample_data<float>;

}  // namespace myriad::host::inline MYRIAD_ABI
