// SPDX-License-Identifier: MIT
// The entries of a model's Jacobian that may differ from zero: declared in the model, read at compile time.
#pragma once

#include <cstdint>
#include <iterator>
#include <type_traits>

#include "myriad/kernel/model/concepts.hpp"

namespace myriad {

/// An entry of the Jacobian that may differ from zero, df_row/dy_column, from enumerators of `state` or their numbers:
/// `static constexpr myriad::jacobian_entry jacobian_pattern[] = {{x, x}, {x, v}, {v, x}};`
struct jacobian_entry {
    int row;     ///< number of the state whose slope depends on the other
    int column;  ///< number of the state on which it depends
};

}  // namespace myriad

namespace myriad::detail {

/// Whether a model declares its Jacobian's pattern. One that a model with tangents inherits is for the states without
/// tangents, and does not count.
template <class Model>
constexpr bool declares_jacobian_pattern() {
    return requires { Model::jacobian_pattern; }
    &&n_tangent<Model> == 0;
}
template <class Model>
constexpr int n_jacobian_entry_of() {
    if constexpr (declares_jacobian_pattern<Model>()) {
        return static_cast<int>(std::size(Model::jacobian_pattern));
    } else {
        return 0;
    }
}
/// Number of entries that a model declares.
template <class Model>
inline constexpr int n_jacobian_entry = n_jacobian_entry_of<Model>();
template <class Model>
inline constexpr bool has_jacobian_pattern = n_jacobian_entry<Model> > 0;

/// A set of numbers below n, as bits.
template <int n>
struct number_set {
    static constexpr int words = (n + 63) / 64;
    std::uint64_t bits[words]{};

    constexpr void insert(int i) { bits[i / 64] |= std::uint64_t(1) << (i % 64); }
    constexpr void erase(int i) { bits[i / 64] &= ~(std::uint64_t(1) << (i % 64)); }
    constexpr bool contains(int i) const { return (bits[i / 64] >> (i % 64)) & 1; }
    constexpr void insert(const number_set& other) {
        for (int w = 0; w < words; ++w) bits[w] |= other.bits[w];
    }
    constexpr void erase(const number_set& other) {
        for (int w = 0; w < words; ++w) bits[w] &= ~other.bits[w];
    }
    constexpr bool meets(const number_set& other) const {
        for (int w = 0; w < words; ++w)
            if ((bits[w] & other.bits[w]) != 0) return true;
        return false;
    }
    constexpr int size() const {
        int count = 0;
        for (int w = 0; w < words; ++w) {
            // Knuth, The Art of Computer Programming 4A, 7.1.3, eq. (62)
            std::uint64_t x = bits[w];
            x -= (x >> 1) & 0x5555555555555555u;
            x = (x & 0x3333333333333333u) + ((x >> 2) & 0x3333333333333333u);
            x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
            count += static_cast<int>((x * 0x0101010101010101u) >> 56);
        }
        return count;
    }
};

/// The declared entries, and the columns in groups without a common row, so that one evaluation of rhs with dual
/// numbers gives all columns of a group (Curtis, Powell and Reid, IMA J. Appl. Math. 13, 1974, 117): each column joins
/// the first group that it fits.
template <int n, int entries>
struct jacobian_groups {
    int count = 0;
    int group_of_column[n]{};
    int row[entries]{}, group[entries]{};  // of each entry

    template <class Entries>
    constexpr explicit jacobian_groups(const Entries& declared) {
        number_set<n> rows[n]{}, taken[n]{};
        for (int e = 0; e < entries; ++e) rows[declared[e].column].insert(declared[e].row);
        for (int j = 0; j < n; ++j) {
            int g = 0;
            while (rows[j].meets(taken[g])) ++g;
            group_of_column[j] = g;
            taken[g].insert(rows[j]);
            if (g >= count) count = g + 1;
        }
        for (int e = 0; e < entries; ++e) {
            row[e] = declared[e].row;
            group[e] = group_of_column[declared[e].column];
        }
    }
};

template <class Model>
inline constexpr jacobian_groups<n_state<Model>, n_jacobian_entry<Model>> jacobian_groups_of{Model::jacobian_pattern};

}  // namespace myriad::detail
