// SPDX-License-Identifier: MIT
// Models whose quantities have extrema and integrals in closed form.
#pragma once

#include <myriad/model.hpp>

#include "myriad/kernel/model/tangent.hpp"
#include "tests/support/problems.hpp"

namespace summarised {

using to = myriad::over_phase;

/// x'' = -x: sin(t + phase) and its square.
using plain_swing = problems::oscillator;
struct swing : plain_swing {
    static constexpr bool accessories_are_outputs = true;
    enum accessory { x_max, t_max, x_min, t_min, square, n_accessory };
    enum observed { position, power, n_observed };
    static constexpr myriad::summary summaries[] = {{position, to::maximum, x_max},
                                                    {position, to::time_of_maximum, t_max},
                                                    {position, to::minimum, x_min},
                                                    {position, to::time_of_minimum, t_min},
                                                    {power, to::integral, square}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[x], y[x] * y[x]};
    }
};
/// The same with the maximum alone.
struct peak_of_swing : plain_swing {
    static constexpr bool accessories_are_outputs = true;
    enum accessory { x_max, n_accessory };
    enum observed { position, n_observed };
    static constexpr myriad::summary summaries[] = {{position, to::maximum, x_max}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_observed>{y[x]};
    }
};
/// Quantities that depend only on time, next to a state that lets the steps grow: with one extremum, two in one step,
/// NaN, none at all.
struct timed {
    static constexpr bool accessories_are_outputs = true;
    enum state { y0, n_state };
    enum shared { from, n_shared };
    enum accessory {
        hill_max,
        hill_at,
        wave_max,
        wave_min,
        log_max,
        log_integral,
        level_max,
        level_at,
        slope_max,
        fifth,
        n_accessory
    };
    enum observed { hill, wave, logarithm, level, line, power, n_observed };
    static constexpr myriad::summary summaries[] = {
        {hill, to::maximum, hill_max},     {hill, to::time_of_maximum, hill_at},
        {wave, to::maximum, wave_max},     {wave, to::minimum, wave_min},
        {logarithm, to::maximum, log_max}, {logarithm, to::integral, log_integral},
        {level, to::maximum, level_max},   {level, to::time_of_maximum, level_at},
        {line, to::maximum, slope_max},    {power, to::integral, fifth}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto&) {
        return myriad::vec<R, n_state>{R(0)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        const R s = R(t) - p.shared[from];
        return {R(1) - (s - R(0.3)) * (s - R(0.3)),
                ((s / R(3) - R(0.4)) * s + R(0.0975)) * s + R(0) * y[y0],  // turns at 0.15 and 0.65
                myriad::log(R(2.5) - s),
                R(3) + R(0) * y[y0],
                s,
                s * s * s * s * s};
    }
};
/// A ball thrown up that bounces; at each impact the ground lifts it by a given distance and keeps part of its speed.
struct ball {
    enum state { x, v, n_state };
    enum shared { lift, kept, n_shared };
    enum accessory { height, height_at, lowest, fastest, n_accessory };
    enum event { impact, n_event };
    enum observed { position, speed, n_observed };
    static constexpr myriad::summary summaries[] = {{position, to::maximum, height},
                                                    {position, to::time_of_maximum, height_at},
                                                    {position, to::minimum, lowest},
                                                    {speed, to::maximum, fastest}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], R(-1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[x], R(myriad::abs(y[v]))};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.y[x] = lane.shared[lift];
        lane.y[v] = -lane.shared[kept] * lane.y[v];
    }
};
/// Slowed by its largest speed so far: rhs reads the result of a summary, as accessories are not outputs here.
struct remembering {
    enum state { x, n_state };
    enum accessory { largest, n_accessory };
    enum observed { position, n_observed };
    static constexpr myriad::summary summaries[] = {{position, to::maximum, largest}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{R(1) + p.accessory[largest]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_observed>{y[x]};
    }
};
/// The same with a hook.
struct remembering_by_hook {
    enum state { x, n_state };
    enum accessory { largest, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{R(1) + p.accessory[largest]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[largest] = lane.y[x]; }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[largest] = myriad::max(lane.accessory[largest], lane.y[x]);
    }
};

/// A decay, x' = -x, whose hook halves x after each step that leaves it above one.
struct halved {
    static constexpr bool accessories_are_outputs = true;
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (lane.y[x] > 1) lane.y[x] /= 2;
    }
};
/// The same with its integral.
struct halved_and_summed : halved {
    enum accessory { area, n_accessory };
    enum observed { position, n_observed };
    static constexpr myriad::summary summaries[] = {{position, to::integral, area}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_observed>{y[x]};
    }
};

using swing_with_tangents = myriad::with_tangents<swing, 2>;

}  // namespace summarised
