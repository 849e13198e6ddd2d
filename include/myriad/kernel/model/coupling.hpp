// SPDX-License-Identifier: MIT
// Couplings of units by matrices: what a model declares, and where the entries lie among the shared values.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/summaries.hpp"

namespace myriad {

/// Which entries of a coupling's matrix there are.
enum class coupling_shape : std::uint8_t {
    full,       ///< all of them
    banded,     ///< those near the diagonal
    circulant,  ///< every row is the one above it, moved by one place to the right, round the end
};

/// A sum over all units: a matrix times what the units publish. Made by `full_coupling`, `banded_coupling`,
/// `circulant_coupling` and `same_coupling`; its entries are set by `set_coupling`, on the host, and are the same for
/// all instances.
struct coupling {
    int publication;                 ///< number of the publication that is summed
    coupling_shape shape;            ///< which entries there are
    int bandwidth;                   ///< diagonals with entries on either side of the main one; -1: all
    std::uint64_t publication_type;  ///< a mark of the type of the publication, for checks
    int matrix_of = -1;              ///< number of the earlier coupling whose matrix it has; -1: it has its own
};

/// By a matrix of any entries.
template <class Publication>
constexpr coupling full_coupling(Publication publication) {
    return {static_cast<int>(publication), coupling_shape::full, -1, detail::type_mark<Publication>};
}
/// By a matrix with entries on the diagonal, and on `bandwidth` diagonals on either side of it.
template <class Publication>
constexpr coupling banded_coupling(Publication publication, int bandwidth) {
    return {static_cast<int>(publication), coupling_shape::banded, bandwidth, detail::type_mark<Publication>};
}
/// By a circulant matrix: a ring, in which all units are coupled alike. With `bandwidth`, a unit is coupled to that
/// many neighbours on either side; without, to all units.
template <class Publication>
constexpr coupling circulant_coupling(Publication publication, int bandwidth = -1) {
    return {static_cast<int>(publication), coupling_shape::circulant, bandwidth, detail::type_mark<Publication>};
}
/// By the matrix of an earlier coupling, which is given by its place among `couplings`.
template <class Publication, class K>
constexpr coupling same_coupling(Publication publication, K earlier) {
    return {static_cast<int>(publication), coupling_shape::full, -1, detail::type_mark<Publication>,
            static_cast<int>(earlier)};
}

}  // namespace myriad

namespace myriad::detail {

template <class Unit>
constexpr int n_coupling_of() {
    if constexpr (requires { Unit::couplings[0]; }) {
        return length_of_array<decltype(Unit::couplings[0]), sizeof(Unit::couplings)>;
    } else {
        return 0;
    }
}
/// Number of couplings that units declare.
template <class Unit>
inline constexpr int n_coupling = n_coupling_of<Unit>();

/// Where the entries of a matrix lie, and how many of them a row has. Those of rows that follow each other lie side by
/// side, so that the threads of a team, and the sums that one thread forms together, read them at once.
struct coupling_layout {
    int publication;
    coupling_shape shape;
    int bandwidth;
    int units;

    MYRIAD_FUNCTION int entries_of_row() const { return bandwidth < 0 ? units : 2 * bandwidth + 1; }
    MYRIAD_FUNCTION int entries() const {
        return shape == coupling_shape::circulant ? entries_of_row() : units * entries_of_row();
    }
    /// The column of entry k of a row; outside the matrix near the corners of a banded one.
    MYRIAD_FUNCTION int column(int row, int k) const {
        if (shape == coupling_shape::full) return k;
        const int j = row + k - (bandwidth < 0 ? 0 : bandwidth);
        if (shape == coupling_shape::banded) return j;
        return j < 0 ? j + units : j >= units ? j - units : j;
    }
    MYRIAD_FUNCTION int entry(int row, int k) const { return shape == coupling_shape::circulant ? k : k * units + row; }
    MYRIAD_FUNCTION bool in_matrix(int column) const { return column >= 0 && column < units; }
};
/// The number of the coupling whose matrix coupling k has: k itself, or an earlier one.
template <class Unit, int k>
inline constexpr int coupling_with_matrix = Unit::couplings[k].matrix_of < 0 ? k : Unit::couplings[k].matrix_of;
/// Without the mark of a type.
template <class Unit, int units, int k>
inline constexpr coupling_layout coupling_layout_of{Unit::couplings[k].publication,
                                                    Unit::couplings[coupling_with_matrix<Unit, k>].shape,
                                                    Unit::couplings[coupling_with_matrix<Unit, k>].bandwidth, units};

/// Number of entries of the couplings before coupling `end`.
template <class Unit, int units, int end = n_coupling<Unit>>
constexpr int coupling_entries_before() {
    if constexpr (end == 0) {
        return 0;
    } else {
        constexpr bool has_own = coupling_with_matrix<Unit, end - 1> == end - 1;
        return coupling_entries_before<Unit, units, end - 1>() +
               (has_own ? coupling_layout_of<Unit, units, end - 1>.entries() : 0);
    }
}

template <class Unit, int units, int k>
inline constexpr int first_coupling_entry = coupling_entries_before<Unit, units, coupling_with_matrix<Unit, k>>();

/// Whether a mark of a type stands for a number, or for the units' enumeration of publications.
template <class Unit>
constexpr bool marks_publication(std::uint64_t mark) {
    bool own = mark == type_mark<int> || mark == type_mark<std::remove_cv_t<decltype(Unit::n_publication)>>;
    if constexpr (requires { typename Unit::publication; }) own = own || mark == type_mark<typename Unit::publication>;
    return own;
}

/// Refuses couplings of something that is not published, and bands that do not fit.
template <class Unit, int units>
constexpr bool check_couplings() {
    if constexpr (n_coupling < Unit >> 0) {
        constexpr auto all_of = [](auto holds) {
            for (const coupling& c : Unit::couplings)
                if (!holds(c)) return false;
            return true;
        };
        static_assert(n_publication<Unit> > 0,
                      "a coupling sums what units publish: give them `enum publication { ..., n_publication };` and a "
                      "function `publish`");
        static_assert(all_of([](const coupling& c) {
                          return c.publication >= 0 && c.publication < n_publication<Unit> &&
                                 marks_publication<Unit>(c.publication_type);
                      }),
                      "a coupling sums something that is not published: its first argument is an enumerator of "
                      "`publication`");
        static_assert(all_of([](const coupling& c) {
                          return c.shape == coupling_shape::circulant ? c.bandwidth >= -1 && 2 * c.bandwidth < units
                                 : c.shape == coupling_shape::banded  ? c.bandwidth >= 0 && c.bandwidth < units
                                                                      : c.bandwidth == -1;
                      }),
                      "the band of a coupling does not fit: a banded matrix has fewer diagonals on either side of the "
                      "main one than there are units, a circulant one fewer than half as many");
        static_assert(all_of([number = 0](const coupling& c) mutable {
                          const int earlier = c.matrix_of;
                          return earlier < number++ && (earlier < 0 || Unit::couplings[earlier].matrix_of < 0);
                      }),
                      "a coupling has the matrix of one that is not earlier, or that has none of its own: give "
                      "same_coupling the number of an earlier full, banded or circulant coupling");
    }
    return true;
}

}  // namespace myriad::detail
