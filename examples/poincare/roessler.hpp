// SPDX-License-Identifier: MIT
// Roessler's equations as a Myriad model, with a Poincare section of his attractor. O. E. Roessler, Phys. Lett. A 57
// (1976) 397-398; without units.
#pragma once

#include <myriad/model.hpp>

// snippet: model
/// x' = -y - z, y' = x + a y, z' = b + z (x - c). With `direction::falling` and `stop_after = 1` a phase ends where the
/// orbit returns to the half plane y = 0, x < 0.
struct roessler {
    enum state { x, y, z, n_state };
    enum parameter { c, n_parameter };
    enum shared { a, b, n_shared };
    enum event { section, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {-s[y] - s[z], s[x] + p.shared[a] * s[y], p.shared[b] + s[z] * (s[x] - p[c])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return myriad::vec<R, n_event>{s[y]};
    }
};
// end of snippet
