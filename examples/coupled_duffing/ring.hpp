// SPDX-License-Identifier: MIT
// A ring of Duffing oscillators, written for one of them.
#pragma once

#include <myriad/coupled_units.hpp>
#include <myriad/model.hpp>

// snippet: unit
/// x' = v + s (mean of the neighbours' x - x), v' = -c v + x - x^3 + B cos(omega t) + s (mean of the neighbours' v -
/// v): the equations of MPGOS's tutorial of coupled systems, "ring of Duffing oscillators". An event is a local maximum
/// of x.
struct oscillator {
    static constexpr bool accessories_are_outputs = true;
    enum unit_state { x, v, n_unit_state };
    enum shared { damping, amplitude, frequency, strength, n_shared };
    enum accessory { shortest_step, longest_step, n_accessory };  // of the ring
    enum unit_accessory { second_maximum, n_unit_accessory };     // of each oscillator
    enum unit_integer_accessory { maxima, n_unit_integer_accessory };
    enum unit_event { local_maximum, n_unit_event };
    enum publication { position, velocity, n_publication };
    enum { positions, velocities };
    static constexpr myriad::coupling couplings[] = {myriad::circulant_coupling(position, 1),
                                                     myriad::circulant_coupling(velocity, 1)};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_publication> publish(int, auto, const auto& y, const auto&) {
        return {y[x], y[v]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto t, const auto& y, const auto& p) {
        const R force = p.shared[amplitude] * myriad::cos(p.shared[frequency] * t);
        return {y[v] - p.shared[strength] * y[x] + y.coupled(positions),
                y[x] - y[x] * y[x] * y[x] - (p.shared[damping] + p.shared[strength]) * y[v] + force +
                    y.coupled(velocities)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_event> events(int, auto, const auto& y, const auto&) {
        return myriad::vec<R, n_unit_event>{y[v]};
    }
    MYRIAD_FUNCTION static void after_event(int, int, auto& lane) {
        lane.unit_integer_accessory[maxima] += 1;
        if (lane.unit_integer_accessory[maxima] == 2) lane.unit_accessory[second_maximum] = lane.y[x];
    }
    // end of snippet

    MYRIAD_FUNCTION static void initialise(int unit, auto& lane) {
        if (lane.phase > 0) return;  // counted from the start
        lane.unit_accessory[second_maximum] = lane.y[x];
        lane.unit_integer_accessory[maxima] = 0;
        if (unit > 0) return;
        lane.accessory[shortest_step] = 1e6;
        lane.accessory[longest_step] = 0;
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(int unit, auto& lane) {
        if (unit > 0) return;
        lane.accessory[shortest_step] = myriad::min(lane.accessory[shortest_step], lane.h);
        lane.accessory[longest_step] = myriad::max(lane.accessory[longest_step], lane.h);
    }
};
// snippet: ring
using ring = myriad::coupled_units<oscillator, 14>;
// end of snippet
