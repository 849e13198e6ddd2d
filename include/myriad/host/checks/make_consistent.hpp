// SPDX-License-Identifier: MIT
// Initial values that satisfy the algebraic equations of a model with a singular mass matrix. Host code; it calls the
// model on initial states.
#pragma once

#include "myriad/host/checks/consistency.hpp"
#include "myriad/host/checks/linearisation.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/mass_matrix.hpp"

namespace myriad {

/// Changes the initial states of all instances so that they satisfy the algebraic equations of a model with a singular
/// `mass_matrix`, by Newton's method in the directions that leave M y as it is. Times, parameters and shared values
/// must be set. Throws `error`, with the instance, where the index is above one or the method does not converge.
template <class Model, class R>
void make_consistent(ensemble<Model, R>& e) {
    static_assert(detail::has_mass_matrix<Model>, "the model has no mass_matrix, and so no algebraic equations");
    detail::instance_functions<R> model;
    detail::add_linearisation<Model>(model);
    host::project_initial_states(host::ensemble_access::data(e), model);
}

}  // namespace myriad
