// SPDX-License-Identifier: MIT
// Models for the tests of studies.
#pragma once

#include <myriad/model.hpp>

namespace studied {

/// The Duffing oscillator, with every kind of component.
struct duffing {
    enum state { x, v, n_state };
    enum parameter { k, omega, n_parameter };
    enum shared { B, n_shared };
    enum shared_integer { power, n_shared_integer };
    enum accessory { highest, my_number, n_accessory };
    enum integer_accessory { phases, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        const R restoring = p.shared_integer[power] == 3 ? y[x] * y[x] * y[x] : y[x];
        return {y[v], y[x] - restoring - p[k] * y[v] + p.shared[B] * myriad::cos(p[omega] * t)};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[highest] = lane.y[x];
        ++lane.integer_accessory[phases];
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[highest] = myriad::max(lane.accessory[highest], lane.y[x]);
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        using real = std::remove_cvref_t<decltype(lane.accessory[my_number])>;
        lane.accessory[my_number] = static_cast<real>(lane.index);
    }
};

/// Lorenz' equations. An instance with a negative r fails at once.
struct lorenz {
    enum state { x, y, z, n_state };
    enum parameter { r, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& u, const auto& p) {
        return {R(10) * (u[y] - u[x]), myriad::sqrt(p[r]) * myriad::sqrt(p[r]) * u[x] - u[y] - u[x] * u[z],
                u[x] * u[y] - R(8) / R(3) * u[z]};
    }
};

/// A wave that is stopped at zero, and set by the model itself: every seventh instance is infinite.
struct wave {
    enum state { x, v, n_state };
    enum parameter { omega, n_parameter };
    enum shared { size, n_shared };
    enum accessory { start, n_accessory };
    enum integer_accessory { rank, n_integer_accessory };
    enum event { zero, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], -(p[omega] * p[omega]) * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[x]};
    }
    MYRIAD_FUNCTION static void generate(auto& instance) {
        instance.y[x] = instance.random.uniform(1, 2) * instance.shared[size];
        instance.y[v] = instance.random.normal();
        if (instance.index % 7 == 6) instance.y[v] = instance.y[x] * 1e308 * 1e308;
        instance.accessory[start] = instance.parameter[omega];
        instance.integer_accessory[rank] = static_cast<int>(instance.index % 3);
        instance.parameter[omega] = instance.parameter[omega] * 2;
    }
};

}  // namespace studied
