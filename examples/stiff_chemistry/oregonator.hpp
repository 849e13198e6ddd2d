// SPDX-License-Identifier: MIT
// The Oregonator of Field and Noyes, J. Chem. Phys. 60 (1974) 1877-1884, as a Myriad model, in the scaled form of
// Tyson, in: Oscillations and Traveling Waves in Chemical Systems, Wiley (1985) 93-144.
#pragma once

#include <myriad/model.hpp>

// snippet: model
/// Bromous acid x, bromide y and the oxidised catalyst z of the Belousov-Zhabotinsky reaction, all scaled; time in
/// units of the decay of z. A phase ends where z has its maximum (event `maximum`, with `stop_after = 1`).
struct oregonator {
    enum state { x, y, z, n_state };
    enum parameter { f, epsilon, n_parameter };  // stoichiometric factor; slowness of x
    enum shared { q, ratio, n_shared };          // ratio: slowness of y over that of x
    enum accessory { z_least, n_accessory };
    enum event { maximum, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& c, const auto& p) {
        return {(p.shared[q] * c[y] - c[x] * c[y] + c[x] * (R(1) - c[x])) / p[epsilon],
                (p[f] * c[z] - p.shared[q] * c[y] - c[x] * c[y]) / (p.shared[ratio] * p[epsilon]), c[x] - c[z]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& c, const auto&) {
        return myriad::vec<R, n_event>{c[x] - c[z]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[z_least] = lane.y[z]; }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[z_least] = myriad::min(lane.accessory[z_least], lane.y[z]);
    }
};
// end of snippet
