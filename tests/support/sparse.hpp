// SPDX-License-Identifier: MIT
// Stiff networks with and without the declared pattern of their Jacobian, and patterns whose order of pivots matters.
#pragma once

#include <array>

#include <myriad/model.hpp>

#include "problems/van_der_pol_ring.hpp"

namespace sparse {

/// n / 2 van der Pol oscillators in a ring, each pulled by its neighbours; + - * / only. It looks at a value, zero, so
/// that the compiler does not find the pattern of its Jacobian.
template <int n>
struct dense_ring {
    enum state { first, n_state = n };
    enum parameter { mu, n_parameter };
    enum shared_integer { at_rest, n_shared_integer };
    static constexpr int left(int x) { return (x + n - 2) % n; }
    static constexpr int right(int x) { return (x + 2) % n; }

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto, const myriad::vec<R, n>& y, const auto& p) {
        myriad::vec<R, n> f{};
        if (p.shared_integer[at_rest] != 0) return f;
        MYRIAD_UNROLL
        for (int x = 0; x < n; x += 2) {
            f[x] = y[x + 1];
            f[x + 1] = p[mu] * (R(1) - y[x] * y[x]) * y[x + 1] - y[x] +
                       R(10) * (y[(x + n - 2) % n] - R(2) * y[x] + y[(x + 2) % n]);
        }
        return f;
    }
};

/// Five entries for each oscillator: x' by v; v' by x, v and the neighbours.
template <int n>
inline constexpr auto ring_pattern = [] {
    std::array<myriad::jacobian_entry, 5 * n / 2> entries{};
    std::size_t e = 0;
    for (int x = 0; x < n; x += 2) {
        entries[e++] = {x, x + 1};
        for (const int column : {x, x + 1, dense_ring<n>::left(x), dense_ring<n>::right(x)})
            entries[e++] = {x + 1, column};
    }
    return entries;
}();

/// The same without a value that decides, so that the pattern is found.
template <int n>
using plain_ring = problems::van_der_pol_ring<n>;

/// And with its pattern declared.
template <int n>
struct ring : dense_ring<n> {
    static constexpr auto jacobian_pattern = ring_pattern<n>;
    static constexpr bool autonomous = true;
};

/// And with the derivatives, in the order of the pattern.
template <int n>
struct ring_with_jacobian : ring<n> {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 5 * n / 2> jacobian(auto, const myriad::vec<R, n>& y, const auto& p) {
        myriad::vec<R, 5 * n / 2> j;
        MYRIAD_UNROLL
        for (int i = 0; i < n / 2; ++i) {
            const int x = 2 * i, e = 5 * i;
            j[e] = R(1);
            j[e + 1] = R(-2) * p[0] * y[x] * y[x + 1] - R(21);
            j[e + 2] = p[0] * (R(1) - y[x] * y[x]);
            j[e + 3] = j[e + 4] = R(10);
        }
        return j;
    }
};

/// A pattern without its last entry, that of the last velocity by its right neighbour.
template <int n>
struct ring_with_a_gap : dense_ring<n> {
    static constexpr bool has_wrong_derivatives = true;  // for tests/every_model
    static constexpr auto jacobian_pattern = [] {
        std::array<myriad::jacobian_entry, ring_pattern<n>.size() - 1> entries{};
        for (std::size_t e = 0; e < entries.size(); ++e) entries[e] = ring_pattern<n>[e];
        return entries;
    }();
};

/// Every state depends on the first, and the first on every one: eliminated first, it would fill the matrix.
template <int n>
struct arrow {
    enum state { first, n_state = n };
    static constexpr auto jacobian_pattern = [] {
        std::array<myriad::jacobian_entry, 3 * n - 2> entries{};
        std::size_t e = 0;
        for (int i = 0; i < n; ++i) entries[e++] = {i, i};
        for (int i = 1; i < n; ++i) entries[e++] = {0, i}, entries[e++] = {i, 0};
        return entries;
    }();
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto, const myriad::vec<R, n>& y, const auto&) {
        myriad::vec<R, n> f;
        f[0] = -y[0];
        for (int i = 1; i < n; ++i) {
            f[0] = f[0] + y[i];
            f[i] = y[0] - R(i) * y[i];
        }
        return f;
    }
};

/// Seven decays and one growth at a given rate: with rate = 1 / (h gamma) the matrix of a step of length h is singular.
struct growth_among_decays {
    enum state { x, y, n_state = 8 };
    enum parameter { rate, n_parameter };
    static constexpr myriad::jacobian_entry jacobian_pattern[] = {{0, 0}, {1, 1}, {2, 2}, {3, 3},
                                                                  {4, 4}, {5, 5}, {6, 6}, {7, 7}};
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 8> rhs(auto, const myriad::vec<R, 8>& s, const auto& p) {
        return {p[rate] * s[0], -s[1], -s[2], -s[3], -s[4], -s[5], -s[6], -s[7]};
    }
};

}  // namespace sparse
