// SPDX-License-Identifier: MIT
// The checks of the paths of stochastic equations before an integration. Compiled in the library, for any model.
#pragma once

#include <cstdint>

#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The paths of a stochastic equation must have room in their counters, for the instances' numbers and for as many
/// cells as the domain has, which the real type must tell apart. NaN domains are left to the check of the inputs.
template <class R>
void check_paths(const ensemble_data<R>& e, const options& o, std::int64_t count, bool adaptive);

/// Into so many cells of paths a domain or phase is divided for adaptive steps, if options::noise_step does not say.
inline constexpr int cells_of_domain = 64;
/// The length of the cells of paths.
template <class R>
double cell_of_paths(const ensemble_data<R>& e, const options& o, bool adaptive);

}  // namespace myriad::host::inline MYRIAD_ABI
