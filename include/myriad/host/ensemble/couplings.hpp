// SPDX-License-Identifier: MIT
// The matrices by which units are coupled, set in an ensemble.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "myriad/host/ensemble/coupling_entries.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/kernel/model/coupled_units.hpp"

namespace myriad {

/// Sets the matrix of coupling `k`, its place among `couplings`, for all instances: row i has the weights of what other
/// units publish in the sum of unit i, in units of the sum per unit of the publication. Throws `error` if the matrix is
/// not square with a row for each unit, is not circulant though the coupling is, or has entries that are not finite or
/// outside the band. A `same_coupling` shares its matrix with the earlier coupling: what is set for either is set for
/// both.
template <class Unit, int units, class R, class K>
void set_coupling(ensemble<coupled_units<Unit, units>, R>& e, K k, const Eigen::MatrixXd& matrix) {
    static_assert(detail::n_coupling<Unit> > 0, "the units have no `couplings`");
    static constexpr auto layouts = []<int... c>(std::integer_sequence<int, c...>) {
        return std::array{detail::coupling_layout_of<Unit, units, c>...};
    }
    (std::make_integer_sequence<int, detail::n_coupling<Unit>>{});
    static constexpr auto first = []<int... c>(std::integer_sequence<int, c...>) {
        return std::array{detail::first_coupling_entry<Unit, units, c>...};
    }
    (std::make_integer_sequence<int, detail::n_coupling<Unit>>{});
    const auto number = static_cast<std::int64_t>(k);
    host::check_component(number, detail::n_coupling<Unit>, "coupling");
    const auto c = static_cast<std::size_t>(number);
    const std::vector<double> entries =
        host::coupling_entries(layouts[c], static_cast<int>(number), matrix.data(), matrix.rows(), matrix.cols());
    for (std::size_t i = 0; i < entries.size(); ++i)
        e.shared(coupled_units<Unit, units>::first_coupling + first[c] + static_cast<int>(i)) =
            static_cast<R>(entries[i]);
}

}  // namespace myriad
