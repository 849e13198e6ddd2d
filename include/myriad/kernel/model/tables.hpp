// SPDX-License-Identifier: MIT
// Tables in shared values, such as measured forcing: elements whose number differs between instances.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/dependence.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// Element `row * stride` of a table that begins at `table`, as in `myriad::lookup(&p.shared[forcing], 1, n, row)`:
/// lane by lane for a row that is a whole number from 0 to `rows - 1`; others count as the nearest one, and NaN as 0.
/// Its derivative is zero.
template <class T, class R>
MYRIAD_FUNCTION R lookup(const T* table, int stride, int rows, const R& row) {
    if constexpr (detail::is_dual<R>) {
        return R(myriad::lookup(table, stride, rows, row.value));
    } else if constexpr (detail::is_dependence<R>) {
        return R();
    } else {
        R found(T(0));
        for (int i = 0; i < lanes_of<R>; ++i) {
            const auto wanted = detail::get_lane(row, i);
            const int at = !(wanted > 0) ? 0 : wanted < static_cast<T>(rows - 1) ? static_cast<int>(wanted) : rows - 1;
            detail::set_lane(found, i, table[static_cast<std::int64_t>(at) * stride]);
        }
        return found;
    }
}

/// The number of the interval of increasing knots in which x lies, from 0 to `knots - 2`: the last one that begins at
/// or before x. Those outside are in the first or the last one. By bisection, lane by lane.
template <class T, class R>
MYRIAD_FUNCTION R find_interval(const T* table, int knots, const R& x) {
    if constexpr (detail::is_dual<R>) {
        return R(myriad::find_interval(table, knots, x.value));
    } else if constexpr (detail::is_dependence<R>) {
        return R();
    } else {
        R found(T(0));
        for (int i = 0; i < lanes_of<R>; ++i) {
            const auto wanted = detail::get_lane(x, i);
            int low = 0, high = knots - 1;
            while (high - low > 1) {
                const int middle = low + (high - low) / 2;
                (table[middle] <= wanted ? low : high) = middle;
            }
            detail::set_lane(found, i, static_cast<T>(low));
        }
        return found;
    }
}

}  // namespace myriad::inline MYRIAD_TARGET
