// SPDX-License-Identifier: MIT
// Loops through tables that are known at compile time: written out, with constants as indices, or as loops.
#pragma once

#include "myriad/kernel/core/static_for.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Loops whose functions get a `constant_index` if they are written out, else an int. `tables` is a constant at
/// namespace scope, `table` a pointer to a member of it, an array of int.
template <bool written_out>
struct table_loop {
    static constexpr bool is_written_out = written_out;

    /// Element i of a table.
    template <const auto& tables, auto table, class I>
    static MYRIAD_FUNCTION auto at(I i) {
        if constexpr (written_out) {
            return constant_index<(tables.*table)[I::value]>{};
        } else {
            return (tables.*table)[i];
        }
    }
    /// begin <= i < end
    template <int begin, extent end, class F>
    static MYRIAD_FUNCTION void range(F&& f) {
        if constexpr (written_out) {
            static_for<begin, MYRIAD_LENGTH(end)>(f);
        } else {
            MYRIAD_ROLLED
            for (int i = begin; i < MYRIAD_LENGTH(end); ++i) f(i);
        }
    }
    /// From end - 1 down to begin.
    template <int begin, int end, class F>
    static MYRIAD_FUNCTION void range_backwards(F&& f) {
        range<begin, end>([&](auto i) MYRIAD_LAMBDA { f(difference(constant_index<begin + end - 1>{}, i)); });
    }
    /// From element i of a table up to its element i + 1.
    template <const auto& tables, auto table, class I, class F>
    static MYRIAD_FUNCTION void between(I i, F&& f) {
        if constexpr (written_out) {
            static_for<(tables.*table)[I::value], (tables.*table)[I::value + 1]>(f);
        } else {
            MYRIAD_ROLLED
            for (int k = (tables.*table)[i]; k < (tables.*table)[i + 1]; ++k) f(k);
        }
    }
    template <class A, class B>
    static MYRIAD_FUNCTION auto sum(A a, B b) {
        if constexpr (written_out) {
            return constant_index<A::value + B::value>{};
        } else {
            return a + b;
        }
    }
    template <class A, class B>
    static MYRIAD_FUNCTION auto difference(A a, B b) {
        if constexpr (written_out) {
            return constant_index<A::value - B::value>{};
        } else {
            return a - b;
        }
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
