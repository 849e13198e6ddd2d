// SPDX-License-Identifier: MIT
// Integrals over time of the paths of Wiener processes, from the same counters, for methods of strong order 3/2. A part
// of a path of length l has its increment W and H, with which the integral of W(s) - W(0) over it is l (W / 2 + H);
// they are independent, with variances l and l / 12. Both are halved together: Foster, Oberhauser and Lyons, SIAM J.
// Numer. Anal. 58 (2020) 1393-1421.
#pragma once

#include "myriad/kernel/model/wiener_path.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Increments of processes and the integrals of what they are along the way.
template <class S, int processes>
struct increments_with_integrals {
    vec<S, processes> increment, integral;
};

/// A path from some time on: how long, and what the processes of a group and their integrals are at its end.
template <class S>
struct path_piece {
    S length;
    group_increments<S> w, integral;

    /// Another part follows, of length l with W and H.
    MYRIAD_FUNCTION void append(const mask_of<S>& where, const S& l, const group_increments<S>& w_of,
                                const group_increments<S>& h_of) {
        using R = real_of<S>;
        MYRIAD_UNROLL
        for (int k = 0; k < normals_per_block<R>; ++k) {
            const S mean = w[k] + fma(S(R(0.5)), w_of[k], h_of[k]);
            integral[k] = select(where, fma(l, mean, integral[k]), integral[k]);
            w[k] = select(where, w[k] + w_of[k], w[k]);
        }
        length = select(where, length + l, length);
    }
};

/// W and H over a whole cell. W is that of `path_increments`.
template <class S>
MYRIAD_FUNCTION void draw_cell(const typename path_integers<S>::cell& cell, const path_owner<S>& of,
                               const path_constants<real_of<S>>& constants, int group, group_increments<S>& w,
                               group_increments<S>& h) {
    using R = real_of<S>;
    using small = typename path_integers<S>::small;
    constexpr R root_of_twelfth = R(0.28867513459481288);
    w = detail::path_normals<S>(cell, small(0), of, constants.keys, group);
    h = detail::path_normals<S>(cell, small(0), of, constants.keys, group + groups_of_increments);
    const S of_w(constants.root), of_h(constants.root * root_of_twelfth);
    MYRIAD_UNROLL
    for (int k = 0; k < normals_per_block<R>; ++k) {
        w[k] = of_w * w[k];
        h[k] = of_h * h[k];
    }
}

/// The path from the beginning of a cell to a place in a later one, or in the same.
template <class S>
MYRIAD_FUNCTION path_piece<S> piece_up_to(typename path_integers<S>::cell cell, const path_place<S>& end,
                                          const path_owner<S>& of, const path_constants<real_of<S>>& constants,
                                          int group) {
    using R = real_of<S>;
    using small = typename path_integers<S>::small;
    using cell_number = typename path_integers<S>::cell;
    constexpr int count = normals_per_block<R>;
    path_piece<S> piece{S(R(0)), {}, {}};
    group_increments<S> w, h;
    MYRIAD_ROLLED
    while (any(cell < end.cell)) {
        detail::draw_cell<S>(cell, of, constants, group, w, h);
        piece.append(cell < end.cell, S(constants.cell), w, h);
        cell = cell + cell_number(1);
    }
    small rest = end.part, node(1);
    if (!any(rest != small(0))) return piece;
    detail::draw_cell<S>(end.cell, of, constants, group, w, h);
    R length = constants.cell, root = constants.root;
    MYRIAD_ROLLED
    while (any(rest != small(0))) {
        group_increments<S> first_w, first_h;
        group_increments<S> z = detail::path_normals<S>(end.cell, node, of, constants.keys, group);
        group_increments<S> n =
            detail::path_normals<S>(end.cell, node, of, constants.keys, group + groups_of_increments);
        const auto beyond = rest >= small(parts_of_cell / 2);
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) {
            z[k] = S(R(0.25) * root) * z[k];
            n[k] = S(R(0.14433756729740644) * root) * n[k];  // half of the root of 1 / 12
            const S middle = fma(S(R(1.5)), h[k], z[k]), bend = fma(S(R(0.25)), h[k], S(R(-0.5)) * z[k]);
            first_w[k] = fma(S(R(0.5)), w[k], middle);
            first_h[k] = bend + n[k];
            w[k] = select(beyond, fma(S(R(0.5)), w[k], -middle), first_w[k]);
            h[k] = select(beyond, bend - n[k], first_h[k]);
        }
        length = R(0.5) * length;
        root = R(0.70710678118654752) * root;
        piece.append(beyond, S(length), first_w, first_h);
        rest = select(beyond, rest - small(parts_of_cell / 2), rest);
        rest = rest + rest;
        node = node + node + select(beyond, small(1), small(0));
    }
    return piece;
}

/// For any two places.
template <class S>
MYRIAD_CALLED_FUNCTION increments_with_integrals<S, normals_per_block<real_of<S>>> integrals_between(
    MYRIAD_CALL_ARGUMENT(path_interval<S>) over, MYRIAD_CALL_ARGUMENT(int) group) {
    using R = real_of<S>;
    const auto first = select(over.to.cell < over.from.cell, over.to.cell, over.from.cell);
    const path_piece<S> begun = detail::piece_up_to<S>(first, over.from, over.of, *over.constants, group);
    const path_piece<S> ended = detail::piece_up_to<S>(first, over.to, over.of, *over.constants, group);
    increments_with_integrals<S, normals_per_block<R>> found;
    MYRIAD_UNROLL
    for (int k = 0; k < normals_per_block<R>; ++k) {
        found.increment[k] = ended.w[k] - begun.w[k];
        found.integral[k] = fma(begun.length - ended.length, begun.w[k], ended.integral[k] - begun.integral[k]);
    }
    return found;
}

/// The same for a step, which is a `whole_cell` or not.
template <class S>
MYRIAD_FUNCTION increments_with_integrals<S, normals_per_block<real_of<S>>> integrals_of_group(
    const path_interval<S>& over, bool whole_cell, int group) {
    using R = real_of<S>;
    constexpr int per_group = normals_per_block<R>;
    increments_with_integrals<S, per_group> of_group;
    if (whole_cell) {
        group_increments<S> h;
        detail::draw_cell<S>(over.from.cell, over.of, *over.constants, group, of_group.increment, h);
        MYRIAD_UNROLL
        for (int k = 0; k < per_group; ++k)
            of_group.integral[k] = S(over.constants->cell) * fma(S(R(0.5)), of_group.increment[k], h[k]);
    } else {
        of_group = detail::integrals_between<S>(over, group);
    }
    return of_group;
}

/// The increments of so many processes over a step, and the integrals of W(s) - W(from) over it. At the ends of cells
/// the path is that of `path_increments`; within one it is another.
template <int processes, class S>
MYRIAD_FUNCTION increments_with_integrals<S, processes> path_integrals(const path_interval<S>& over) {
    constexpr int per_group = normals_per_block<real_of<S>>;
    const bool whole_cell = detail::is_one_cell(over);
    increments_with_integrals<S, processes> all;
    static_for<0, (processes + per_group - 1) / per_group>([&](auto g) MYRIAD_LAMBDA {
        constexpr int group = decltype(g)::value;
        const auto of_group = detail::integrals_of_group(over, whole_cell, group);
        MYRIAD_UNROLL
        for (int k = 0; k < per_group; ++k) {
            if (group * per_group + k >= processes) continue;
            all.increment[group * per_group + k] = of_group.increment[k];
            all.integral[group * per_group + k] = of_group.integral[k];
        }
    });
    return all;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
