// SPDX-License-Identifier: MIT
// What a method makes of a model's Jacobian.
#pragma once

#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"
#include "myriad/kernel/model/matrix_facts.hpp"
#include "myriad/kernel/scalar/matrix_loop.hpp"
#include "myriad/kernel/stepper/sparse_lu.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class R>
constexpr matrix_facts find_matrix_facts() {
    // As the concept of Rosenbrock methods, whose header has kernels.
    if constexpr (requires { Method::tableau().coupling; }) {
        constexpr auto n = n_state<Model>;
        constexpr bool known = origin_of_pattern<Model>() != pattern_origin::none;
        int evaluations = 0;
        if constexpr (!gives_jacobian<Model>) {
            evaluations = n;
            if constexpr (factorises_sparsely<Model>) evaluations = jacobian_groups_of<Model>.count;
        }
        return {n, known ? n_jacobian_entry<Model> : n * n, n_factor_entry<Model>, evaluations,
                !known && n > largest_matrix_in_registers<R>};
    } else {
        return {};
    }
}
template <class Model, class Method, class R>
inline constexpr matrix_facts matrix_facts_of = find_matrix_facts<Model, Method, R>();

}  // namespace myriad::detail::inline MYRIAD_TARGET
