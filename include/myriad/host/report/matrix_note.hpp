// SPDX-License-Identifier: MIT
// What a report says of the matrix of a stiff method.
#pragma once

#include "myriad/host/report/report.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"
#include "myriad/kernel/scalar/matrix_loop.hpp"
#include "myriad/kernel/stepper/sparse_lu.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// What a stiff method makes of the Jacobian; adds a note if its pattern is not known and would be of use.
template <class Method, class Model, class R>
void note_matrix(report<Model, R>& r) {
    // As the concept of Rosenbrock methods, whose header has kernels.
    if constexpr (requires { Method::tableau().coupling; }) {
        constexpr int n = n_state<Model>;
        constexpr bool known = detail::origin_of_pattern<Model>() != detail::pattern_origin::none;
        r.matrix = {n, known ? detail::n_jacobian_entry<Model> : n * n, detail::n_factor_entry<Model>};
        if constexpr (!known && n > detail::largest_matrix_in_registers<R>)
            r.notes.emplace_back(
                "rhs looks at values, of a state, a parameter or a shared integer, so that the compiler cannot find "
                "which entries of the Jacobian are zero, and the method works with all of them: use myriad::select "
                "instead of branches, or declare jacobian_pattern");
    }
}

}  // namespace myriad::host::inline MYRIAD_ABI
