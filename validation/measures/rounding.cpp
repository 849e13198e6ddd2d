// SPDX-License-Identifier: MIT
// Accumulated rounding errors: far from t = 0, where the resolution of t is coarse, and in single precision, where
// rounded coefficients must not add an error in every step.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "../methods.hpp"
#include "../problems/kepler.hpp"
#include "measures.hpp"

namespace validation {
namespace {

/// Orbits with semi-major axis 1 from the perihelion, with eccentricities from `least` to `most`, over a length of
/// time.
template <class Method, class R>
myriad::ensemble<orbit, R> follow(session& s, int count, double least, double most, double t_begin, double length,
                                  const myriad::options& o) {
    myriad::ensemble<orbit, R> e(count);
    for (int i = 0; i < count; ++i) {
        const double eccentricity = least + (most - least) * i / count;
        e.state(orbit::x)[i] = static_cast<R>(1 - eccentricity);
        e.state(orbit::v)[i] = static_cast<R>(std::sqrt((1 + eccentricity) / (1 - eccentricity)));
    }
    e.state(orbit::y) = R(0);
    e.state(orbit::u) = R(0);
    e.time_domain(static_cast<R>(t_begin), static_cast<R>(t_begin + length));
    myriad::solve<Method>(s.device, e, o);
    return e;
}

/// The same circle from different times: steps of a thousandth that is not a multiple of t's resolution.
template <class Method>
void measure_late_start(session& s, const char* name) {
    const double length = s.quick() ? 64 : 1024;
    myriad::options o;
    o.relative_tolerance = o.absolute_tolerance = 1e-10;
    o.step = o.maximum_step = 1e-3;
    o.max_steps = 10'000'000;
    if (myriad::detail::solves_linear_systems<Method>) o.maximum_step = 1e-2;
    const auto early = follow<Method, double>(s, 1, 0, 0, 0, length, o);
    for (const double t_begin : {1e6, 1e9}) {
        const auto late = follow<Method, double>(s, 1, 0, 0, t_begin, length, o);
        double difference = 0;
        for (int c = 0; c < orbit::n_state; ++c)
            difference = larger(difference, std::abs(late.state(c)[0] - early.state(c)[0]));
        const double steps = static_cast<double>(late.accepted_steps()[0]);
        s.rows.add(
            {"orbit far from t = 0", name, "double", s.device_name(), t_begin}, "difference to the same from t = 0",
            difference, bounds::at_most(3 * length * steps * eps_double),
            "3 t (growth of errors of a circular orbit) x steps x rounding: t is rounded, and takes nothing from "
            "the state");
    }
}

/// Mean change of the energy in single precision, next to that in double precision at the same tolerance.
template <class Method>
void measure_drift(session& s, const char* name) {
    if constexpr (Method::embedded_order > 0) {
        constexpr int count = 1024;
        constexpr double tolerance = 5e-7, length = 20;
        myriad::options o;
        o.relative_tolerance = o.absolute_tolerance = tolerance;
        const auto mean_change = [&](const auto& e) {
            double mean = 0;
            for (int i = 0; i < count; ++i) {
                const auto at = [&](int c) { return static_cast<double>(e.state(c)[i]); };
                const double energy = (at(orbit::u) * at(orbit::u) + at(orbit::v) * at(orbit::v)) / 2 -
                                      1 / std::hypot(at(orbit::x), at(orbit::y));
                mean += (energy + 0.5) / 0.5 / count;
            }
            return mean;
        };
        const auto single = follow<Method, float>(s, count, 0.1, 0.5, 0, length, o);
        const auto exact = follow<Method, double>(s, count, 0.1, 0.5, 0, length, o);
        const double steps = static_cast<double>(single.accepted_steps().sum()) / count;
        s.rows.add({"orbits in single precision", name, "float", s.device_name(), tolerance},
                   "mean change of energy beside that in double", std::abs(mean_change(single) - mean_change(exact)),
                   bounds::at_most(std::sqrt(steps) * eps_float),
                   "roundings of the steps that have no common direction: the square root of their number");
    }
}

}  // namespace

void measure_rounding(session& s) {
#define VALIDATION_MEASURE(M) measure_late_start<myriad::M>(s, #M), measure_drift<myriad::M>(s, #M);
    VALIDATED_METHODS(VALIDATION_MEASURE)
    VALIDATED_STIFF_METHODS(VALIDATION_MEASURE)
#undef VALIDATION_MEASURE
}

}  // namespace validation
