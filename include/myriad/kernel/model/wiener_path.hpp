// SPDX-License-Identifier: MIT
// The paths of Wiener processes: functions of seed, instance, process and time, whatever the steps and the order of the
// work. Time is counted in cells of one length; a cell's increment is a normal number from a counter, and values within
// a cell follow from it by the Brownian bridge, halving by halving, each with a counter of its own. A place on the path
// is a pair of whole numbers, so that no rounding of t loses a cell or takes one twice.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/path_constants.hpp"
#include "myriad/kernel/scalar/lanes.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/normal_numbers.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A time of a path: a cell, and a part of it from 0 to `parts_of_cell` - 1.
template <class S>
struct path_place {
    typename path_integers<S>::cell cell;
    typename path_integers<S>::small part;
};

/// The place that lies a length further on. Lengths may be negative: -1 + 1/4 of a cell, for example.
template <class S>
MYRIAD_FUNCTION path_place<S> moved(const path_place<S>& from, const path_place<S>& by) {
    using small = typename path_integers<S>::small;
    using cell = typename path_integers<S>::cell;
    const small sum = from.part + by.part, all(parts_of_cell);
    const auto carries = sum >= all;
    return {from.cell + by.cell + select(carries, cell(1), cell(0)), select(carries, sum - all, sum)};
}

/// A length of time as a place counted from 0, for one lane: whole cells if it is that up to rounding, else to the
/// nearest part.
template <class R>
MYRIAD_FUNCTION path_place<R> place_of_length(R length, R cell) {
    const R ratio = length / cell;
    const R whole = floor(ratio + R(0.5));
    const R rest = fma(-whole, cell, length) / cell;
    constexpr R sliver = R(1e-6);  // as in the layout of fixed steps
    auto cells = static_cast<typename path_integers<R>::cell>(whole);
    if (abs(rest) <= sliver + R(4) * epsilon_of<R> * abs(ratio)) return {cells, 0};
    auto parts = static_cast<std::int32_t>(floor(fma(rest, R(parts_of_cell), R(0.5))));
    if (parts < 0) {
        parts += parts_of_cell;
        cells -= 1;
    }
    return {cells, parts};
}

template <class S>
MYRIAD_FUNCTION void set_place(path_place<S>& to, int i, const path_place<real_of<S>>& from) {
    set_lane(to.cell, i, from.cell);
    set_lane(to.part, i, from.part);
}
template <class S>
MYRIAD_FUNCTION path_place<real_of<S>> get_place(const path_place<S>& from, int i) {
    return {static_cast<typename path_integers<real_of<S>>::cell>(get_lane(from.cell, i)),
            static_cast<std::int32_t>(get_lane(from.part, i))};
}

/// What distinguishes the paths of instances: two words of their counters. `epoch` numbers the phases whose time begins
/// anew; of instances there may be 2^36, of such phases 2^28.
template <class S>
struct path_owner {
    typename path_integers<S>::word owner, epoch;

    MYRIAD_FUNCTION void set(int i, std::int64_t instance, std::int32_t phase) {
        const auto low = static_cast<std::uint32_t>(instance);
        const auto rest = static_cast<std::uint32_t>(phase) << 4 | static_cast<std::uint32_t>(instance >> 32 & 15);
        using lane = decltype(get_lane(owner, i));
        set_lane(owner, i, static_cast<lane>(low));
        set_lane(epoch, i, static_cast<lane>(rest));
    }
    /// Another path of lane i: words that follow from those before, and of which there are 2^64.
    MYRIAD_FUNCTION void begin_again(int i, const philox_keys& keys) {
        using R = real_of<S>;
        using lane = decltype(get_lane(owner, i));
        const path_owner<R> before = of_lane(i);
        std::uint32_t w[4] = {before.owner, before.epoch, 0, 0};
        detail::philox_of_words<R>(w, {keys.of_round[0][0] ^ 0xbb67ae85u, keys.of_round[0][1]});
        set_lane(owner, i, static_cast<lane>(w[0]));
        set_lane(epoch, i, static_cast<lane>(w[1]));
    }
    MYRIAD_FUNCTION path_owner<real_of<S>> of_lane(int i) const {
        return {static_cast<std::uint32_t>(get_lane(owner, i)), static_cast<std::uint32_t>(get_lane(epoch, i))};
    }
};

/// The part of a path over a step.
template <class S>
struct path_interval {
    path_place<S> from, to;
    path_owner<S> of;
    const path_constants<real_of<S>>* constants;
};

/// Increments of the processes of one group: as many as a block has normal numbers.
template <class S>
using group_increments = vec<S, normals_per_block<real_of<S>>>;

/// Normal numbers: of node 0 the increments over a cell of length one, of others the deviations at the middle of a part
/// of the cell from the mean of its ends.
template <class S>
MYRIAD_FUNCTION group_increments<S> path_normals(const typename path_integers<S>::cell& cell,
                                                 const typename path_integers<S>::small& node, const path_owner<S>& of,
                                                 const philox_keys& keys, int group) {
    return normals_of<S>::at({cell, node, group, of.owner, of.epoch}, keys);
}

/// W(place) less W at the beginning of its cell: the bridge over the cell, halved until the place is an end of a half.
/// Nodes are numbered as in a heap: node 1 is the middle of the cell, and 2 k and 2 k + 1 those of the halves of k.
template <class S>
MYRIAD_FUNCTION group_increments<S> within_cell(const path_place<S>& place, const path_owner<S>& of,
                                                const path_constants<real_of<S>>& constants, int group) {
    using R = real_of<S>;
    using small = typename path_integers<S>::small;
    constexpr int count = normals_per_block<R>;
    group_increments<S> left{}, right = detail::path_normals<S>(place.cell, small(0), of, constants.keys, group);
    MYRIAD_UNROLL
    for (int k = 0; k < count; ++k) right[k] = S(constants.root) * right[k];
    R deviation = R(0.5) * constants.root;  // of the middle of a part of a cell
    small rest = place.part, node(1);
    MYRIAD_ROLLED
    while (any(rest != small(0))) {
        const group_increments<S> z = detail::path_normals<S>(place.cell, node, of, constants.keys, group);
        const auto beyond = rest >= small(parts_of_cell / 2);
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) {
            const S middle = fma(S(deviation), z[k], S(R(0.5)) * (left[k] + right[k]));
            left[k] = select(beyond, middle, left[k]);
            right[k] = select(beyond, right[k], middle);
        }
        rest = select(beyond, rest - small(parts_of_cell / 2), rest);
        rest = rest + rest;
        node = node + node + select(beyond, small(1), small(0));
        deviation = deviation * R(0.70710678118654752);
    }
    return left;
}

/// W(to) - W(from) for any two places.
template <class S>
MYRIAD_CALLED_FUNCTION group_increments<S> increments_between(MYRIAD_CALL_ARGUMENT(path_interval<S>) over,
                                                              MYRIAD_CALL_ARGUMENT(int) group) {
    using R = real_of<S>;
    using cell_number = typename path_integers<S>::cell;
    using small = typename path_integers<S>::small;
    constexpr int count = normals_per_block<R>;
    const auto backwards = over.to.cell < over.from.cell;
    cell_number cell = select(backwards, over.to.cell, over.from.cell);
    const cell_number end = select(backwards, over.from.cell, over.to.cell);
    group_increments<S> sum{};
    MYRIAD_ROLLED
    while (any(cell < end)) {
        const group_increments<S> z = detail::path_normals<S>(cell, small(0), over.of, over.constants->keys, group);
        MYRIAD_UNROLL
        for (int k = 0; k < count; ++k) sum[k] = select(cell < end, sum[k] + S(over.constants->root) * z[k], sum[k]);
        cell = cell + cell_number(1);
    }
    group_increments<S> begun{}, ended{};
    if (any(over.from.part != small(0))) begun = detail::within_cell<S>(over.from, over.of, *over.constants, group);
    if (any(over.to.part != small(0))) ended = detail::within_cell<S>(over.to, over.of, *over.constants, group);
    MYRIAD_UNROLL
    for (int k = 0; k < count; ++k) sum[k] = select(backwards, -sum[k], sum[k]) + (ended[k] - begun[k]);
    return sum;
}

/// Whether a step is one whole cell, forwards, in all lanes: as it usually is.
template <class S>
MYRIAD_FUNCTION bool is_one_cell(const path_interval<S>& over) {
    using small = typename path_integers<S>::small;
    return all((over.from.part == small(0)) & (over.to.part == small(0)) &
               (over.to.cell == over.from.cell + typename path_integers<S>::cell(1)));
}

/// The increments of the processes of a group over a step, which is a `whole_cell` or not.
template <class S>
MYRIAD_FUNCTION group_increments<S> increments_of_group(const path_interval<S>& over, bool whole_cell, int group) {
    using small = typename path_integers<S>::small;
    group_increments<S> of_group;
    if (whole_cell) {
        of_group = detail::path_normals<S>(over.from.cell, small(0), over.of, over.constants->keys, group);
        MYRIAD_UNROLL
        for (int k = 0; k < normals_per_block<real_of<S>>; ++k) of_group[k] = S(over.constants->root) * of_group[k];
    } else {
        of_group = detail::increments_between<S>(over, group);
    }
    return of_group;
}

/// The increments of so many processes over a step. The same bits whichever way they are computed: lanes of a pack are
/// neighbours only.
template <int processes, class S>
MYRIAD_FUNCTION vec<S, processes> path_increments(const path_interval<S>& over) {
    constexpr int per_group = normals_per_block<real_of<S>>;
    const bool whole_cell = detail::is_one_cell(over);
    vec<S, processes> dw;
    static_for<0, (processes + per_group - 1) / per_group>([&](auto g) MYRIAD_LAMBDA {
        constexpr int group = decltype(g)::value;
        const group_increments<S> of_group = detail::increments_of_group(over, whole_cell, group);
        MYRIAD_UNROLL
        for (int k = 0; k < per_group; ++k)
            if (group * per_group + k < processes) dw[group * per_group + k] = of_group[k];
    });
    return dw;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
