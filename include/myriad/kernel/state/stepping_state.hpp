// SPDX-License-Identifier: MIT
// What adaptive and fixed steps keep between trials. The stepping of a method (controller/stepping.hpp) owns it:
// nothing else writes it.
#pragma once

#include <type_traits>

#include "myriad/kernel/methods/controller_policies.hpp"
#include "myriad/kernel/methods/stochastic_method.hpp"
#include "myriad/kernel/model/path_tree.hpp"
#include "myriad/kernel/scalar/control_number.hpp"
#include "myriad/kernel/scalar/lanes.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// True for methods with an error estimate, which control the step size.
template <class Method>
inline constexpr bool is_adaptive = Method::embedded_order > 0;

/// Binary logarithms of error / tolerance of the last accepted step and of the one before, for controllers with memory.
template <class Method, class S, bool remembers = remembers_errors<Method>>
struct control_memory {};
template <class Method, class S>
struct control_memory<Method, S, true> {
    control_of<S> last, before;
};

/// What step-size control remembers of earlier trials, and of the instance.
template <class Method, class S>
struct adaptive_state {
    S time_low;                        // the rounding error of t, where keeps_time_low
    mask_of<S> last_not_finite;        // the lane's last rejection was due to a value that is not finite
    mask_of<S> last_singular;          // and that value to a singular matrix, if the method solves linear systems
    control_memory<Method, S> errors;  // of earlier steps
    S tolerance_scale;                 // of the instance, if the method has one
};

/// The position of fixed steps: t = base + done * step, so that rounding neither accumulates nor adds a step.
template <class S>
struct fixed_state {
    S time_low;  // the rounding error of `base`, where keeps_time_low
    S base, step;
    count_of<S> done, left;

    MYRIAD_FUNCTION S time() const { return fma(S(done), step, base); }
};

/// The same of a stochastic equation, with the part of the path that the next step covers.
template <class S>
struct fixed_state_on_path : fixed_state<S> {
    path_place<S> from, to, per_step;  // the length of a step, with its sign
    path_owner<S> path;

    /// A lane without an instance stays where it is.
    MYRIAD_FUNCTION void clear_path() {
        using integers = path_integers<S>;
        from = to = per_step = {typename integers::cell(0), typename integers::small(0)};
        path = {typename integers::word(0), typename integers::word(0)};
    }
    /// An event has ended a step within a cell of lane i's path, which goes on with another: what a Wiener process does
    /// after a time that it has itself decided is independent of what it did before.
    MYRIAD_FUNCTION void begin_again(int i, const path_constants<real_of<S>>& constants) {
        detail::set_place(from, i, path_place<real_of<S>>{0, 0});
        path.begin_again(i, constants.keys);
    }
    /// `interval` of lane i.
    MYRIAD_FUNCTION void set_interval(path_interval<real_of<S>>& to_one, int i,
                                      const path_constants<real_of<S>>& constants) const {
        to_one = {detail::get_place(from, i), detail::get_place(to, i), path.of_lane(i), &constants};
    }
    MYRIAD_FUNCTION path_interval<S> interval(const path_constants<real_of<S>>& constants) const {
        return {from, to, path, &constants};
    }
};

/// Adaptive steps of a stochastic equation. They end at multiples of `step`, which is a cell of the path or a half, a
/// quarter and so on of one, and at stops.
template <class Method, class S>
struct adaptive_state_on_path {
    using integers = path_integers<S>;
    S base;                          // the time at which the path begins
    S step, end;                     // with its sign; the time at which the trial ends
    path_place<S> from, to;          // of the trial
    path_place<S> per_step;          // the step as a place
    typename integers::small parts;  // of a cell in a step
    typename integers::small node;   // the same if the trial is over a node of the tree, else 0
    path_owner<S> path;
    mask_of<S> between;          // `from` is no multiple of the step
    mask_of<S> last_not_finite;  // as in `adaptive_state`
    S tolerance_scale;

    /// A lane without an instance stays where it is.
    MYRIAD_FUNCTION void clear_path() {
        from = to = per_step = {typename integers::cell(0), typename integers::small(0)};
        parts = node = typename integers::small(parts_of_cell);
        path = {typename integers::word(0), typename integers::word(0)};
        between = last_not_finite = mask_of<S>(false);
        base = step = end = S(real_of<S>(0));
    }
    MYRIAD_FUNCTION tree_interval<S> interval(const path_constants<real_of<S>>& constants) const {
        return {{from, to, path, &constants}, node};
    }
};

template <class Method, class S>
using adaptive_state_of =
    std::conditional_t<stochastic_method<Method>, adaptive_state_on_path<Method, S>, adaptive_state<Method, S>>;
template <class Method, class S>
using fixed_state_of = std::conditional_t<stochastic_method<Method>, fixed_state_on_path<S>, fixed_state<S>>;
template <class Method, class S>
using stepping_state = std::conditional_t<is_adaptive<Method>, adaptive_state_of<Method, S>, fixed_state_of<Method, S>>;

}  // namespace myriad::detail::inline MYRIAD_TARGET
