// SPDX-License-Identifier: MIT
// The mass matrix M of a model M y' = f(t, y): constant, declared by its entries; singular if some equations are
// algebraic.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"

namespace myriad {

/// An entry of the mass matrix, from enumerators of `state` or their numbers: `static constexpr myriad::mass_entry
/// mass_matrix[] = {{a, a, 1}, {b, b, 1}};`, with which the equation of a third state is algebraic, 0 = f.
struct mass_entry {
    int row;       ///< number of the equation
    int column;    ///< number of the state whose derivative is multiplied
    double value;  ///< by this factor
};

}  // namespace myriad

namespace myriad::detail {

template <class Model>
constexpr int n_mass_entry_of() {
    if constexpr (requires { Model::mass_matrix; }) {
        return length_of_array<decltype(Model::mass_matrix[0]), sizeof(Model::mass_matrix)>;
    } else {
        return 0;
    }
}
/// Number of entries of the mass matrix that a model declares.
template <class Model>
inline constexpr int n_mass_entry = n_mass_entry_of<Model>();
/// Whether a model has a mass matrix other than the identity.
template <class Model>
inline constexpr bool has_mass_matrix = n_mass_entry<Model> > 0;

template <class Model>
constexpr bool mass_entries_are_of_states() {
    if constexpr (has_mass_matrix<Model>)
        for (const mass_entry& e : Model::mass_matrix)
            if (e.row < 0 || e.row >= n_state<Model> || e.column < 0 || e.column >= n_state<Model>) return false;
    return true;
}
template <class Model>
inline constexpr bool mass_entries_fit = mass_entries_are_of_states<Model>();

/// An entry's place, and its value in the kernel's precision, as constants.
template <class Model, extent m>
inline constexpr int mass_row = Model::mass_matrix[m].row;
template <class Model, extent m>
inline constexpr int mass_column = Model::mass_matrix[m].column;
template <class Model, extent m, class R>
inline constexpr R mass_value = static_cast<R>(Model::mass_matrix[m].value);

}  // namespace myriad::detail

namespace myriad::detail::inline MYRIAD_TARGET {

/// Number of entries, the Jacobian's and the mass matrix', that a stiff method's matrix is made of.
template <class Model>
inline constexpr int n_matrix_entry = n_jacobian_entry<Model> + n_mass_entry<Model>;

/// These entries, the Jacobian's first.
template <class Model>
struct matrix_entries {
    jacobian_entry entry[n_matrix_entry<Model>]{};

    constexpr matrix_entries() {
        int next = 0;
        for (const jacobian_entry& e : jacobian_entries_of<Model>.entry) entry[next++] = e;
        if constexpr (has_mass_matrix<Model>)
            for (const mass_entry& e : Model::mass_matrix) entry[next++] = {e.row, e.column};
    }
    constexpr const jacobian_entry& operator[](int e) const { return entry[e]; }
};
template <class Model>
inline constexpr matrix_entries<Model> matrix_entries_of{};

}  // namespace myriad::detail::inline MYRIAD_TARGET
