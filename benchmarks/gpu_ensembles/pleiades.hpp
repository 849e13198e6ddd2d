// SPDX-License-Identifier: MIT
// The models of the case pleiades, seven stars in a plane (Hairer, Norsett, Wanner, Solving ODE I, II.10), the first of
// mass m1, the others of masses 2 to 7: written as a whole, and as units.
#pragma once

#include <myriad/coupled_units.hpp>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

namespace gpu_ensembles {

struct star {
    enum unit_state { x, y, u, v, n_unit_state };
    enum parameter { m1, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& s, const auto& p) {
        R ax = R(0), ay = R(0);
        // No branches, so that the stars' terms overlap: a star adds nothing to itself, as dx and dy are zero.
        MYRIAD_UNROLL
        for (int other = 0; other < s.units; ++other) {
            const auto from = s.of(other);
            const R mass = other == 0 ? R(p[m1]) : R(other + 1), itself = R(other == unit ? 1 : 0);
            const R dx = from[x] - s[x], dy = from[y] - s[y];
            const R inverse = myriad::rsqrt(dx * dx + dy * dy + itself);
            const R strength = mass * inverse * inverse * inverse;
            ax = myriad::fma(strength, dx, ax);
            ay = myriad::fma(strength, dy, ay);
        }
        return {s[u], s[v], ax, ay};
    }
};
inline constexpr int stars = 7;
using pleiades_units = myriad::coupled_units<star, stars>;

/// The same states in the same order, as one model, which has each pair of stars once.
struct pleiades {
    static constexpr int n_state = pleiades_units::n_state;
    enum parameter { m1, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        constexpr int x = star::x, y = star::y, u = star::u, v = star::v, size = star::n_unit_state;
        myriad::vec<R, n_state> slopes;
        MYRIAD_UNROLL
        for (int i = 0; i < stars; ++i) {
            slopes[i * size + x] = s[i * size + u];
            slopes[i * size + y] = s[i * size + v];
            slopes[i * size + u] = slopes[i * size + v] = R(0);
        }
        const auto mass = [&](int i) MYRIAD_LAMBDA { return i == 0 ? R(p[m1]) : R(i + 1); };
        MYRIAD_UNROLL
        for (int i = 0; i < stars; ++i) {
            MYRIAD_UNROLL
            for (int j = i + 1; j < stars; ++j) {
                const R dx = s[j * size + x] - s[i * size + x], dy = s[j * size + y] - s[i * size + y];
                const R inverse = myriad::rsqrt(dx * dx + dy * dy), strength = inverse * inverse * inverse;
                const R ax = strength * dx, ay = strength * dy;
                slopes[i * size + u] = myriad::fma(mass(j), ax, slopes[i * size + u]);
                slopes[i * size + v] = myriad::fma(mass(j), ay, slopes[i * size + v]);
                slopes[j * size + u] = myriad::fma(-mass(i), ax, slopes[j * size + u]);
                slopes[j * size + v] = myriad::fma(-mass(i), ay, slopes[j * size + v]);
            }
        }
        return slopes;
    }
};

}  // namespace gpu_ensembles
