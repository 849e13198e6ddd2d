// SPDX-License-Identifier: MIT
// Loops over the rows and columns of a small square matrix, written once for two cases: unrolled, with the matrix in
// registers, or as loops that index it in memory.
#pragma once

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// `matrix[i][j]` is row i, column j.
template <class S, auto n>  // not an extent, by which g++ 12 crashes
using matrix = vec<vec<S, n>, n>;

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

/// Largest matrix held in registers. A GPU thread has 255: factors, stages and right-hand side of a Rosenbrock method
/// in double precision fit up to 6 (240 registers); pivoted LU alone takes 220 at n = 8, and spills from n = 12. A core
/// has 16 or 32 for a whole pack: unrolled for n = 4 and 5, rodas_5p is 1.25 and 1.6 times as fast (AVX-512), but a
/// kernel for n = 6 takes 69 s to compile instead of 5.
template <class S>
inline constexpr int largest_matrix_in_registers = lanes_of<S> == 1 ? 6 : 3;

/// A loop over 0 <= i < n that is written out.
template <extent n>
struct unrolled_loop {
    template <class F>
    static MYRIAD_FUNCTION void all(F&& f) {
        static_for<0, n>(f);
    }
};

/// Loops over 0 <= i < n, for numbers of kind S. `f` gets the index as a `constant_index` if the loop is unrolled, else
/// as an int.
template <class S, extent n>
struct matrix_loop {
    static constexpr bool unrolled = n <= largest_matrix_in_registers<S>;

    template <class F>
    static MYRIAD_FUNCTION void all(F&& f) {
        if constexpr (unrolled) {
            static_for<0, n>(f);
        } else {
            MYRIAD_ROLLED
            for (int i = 0; i < MYRIAD_LENGTH(n); ++i) f(i);
        }
    }
    /// From n - 1 down to 0.
    template <class F>
    static MYRIAD_FUNCTION void all_backwards(F&& f) {
        if constexpr (unrolled) {
            static_for<0, n>([&](auto i) MYRIAD_LAMBDA { f(constant_index<n - 1 - decltype(i)::value>{}); });
        } else {
            MYRIAD_ROLLED
            for (int i = MYRIAD_LENGTH(n) - 1; i >= 0; --i) f(i);
        }
    }
    /// k <= i < n
    template <class K, class F>
    static MYRIAD_FUNCTION void from(K k, F&& f) {
        if constexpr (unrolled) {
            static_for<K::value, n>(f);
        } else {
            MYRIAD_UNROLL_BY(4)
            for (int i = k; i < MYRIAD_LENGTH(n); ++i) f(i);
        }
    }
    /// k < i < n
    template <class K, class F>
    static MYRIAD_FUNCTION void after(K k, F&& f) {
        if constexpr (unrolled) {
            static_for<K::value + 1, n>(f);
        } else {
            MYRIAD_UNROLL_BY(4)
            for (int i = k + 1; i < MYRIAD_LENGTH(n); ++i) f(i);
        }
    }
    /// 0 <= i < k
    template <class K, class F>
    static MYRIAD_FUNCTION void before(K k, F&& f) {
        if constexpr (unrolled) {
            static_for<0, K::value>(f);
        } else {
            MYRIAD_UNROLL_BY(4)
            for (int i = 0; i < k; ++i) f(i);
        }
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
