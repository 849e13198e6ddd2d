// SPDX-License-Identifier: MIT
// Finds phases that would never end by themselves. Each is checked at intervals, so that a step costs one comparison.
#pragma once

#include <cstdint>

#include "myriad/kernel/controller/stepping.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct phase_watchdog {
    using R = real_of<S>;
    using stepping_type = stepping<Model, Method, S>;
    using iteration_number = typename integration_state<Model, Method, S>::iteration_number;
    static constexpr std::int32_t stagnation_interval = stepping_type::stagnation_interval;
    /// The most iterations without a check, so that a call can end; a power of two.
    static constexpr std::int32_t longest_unchecked = 1 << 14;
    static constexpr std::int32_t check_interval = stagnation_interval > 0 ? stagnation_interval : longest_unchecked;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;

    /// Whether a phase has reached its limit of iterations, or is due for the check whether it stagnates.
    MYRIAD_FUNCTION bool is_due() const {
        if constexpr (is_pack<S>) {
            return s.iteration >= s.next_check;
        } else {
            return s.iteration % check_interval == 0;  // at zero, the limit, too
        }
    }
    /// Calls `end(why)` if the phase of lane i has reached the limit of trial steps or stagnates.
    template <class End>
    MYRIAD_FUNCTION void check(int i, End&& end) {
        const auto* arguments = &args;
        MYRIAD_OPTIMISATION_BARRIER(arguments);  // else the values it points to occupy registers through the loop
        const iteration_number iterations = s.iterations_of(*arguments, i), left = arguments->max_steps - iterations;
        if (left <= 0) end(status::max_steps);
        if constexpr (stagnation_interval > 0) {
            if (iterations == 0 || left % stagnation_interval != 0) return;
            const bool stagnates = stepping_type{*arguments, s}.stagnates(i);
            if (stagnates && iterations >= stagnation_interval) end(status::not_finite);
        }
    }
    /// Whether the host asks for all instances to end as they are, after so many iterations more than those counted.
    template <class Source>
    MYRIAD_FUNCTION bool gives_up(Source& source, iteration_number taken = 0) const {
        if constexpr (requires { source.gives_up(std::int64_t{}); }) {
            return source.gives_up(s.all_iterations_of(args) + taken);
        } else if constexpr (requires { source.gives_up(); }) {
            return source.gives_up();
        } else {
            return false;
        }
    }
    /// Sets when a pack checks next: when the first of its phases is due. A single instance needs no such counter.
    MYRIAD_FUNCTION void schedule() {
        if constexpr (is_pack<S>) {
            s.next_check = s.iteration + (args.max_steps < longest_unchecked ? args.max_steps : longest_unchecked);
            for_each_lane(s.active, [&](int i) MYRIAD_LAMBDA {
                const iteration_number next = s.iteration + left_after(s.iterations_of(args, i));
                s.next_check = next < s.next_check ? next : s.next_check;
            });
        }
    }
    /// Iterations before the next check.
    MYRIAD_FUNCTION iteration_number iterations_left() const {
        if constexpr (is_pack<S>) {
            return s.next_check - s.iteration;
        } else {
            return left_after(s.iterations_of(args, 0));
        }
    }

private:
    /// Iterations until the next check of a phase that has taken so many.
    MYRIAD_FUNCTION iteration_number left_after(iteration_number iterations) const {
        const iteration_number left = args.max_steps - iterations, next = left % check_interval;
        if constexpr (stagnation_interval == 0 && !is_pack<S>) return left;  // a free run asks by itself
        return next > 0 ? next : left < check_interval ? left : check_interval;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
