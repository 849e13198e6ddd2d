// SPDX-License-Identifier: MIT
// LU factorisation with partial pivoting for the small matrices of implicit methods, for one lane or a pack whose lanes
// pivot independently. In place, without allocation.
#pragma once

#include <type_traits>

#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/matrix_loop.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A row number: an integer for one lane, a real (comparable with reals) per lane of a pack.
template <class S>
using row_number = std::conditional_t<lanes_of<S> == 1, int, S>;
template <class S>
MYRIAD_FUNCTION row_number<S> row_number_of(int i) {
    return row_number<S>(static_cast<std::conditional_t<lanes_of<S> == 1, int, real_of<S>>>(i));
}

/// The matrix A, replaced by its factors in `factorise`: the multipliers below the diagonal; on and above it U, with
/// the reciprocals of the pivots on the diagonal. In step k row `pivot[k]` was exchanged with row k from column k on
/// (multipliers stay in place, so `solve_factorised` alternates exchanges and eliminations).
template <class S, extent n>
struct lu_factors {
    matrix<S, n> a;
    vec<row_number<S>, n> pivot;
};

/// Calls `swap(i, where)` for the rows i > k that contain some lane's pivot.
template <class S, extent n, class K, class Swap>
MYRIAD_FUNCTION void exchange_rows(K k, const row_number<S>& pivot, Swap&& swap) {
    if constexpr (lanes_of<S> == 1 && !matrix_loop<S, n>::unrolled) {
        if (pivot != k) swap(pivot, true);
    } else {
        matrix_loop<S, n>::after(k, [&](auto i) MYRIAD_LAMBDA {
            const auto where = pivot == row_number_of<S>(i);
            // Lanes mostly agree. In an unrolled loop the test would cost what it saves.
            if (matrix_loop<S, n>::unrolled || any(where)) swap(i, where);
        });
    }
}

/// Factorises `lu.a`. Returns false in lanes with a zero or non-finite pivot, whose matrix is singular.
template <class S, extent n>
MYRIAD_FUNCTION mask_of<S> factorise(lu_factors<S, n>& lu) {
    using R = real_of<S>;
    using loop = matrix_loop<S, n>;
    auto& a = lu.a;
    mask_of<S> regular = mask_of<S>(true);
    loop::all([&](auto k) MYRIAD_LAMBDA {
        S size = abs(a[k][k]);
        row_number<S> pivot = row_number_of<S>(k);
        loop::after(k, [&](auto i) MYRIAD_LAMBDA {
            const S other = abs(a[i][k]);
            const auto larger = other > size;
            size = select(larger, other, size);
            pivot = select(larger, row_number_of<S>(i), pivot);
        });
        lu.pivot[k] = pivot;
        detail::exchange_rows<S, n>(k, pivot, [&](auto i, const auto& where) MYRIAD_LAMBDA {
            loop::from(k, [&](auto j) MYRIAD_LAMBDA {
                const S upper = a[k][j];
                a[k][j] = select(where, a[i][j], upper);
                a[i][j] = select(where, upper, a[i][j]);
            });
        });
        regular = regular & (size > S(R(0))) & (size <= S(largest_of<R>));
        const S reciprocal = S(R(1)) / a[k][k];
        a[k][k] = reciprocal;
        loop::after(k, [&](auto i) MYRIAD_LAMBDA {
            const S multiplier = a[i][k] * reciprocal;
            a[i][k] = multiplier;
            loop::after(k, [&](auto j) MYRIAD_LAMBDA { a[i][j] = fma(-multiplier, a[k][j], a[i][j]); });
        });
    });
    return regular;
}

/// Solves A x = b with the factors of A; x replaces b.
template <class S, extent n>
MYRIAD_FUNCTION void solve_factorised(const lu_factors<S, n>& lu, vec<S, n>& b) {
    using loop = matrix_loop<S, n>;
    const auto& a = lu.a;
    loop::all([&](auto k) MYRIAD_LAMBDA {
        detail::exchange_rows<S, n>(k, lu.pivot[k], [&](auto i, const auto& where) MYRIAD_LAMBDA {
            const S upper = b[k];
            b[k] = select(where, b[i], upper);
            b[i] = select(where, upper, b[i]);
        });
        loop::after(k, [&](auto i) MYRIAD_LAMBDA { b[i] = fma(-a[i][k], b[k], b[i]); });
    });
    loop::all_backwards([&](auto k) MYRIAD_LAMBDA {
        b[k] = b[k] * a[k][k];
        loop::before(k, [&](auto i) MYRIAD_LAMBDA { b[i] = fma(-a[i][k], b[k], b[i]); });
    });
}

/// Solves A^T x = b with the factors of A; x replaces b.
template <class S, extent n>
MYRIAD_FUNCTION void solve_transposed(const lu_factors<S, n>& lu, vec<S, n>& b) {
    using loop = matrix_loop<S, n>;
    const auto& a = lu.a;
    loop::all([&](auto k) MYRIAD_LAMBDA {
        b[k] = b[k] * a[k][k];
        loop::after(k, [&](auto i) MYRIAD_LAMBDA { b[i] = fma(-a[k][i], b[k], b[i]); });
    });
    loop::all_backwards([&](auto k) MYRIAD_LAMBDA {
        loop::after(k, [&](auto i) MYRIAD_LAMBDA { b[k] = fma(-a[i][k], b[i], b[k]); });
        detail::exchange_rows<S, n>(k, lu.pivot[k], [&](auto i, const auto& where) MYRIAD_LAMBDA {
            const S upper = b[k];
            b[k] = select(where, b[i], upper);
            b[i] = select(where, upper, b[i]);
        });
    });
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
