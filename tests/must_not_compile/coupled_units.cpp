// case: publications_of_the_wrong_size
// expect: publish has a wrong signature: it must be
// case: publications_without_a_function
// expect: units that publish have both
// case: unit_without_state
// expect: units have no state: give them
// case: slopes_of_the_whole_system
// expect: rhs of coupled units has a wrong signature: it must be
// case: unit_that_reads_beyond_the_last
// expect: there is no unit of this number
// case: coupling_of_a_state
// expect: a coupling sums something that is not published
// case: coupling_beyond_the_publications
// expect: a coupling sums something that is not published
// case: band_that_is_too_wide
// expect: the band of a coupling does not fit
// case: ring_that_meets_itself
// expect: the band of a coupling does not fit
// case: matrix_of_a_later_coupling
// expect: a coupling has the matrix of one that is not earlier
// case: parameter_of_the_system_of_a_unit
// expect: this enumerator is of another kind of component
// case: states_of_the_system
// expect: the states of coupled units are those of the units
// case: team_that_does_not_divide_a_warp
// expect: threads_per_instance is not a power of two from 1 to 256
// SPDX-License-Identifier: MIT
// Units that cannot be coupled.
// The first header is precompiled.
// clang-format off
#include <myriad/instantiate.hpp>
#include "myriad/coupled_units.hpp"
#include "myriad/model.hpp"
// clang-format on

struct cell {
#if defined CASE_team_that_does_not_divide_a_warp
    static constexpr int threads_per_instance = 12;
#endif
#if !defined CASE_unit_without_state
    enum unit_state { x, n_unit_state };
#else
    static constexpr int x = 0;
#endif
#if defined CASE_states_of_the_system
    enum state { z, n_state };
#endif
    enum parameter { k, n_parameter };
    enum unit_parameter { c, n_unit_parameter };
    enum publication { flow, n_publication };
#if defined CASE_coupling_of_a_state
    static constexpr myriad::coupling couplings[] = {myriad::full_coupling(x)};
#elif defined CASE_coupling_beyond_the_publications
    static constexpr myriad::coupling couplings[] = {myriad::full_coupling(n_publication)};
#elif defined CASE_band_that_is_too_wide
    static constexpr myriad::coupling couplings[] = {myriad::banded_coupling(flow, 4)};
#elif defined CASE_ring_that_meets_itself
    static constexpr myriad::coupling couplings[] = {myriad::circulant_coupling(flow, 2)};
#elif defined CASE_matrix_of_a_later_coupling
    static constexpr myriad::coupling couplings[] = {myriad::same_coupling(flow, 1),
                                                     myriad::circulant_coupling(flow, 1)};
#else
    static constexpr myriad::coupling couplings[] = {myriad::circulant_coupling(flow, 1)};
#endif

#if defined CASE_publications_of_the_wrong_size
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> publish(int, auto, const auto& y, const auto&) {
        return {y[x], y[x]};
    }
#elif !defined CASE_publications_without_a_function
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_publication> publish(int, auto, const auto& y, const auto&) {
        return myriad::vec<R, n_publication>{y[x]};
    }
#endif

#if defined CASE_slopes_of_the_whole_system
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 4> rhs(int, auto, const auto& y, const auto&) {
        return {y[x], y[x], y[x], y[x]};
    }
#else
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(int, auto, const auto& y, const auto& p) {
#if defined CASE_unit_that_reads_beyond_the_last
        const R other = y.of(4)[x];
#else
        const R other = y.of(3)[x];
#endif
#if defined CASE_parameter_of_the_system_of_a_unit
        return myriad::vec<R, 1>{-p.unit_parameter[k] * other};
#else
        return myriad::vec<R, 1>{-p.unit_parameter[c] * other + p[k] * y.coupled(0)};
#endif
    }
#endif
};
using cells = myriad::coupled_units<cell, 4>;

MYRIAD_INSTANTIATE(cells, myriad::runge_kutta_4)
