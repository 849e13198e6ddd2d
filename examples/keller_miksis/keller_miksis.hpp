// SPDX-License-Identifier: MIT
// The Keller-Miksis bubble: the radius of a gas bubble in water under sound of one or two frequencies, and the results
// that the two programs here keep. constants.hpp has the sources.
#pragma once

#include <myriad/model.hpp>

// snippet: model
/// The radius y, relative to that at rest, and its slope v, over time in periods of the first wave.
struct keller_miksis {
    enum state { y, v, n_state };
    enum parameter { C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& u, const auto& p) {
        using myriad::powr, myriad::reciprocal, myriad::sincospi;
        const auto first = sincospi(R(R(2) * t)), second = sincospi(R(R(2) * p[C11] * t + p[C12]));
        const R inverse = reciprocal(u[y]), power = powr(u[y], -p[C10]), mach = p[C9] * u[v];
        const R numerator = (p[C0] + p[C1] * u[v]) * power - p[C2] * (R(1) + mach) - p[C3] * inverse -
                            p[C4] * u[v] * inverse - (R(1.5) - R(0.5) * mach) * u[v] * u[v] -
                            (p[C5] * first.sine + p[C6] * second.sine) * (R(1) + mach) -
                            u[y] * (p[C7] * first.cosine + p[C8] * second.cosine);
        const R denominator = u[y] - mach * u[y] + p[C4] * p[C9];
        return {u[v], numerator * reciprocal(denominator)};
    }
};
// end of snippet

/// Phases of one period each: the largest radius, and the number of its maxima.
struct bubble_response : keller_miksis {
    enum accessory { y_max, n_accessory };
    enum integer_accessory { maxima, n_integer_accessory };
    enum event { maximum, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& u, const auto&) {
        return myriad::vec<R, n_event>{u[v]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[y_max] = lane.y[y];
        lane.integer_accessory[maxima] = 0;
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.accessory[y_max] = myriad::max(lane.accessory[y_max], lane.y[y]);
        lane.integer_accessory[maxima] += 1;
    }
};

// snippet: dual
/// Phases from one maximum of the radius to the next, with `stop_after = 1` for the event `maximum`. From phase
/// `transient_phases` on: the largest radius, the strongest collapse with its duration, and maxima per unit of time.
struct bubble_dual_frequency : keller_miksis {
    enum shared_integer { transient_phases, n_shared_integer };
    enum accessory { y_max, t_max, y_min, t_min, largest, compression, collapse_time, t_first, winding, n_accessory };
    enum event { maximum, minimum, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& u, const auto&) {
        return {u[v], u[v]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[y_max] = lane.accessory[y_min] = lane.y[y];
        lane.accessory[t_max] = lane.accessory[t_min] = lane.t;
        if (lane.phase != lane.shared_integer[transient_phases]) return;
        lane.accessory[t_first] = lane.t;
        lane.accessory[largest] = lane.y[y];
        lane.accessory[compression] = 0;
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event != minimum) return;
        lane.accessory[y_min] = lane.y[y];
        lane.accessory[t_min] = lane.t;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        const auto recorded = lane.phase - lane.shared_integer[transient_phases] + 1;
        if (recorded < 1) return;
        lane.accessory[largest] = myriad::max(lane.accessory[largest], lane.y[y]);
        const auto ratio = lane.accessory[y_max] / lane.accessory[y_min];
        if (ratio > lane.accessory[compression]) {
            lane.accessory[compression] = ratio;
            lane.accessory[collapse_time] = lane.accessory[t_min] - lane.accessory[t_max];
        }
        lane.accessory[winding] = static_cast<double>(recorded) / (lane.t - lane.accessory[t_first]);
    }
};
// end of snippet
