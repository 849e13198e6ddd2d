// SPDX-License-Identifier: MIT
// A cluster of gas bubbles in water under sound, written for one bubble. The Keller-Miksis equation and its constants
// are those of examples/keller_miksis; bubbles are coupled by the pressure that each radiates, without delay, as in
// MPGOS's tutorial of coupled systems, "bubble ensemble".
#pragma once

#include <myriad/coupled_units.hpp>
#include <myriad/model.hpp>

// snippet: model
/// The radius y, relative to that at rest, and its slope v, over time in periods of the sound. With f = v' without the
/// others, v'_i = f_i - 1/D_i sum_j R_j^3 / (R_i^2 d_ij) (2 y_j v_j^2 + y_j^2 f_j), R the radii at rest, d distances.
struct cluster_bubble {
    enum unit_state { y, v, n_unit_state };
    enum parameter { pressure, n_parameter };  // amplitude of the sound, Pa
    enum unit_shared { C0, C1, C2, C3, C4, C5, C7, C9, exponent, n_unit_shared };
    enum publication { sound, own_slope, inverse, n_publication };
    static constexpr myriad::coupling couplings[] = {myriad::full_coupling(sound)};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_publication> publish(int, auto t, const auto& u, const auto& p) {
        using myriad::powr, myriad::reciprocal, myriad::sincospi;
        const auto& c = p.unit_shared;
        const auto wave = sincospi(R(R(2) * t));
        const R rest = reciprocal(u[y]), power = powr(u[y], R(-c[exponent])), mach = c[C9] * u[v];
        const R numerator = (c[C0] + c[C1] * u[v]) * power - c[C2] * (R(1) + mach) - c[C3] * rest -
                            c[C4] * u[v] * rest - (R(1.5) - R(0.5) * mach) * u[v] * u[v] -
                            p[pressure] * (c[C5] * wave.sine * (R(1) + mach) + c[C7] * wave.cosine * u[y]);
        const R over = reciprocal(u[y] - mach * u[y] + c[C4] * c[C9]);
        const R slope = numerator * over;
        return {-u[y] * (R(2) * u[v] * u[v] + u[y] * slope), slope, over};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto, const auto& u, const auto&) {
        return {u[v], u.published(own_slope) + u.published(inverse) * u.coupled(0)};
    }
};
using bubble_cluster = myriad::coupled_units<cluster_bubble, 128>;
// end of snippet
