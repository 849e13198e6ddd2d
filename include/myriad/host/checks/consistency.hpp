// SPDX-License-Identifier: MIT
// Whether initial values satisfy the algebraic equations of a model with a singular mass matrix, and their projection
// onto these. Compiled in the library. Host code only.
#pragma once

#include <cstdint>

#include "myriad/host/checks/instance_functions.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Throws `error` if the initial values of some instance do not satisfy the algebraic equations to within what the
/// tolerances allow of each state, or if the index is above one. Looks at a thousand or so of the instances that have
/// not begun.
template <class R>
void check_consistency(const ensemble_data<R>& e, const options& o, std::int64_t count,
                       const detail::single_instances<R>& of);

/// Changes the initial states of all instances so that they satisfy the algebraic equations of a model with a mass
/// matrix. Throws `error`.
template <class R>
void project_initial_states(ensemble_data<R>& e, const detail::instance_functions<R>& model);

}  // namespace myriad::host::inline MYRIAD_ABI
