// case: adjoint_of_events
// expect: the model has hooks, events, triggers or stop times, of which there is no adjoint in C\+\+
// case: adjoint_of_accessories
// expect: the model has accessories, of which there is no adjoint
// case: adjoint_of_sensitivities
// expect: the model has tangents or sensitivities: give the adjoint the original
// case: adjoint_of_a_mass_matrix
// expect: there is no adjoint of models with a mass matrix
// case: adjoint_of_noise
// expect: there is no adjoint of delays and of stochastic equations
// case: adjoint_of_a_method_without_dense_output
// expect: an adjoint needs all steps, which methods with dense output keep: myriad::dense<Method>
// SPDX-License-Identifier: MIT
// Adjoints of models that have none.

#include <myriad/instantiate_adjoint.hpp>

#include "myriad/sensitivity.hpp"

struct growth {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {p[k] * y[x]};
    }
};
using method = myriad::dense<myriad::dormand_prince_5>;
MYRIAD_INSTANTIATE_ADJOINT(growth, method)

#if defined(CASE_adjoint_of_events)
struct crossing : growth {
    enum event { zero, n_event };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[x]};
    }
};
MYRIAD_INSTANTIATE_ADJOINT(crossing, method)
#elif defined(CASE_adjoint_of_accessories)
struct storing : growth {
    enum accessory { kept, n_accessory };
};
MYRIAD_INSTANTIATE_ADJOINT(storing, method)
#elif defined(CASE_adjoint_of_sensitivities)
using varied = myriad::with_sensitivities<growth, growth::k>;
MYRIAD_INSTANTIATE_ADJOINT(varied, method)
#elif defined(CASE_adjoint_of_a_mass_matrix)
struct massive : growth {
    static constexpr myriad::mass_entry mass_matrix[] = {{x, x, 2.0}};
};
using stiff = myriad::dense<myriad::rodas_5p>;
MYRIAD_INSTANTIATE_ADJOINT(massive, stiff)
#elif defined(CASE_adjoint_of_noise)
struct noisy : growth {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[x]};
    }
};
MYRIAD_INSTANTIATE_ADJOINT(noisy, method)
#elif defined(CASE_adjoint_of_a_method_without_dense_output)
MYRIAD_INSTANTIATE_ADJOINT(growth, myriad::dormand_prince_5)
#endif
