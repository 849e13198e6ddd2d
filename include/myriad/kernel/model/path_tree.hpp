// SPDX-License-Identifier: MIT
// Increments and integrals of a path over parts of a cell that its halving meets: halves, quarters and so on. One way
// down the tree gives them, without differences of numbers that belong to the whole cell; otherwise they are those of
// path_integral.hpp, up to rounding.
#pragma once

#include "myriad/kernel/model/path_integral.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The part of a path over a step. Its `length`, in parts of a cell, is a power of two if it begins at a multiple of
/// that, as a node of the tree does, and else 0.
template <class S>
struct tree_interval : path_interval<S> {
    typename path_integers<S>::small length;
};

/// Over a node, in the other lanes over their whole cell.
template <class S>
MYRIAD_CALLED_FUNCTION increments_with_integrals<S, normals_per_block<real_of<S>>> integrals_of_node(
    MYRIAD_CALL_ARGUMENT(tree_interval<S>) over, MYRIAD_CALL_ARGUMENT(int) group) {
    using R = real_of<S>;
    using small = typename path_integers<S>::small;
    constexpr int count = normals_per_block<R>;
    const auto back_in_cell = (over.to.cell == over.from.cell) & (over.to.part < over.from.part);
    const auto backwards = (over.to.cell < over.from.cell) | back_in_cell;
    const typename path_integers<S>::cell cell = select(backwards, over.to.cell, over.from.cell);
    const small wanted = select(over.length == small(0), small(parts_of_cell), over.length);
    small rest = select(backwards, over.to.part, over.from.part), node(1);
    group_increments<S> w, h;
    detail::draw_cell<S>(cell, over.of, *over.constants, group, w, h);
    S length = S(over.constants->cell);
    R root = over.constants->root;
    MYRIAD_ROLLED
    for (std::int32_t size = parts_of_cell; any(wanted < small(size)); size /= 2) {
        const auto open = wanted < small(size);
        const auto beyond = rest >= small(parts_of_cell / 2);
        group_increments<S> z = detail::path_normals<S>(cell, node, over.of, over.constants->keys, group);
        group_increments<S> n =
            detail::path_normals<S>(cell, node, over.of, over.constants->keys, group + groups_of_increments);
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) {
            z[k] = S(R(0.25) * root) * z[k];
            n[k] = S(R(0.14433756729740644) * root) * n[k];  // as in `piece_up_to`
            const S middle = fma(S(R(1.5)), h[k], z[k]), bend = fma(S(R(0.25)), h[k], S(R(-0.5)) * z[k]);
            w[k] = select(open, fma(S(R(0.5)), w[k], select(beyond, -middle, middle)), w[k]);
            h[k] = select(open, bend + select(beyond, -n[k], n[k]), h[k]);
        }
        length = select(open, S(R(0.5)) * length, length);
        root = R(0.70710678118654752) * root;
        rest = select(beyond, rest - small(parts_of_cell / 2), rest);
        rest = rest + rest;
        node = node + node + select(beyond, small(1), small(0));
    }
    increments_with_integrals<S, count> found;
    MYRIAD_UNROLL
    for (int k = 0; k < count; ++k) {
        found.increment[k] = select(backwards, -w[k], w[k]);
        found.integral[k] = length * fma(S(R(0.5)), w[k], select(backwards, -h[k], h[k]));
    }
    return found;
}

/// Over a step, of which lanes are nodes or not.
template <class S>
MYRIAD_FUNCTION increments_with_integrals<S, normals_per_block<real_of<S>>> tree_integrals_of_group(
    const tree_interval<S>& over, const mask_of<S>& is_node, int group) {
    constexpr int per_group = normals_per_block<real_of<S>>;
    increments_with_integrals<S, per_group> of_group{};
    if (any(is_node)) of_group = detail::integrals_of_node<S>(over, group);
    if (MYRIAD_UNLIKELY(!all(is_node))) {
        const increments_with_integrals<S, per_group> other = detail::integrals_between<S>(over, group);
        MYRIAD_UNROLL
        for (int k = 0; k < per_group; ++k) {
            of_group.increment[k] = select(is_node, of_group.increment[k], other.increment[k]);
            of_group.integral[k] = select(is_node, of_group.integral[k], other.integral[k]);
        }
    }
    return of_group;
}

/// `path_integrals` over steps most of which are nodes. The same bits whatever the steps of neighbours are.
template <int processes, class S>
MYRIAD_FUNCTION increments_with_integrals<S, processes> tree_integrals(const tree_interval<S>& over) {
    using small = typename path_integers<S>::small;
    constexpr int per_group = normals_per_block<real_of<S>>;
    const mask_of<S> is_node = over.length != small(0);
    increments_with_integrals<S, processes> all_of;
    static_for<0, (processes + per_group - 1) / per_group>([&](auto g) MYRIAD_LAMBDA {
        constexpr int group = decltype(g)::value;
        const auto of_group = detail::tree_integrals_of_group(over, is_node, group);
        MYRIAD_UNROLL
        for (int k = 0; k < per_group; ++k) {
            if (group * per_group + k >= processes) continue;
            all_of.increment[group * per_group + k] = of_group.increment[k];
            all_of.integral[group * per_group + k] = of_group.integral[k];
        }
    });
    return all_of;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
