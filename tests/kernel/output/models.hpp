// SPDX-License-Identifier: MIT
// Models for the tests of dense output: one with an exact solution, one with jumps, one that moves its own time domain.
#pragma once

#include <myriad/host/backend/backend.hpp>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "tests/support/problems.hpp"

namespace output {

using curve = problems::timed_circle;

/// x'' = -g above the ground, where v becomes -r v. Methods of order two and more follow the parabolas exactly.
struct bouncing {
    enum state { x, v, n_state };
    enum parameter { g, r, n_parameter };
    enum event { impact, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], -p[g]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.y[v] = -lane.parameter[r] * lane.y[v]; }
};

/// x' = 1, with a hook that moves the end of the phase once t has reached a time.
struct retargeted {
    static constexpr bool writes_time_domain = true;
    enum state { x, n_state };
    enum parameter { when, new_end, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::vec<R, n_state>{R(1)};
    }
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (lane.t >= lane.parameter[when]) lane.t_end = lane.parameter[new_end];
    }
};

/// Like the backend, but one instance at a time.
template <class Model, class Method>
myriad::detail::run_statistics run_one_lane(const myriad::detail::any_arguments<double>& arguments,
                                            const myriad::detail::run_options& options);

}  // namespace output
