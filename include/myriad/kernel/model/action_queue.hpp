// SPDX-License-Identifier: MIT
// Actions that run later: a queue of bounded length per instance, in accessories of the model. Its next time is a stop
// time.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/random.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// Up to `capacity` actions that wait, each with a number, a time and `values` real numbers, in accessories of the
/// model: what `action_queue` does, for a `Layout` that says where they are.
template <class Layout>
struct basic_action_queue {
    static constexpr std::int64_t in_order = -1;             ///< actions that tie run in the order of `put`
    static constexpr int most_values = Layout::most_values;  ///< real numbers of an entry

    /// An action that was taken.
    template <class R>
    struct entry {
        int action;                 ///< its number, or -1: none is due
        vec<R, most_values> value;  ///< what was put with it
    };

    /// The time of the next action; infinity if none waits.
    template <class Inputs>
    static MYRIAD_FUNCTION auto next_time(const Inputs& p) {
        using R = std::remove_cvref_t<decltype(p.accessory[0])>;
        const Layout at{};
        R next = infinity_of<R>;
        MYRIAD_UNROLL_ON_GPU
        for (int i = 0; i < at.capacity; ++i)
            if (p.integer_accessory[at.first_integer + i] != 0 && p.accessory[at.first + i] < next)
                next = p.accessory[at.first + i];
        return next;
    }
    /// Puts an action, which runs at `time`, or now if that has passed. Times that differ by sixteen roundings or less
    /// are one, as rounding is not to decide which action comes first. Returns whether there was room.
    template <class Lane, class R, class Kept = std::remove_cvref_t<decltype(std::declval<Lane&>().accessory[0])>>
    static MYRIAD_FUNCTION bool put(Lane& lane, int action, const R& time, const vec<Kept, most_values>& value = {}) {
        using Real = std::remove_cvref_t<decltype(lane.t)>;
        const Layout at{};
        bool has_room = false;
        Real when = time > lane.t ? time : lane.t;
        const Real same = Real(16) * epsilon_of<Real> * max(abs(lane.t), abs(when));  // a sum, and what it was made of
        MYRIAD_UNROLL_ON_GPU
        for (int i = 0; i < at.capacity; ++i)
            if (lane.integer_accessory[at.first_integer + i] != 0 && abs(lane.accessory[at.first + i] - when) < same)
                when = lane.accessory[at.first + i];
        MYRIAD_UNROLL_ON_GPU
        for (int i = 0; i < at.capacity; ++i) {
            if (has_room || lane.integer_accessory[at.first_integer + i] != 0) continue;
            has_room = true;
            lane.integer_accessory[at.first_integer + i] = action + 1;
            lane.integer_accessory[at.first_integer + at.capacity + i] =
                lane.integer_accessory[at.first_integer + 2 * at.capacity]++;
            lane.accessory[at.first + i] = when;
            MYRIAD_UNROLL_ON_GPU
            for (int v = 0; v < at.values; ++v) lane.accessory[at.first + at.capacity * (1 + v) + i] = value[v];
        }
        return has_room;
    }
    /// Takes one of the actions that are due now: that with the largest `priority(action)` and, if several have it, by
    /// random numbers of the instance's own: the first word of Philox4x32-10 for the key `seed` and the counter (number
    /// of the put, 0, low and high word of `lane.index`), the smallest first. Or in the order in which they were put.
    template <class Lane, class Priority>
    static MYRIAD_FUNCTION auto take(Lane& lane, Priority&& priority, std::int64_t seed = in_order) {
        using R = std::remove_cvref_t<decltype(lane.t)>;
        const Layout at{};
        entry<R> taken{-1, {}};
        int slot = -1;
        auto highest = priority(0);
        std::uint32_t earliest = 0;
        MYRIAD_UNROLL_ON_GPU
        for (int i = 0; i < at.capacity; ++i) {
            const int action = static_cast<int>(lane.integer_accessory[at.first_integer + i]) - 1;
            if (action < 0 || !(lane.accessory[at.first + i] <= lane.t)) continue;
            const auto height = priority(action);
            const auto number = static_cast<std::uint32_t>(lane.integer_accessory[at.first_integer + at.capacity + i]);
            const std::uint32_t turn = seed == in_order ? number : random_turn(number, lane.index, seed);
            const bool comes_first = slot < 0 || height > highest || (height == highest && turn < earliest);
            if (!comes_first) continue;
            slot = i, highest = height, earliest = turn, taken.action = action;
        }
        MYRIAD_UNROLL_ON_GPU
        for (int i = 0; i < at.capacity; ++i) {
            if (i != slot) continue;
            lane.integer_accessory[at.first_integer + i] = 0;
            MYRIAD_UNROLL_ON_GPU
            for (int v = 0; v < at.values; ++v) taken.value[v] = lane.accessory[at.first + at.capacity * (1 + v) + i];
        }
        return taken;
    }
    /// The same without priorities.
    template <class Lane>
    static MYRIAD_FUNCTION auto take(Lane& lane) {
        return take(lane, [](int) MYRIAD_LAMBDA { return 0; });
    }
    /// Removes all that wait with that number: an action that must not outlast its condition.
    template <class Lane>
    static MYRIAD_FUNCTION void cancel(Lane& lane, int action) {
        const Layout at{};
        MYRIAD_UNROLL_ON_GPU
        for (int i = 0; i < at.capacity; ++i)
            if (lane.integer_accessory[at.first_integer + i] == action + 1)
                lane.integer_accessory[at.first_integer + i] = 0;
    }

private:
    static MYRIAD_FUNCTION std::uint32_t random_turn(std::uint32_t number, std::int64_t index, std::int64_t seed) {
        const auto bits = static_cast<std::uint64_t>(index);
        return philox_4x32_10(
            random_block{number, 0u, static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)},
            static_cast<std::uint64_t>(seed))[0];
    }
};

/// The places of an `action_queue`, which are known when the model is compiled.
template <int first_real, int first_whole, int length, int reals>
struct queue_layout {
    static constexpr int first = first_real;           ///< accessory with the first time
    static constexpr int first_integer = first_whole;  ///< integer accessory with the first action
    static constexpr int capacity = length;            ///< actions that may wait
    static constexpr int values = reals;               ///< real numbers that each has
    static constexpr int most_values = reals;          ///< the same, where a vector needs a constant
};

/// Up to `capacity` actions that wait, each with a number, a time and `values` real numbers, in `n_accessory`
/// accessories of the model from `first` on and `n_integer_accessory` integer ones from `first_integer` on, which must
/// be 0 at first. An action is put by a hook; `stop_time` returns `next_time`, and `after_stop` takes the action that
/// is due. Forwards in time only.
template <int first, int first_integer, int capacity, int values = 0>
struct action_queue : basic_action_queue<queue_layout<first, first_integer, capacity, values>> {
    static constexpr int n_accessory = capacity * (1 + values);   ///< accessories that the queue needs
    static constexpr int n_integer_accessory = 2 * capacity + 1;  ///< and integer accessories
};

}  // namespace myriad::inline MYRIAD_TARGET
