// SPDX-License-Identifier: MIT
// The pollution model by CVODE, as a user writes it for many instances: BDF with the Jacobian in closed form, one
// object reinitialised for each instance.
#pragma once

#include <vector>

namespace stiff_peers {

enum class factors { dense, klu };

/// Whether CVODE was built with that linear solver.
bool is_built(factors which);

/// Integrates one instance after another to the end; `states` has the states of instance i from i n_state on, and is
/// replaced by those at the end. Throws std::runtime_error if CVODE fails.
void integrate_by_cvode(factors which, double relative, double absolute, const std::vector<double>& k1,
                        std::vector<double>& states);

}  // namespace stiff_peers
