// case: mass_matrix_with_an_explicit_method
// expect: the model has a mass_matrix, which explicit methods do not take: use rodas_5p
// case: mass_matrix_with_a_method_that_is_not_stiffly_accurate
// expect: the model has a mass_matrix, which this method does not take
// case: mass_matrix_with_an_entry_beyond_the_states
// expect: an entry of the model's mass_matrix has a row or a column that is no state
// SPDX-License-Identifier: MIT
// Mass matrices with methods that do not take them, and of a wrong size.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct constrained {
    enum state { x, z, n_state };
#if defined CASE_mass_matrix_with_an_entry_beyond_the_states
    static constexpr myriad::mass_entry mass_matrix[] = {{x, x, 1}, {n_state, x, 1}};
#else
    static constexpr myriad::mass_entry mass_matrix[] = {{x, x, 1}};
#endif

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {-y[z], y[z] - y[x]};
    }
};

#if defined CASE_mass_matrix_with_an_explicit_method
using method = myriad::tsitouras_5;
#elif defined CASE_mass_matrix_with_a_method_that_is_not_stiffly_accurate
using method = myriad::rosenbrock_23;
#else
using method = myriad::rodas_5p;
#endif

MYRIAD_INSTANTIATE(constrained, method)
