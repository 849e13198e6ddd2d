// SPDX-License-Identifier: MIT
// Heat conduction in the liquid around a bubble, with flow of liquid through the bubble's wall, by collocation.
#pragma once

#include <numbers>

#include <myriad/model.hpp>

// snippet: model
/// dT/dt + u dT/dr = diffusivity / r^2 d/dr(r^2 dT/dr) between the bubble's wall at r = 1, where T is `wall`, and a
/// sphere where T is zero. Liquid enters and leaves at the wall, where vapour condenses and liquid evaporates: u =
/// (through + pulse cos 2 pi t) / r^2, since it is incompressible. Unit of length: the bubble's radius; of time: the
/// period.
template <int points>
struct heat_conduction {
    static constexpr bool writes_time_domain = true;
    static constexpr bool scalar_only = points > 64;  // on the CPU; compiles in a third of the time
    static constexpr int inner = points - 2;          // points whose temperature is not prescribed
    static constexpr int phases_per_period = 16;
    enum state { temperature, heat = inner, n_state };
    enum parameter { diffusivity, through, pulse, n_parameter };
    enum shared {
        matrix,
        square = points * points,
        inverse_square = square + points,
        wall = inverse_square + points,
        n_shared
    };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        const R flow = p[through] + p[pulse] * myriad::cospi(2 * t);
        myriad::vec<R, points> gradient;  // D T
        for (int i = 0; i < points; ++i) {
            R sum = R(p.shared[matrix + i * points] * p.shared[wall]);
            for (int j = 0; j < inner; ++j) sum += p.shared[matrix + i * points + j + 1] * y[temperature + j];
            gradient[i] = sum;
        }
        myriad::vec<R, n_state> slope;
        for (int i = 1; i <= inner; ++i) {
            R sum = R(0);  // D (r^2 D T)
            for (int j = 0; j < points; ++j)
                sum += p.shared[matrix + i * points + j] * p.shared[square + j] * gradient[j];
            slope[temperature + i - 1] = (p[diffusivity] * sum - flow * gradient[i]) * p.shared[inverse_square + i];
        }
        slope[heat] = -gradient[0];  // conducted into the liquid, over 4 pi conductivity radius
        return slope;
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.y[heat] = 0; }
    MYRIAD_FUNCTION static void finalise(auto& lane) {  // sets the next phase
        lane.t_begin = lane.t_end;
        lane.t_end += 1.0 / phases_per_period;
    }
};
// end of snippet
using heat_24 = heat_conduction<24>;
using heat_77 = heat_conduction<77>;
