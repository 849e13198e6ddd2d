// SPDX-License-Identifier: MIT
// Finds out, after an explicit method has run, whether stability rather than accuracy limited its steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "myriad/host/ensemble/inputs_of.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/methods/controller_policies.hpp"
#include "myriad/kernel/methods/rodas_5p.hpp"
#include "myriad/kernel/stepper/lu.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The stability function of an explicit method at a real z: the factor of one step for y' = z y / h. Hairer, Wanner,
/// Solving ODE II, IV.2, eq. (2.9).
template <class Method>
double stability_function(double z) {
    constexpr auto t = Method::tableau();
    double slope[Method::stages], y = 1;
    for (int i = 0; i < Method::stages; ++i) {
        double argument = 1;
        for (int j = 0; j < i; ++j) argument += z * t.weight(i, j) * slope[j];
        slope[i] = argument;
        y += z * t.weight(Method::stages, i) * argument;
    }
    return y;
}

/// The largest x such that steps are stable for y' = -z y / h with all z up to x.
template <class Method>
double real_stability_limit() {
    double x = 0.01;
    while (x < 100 && std::abs(stability_function<Method>(-x)) <= 1) x += 0.01;
    return x;
}

/// The step that an instance would take next, with its sign: no longer than its domain.
template <class Model, class R>
double step_of(const ensemble<Model, R>& e, std::int64_t i) {
    const double h = static_cast<double>(e.next_step()[i]);
    const double domain = std::abs(static_cast<double>(e.t_end_of(i)) - static_cast<double>(e.t_begin_of(i)));
    return std::copysign(std::min(std::abs(h), domain), h);
}

/// h lambda of the fastest mode of an instance for its next step, if that mode decays, and faster than it rotates;
/// otherwise 0.
template <class Model, class R>
double fastest_decay(ensemble<Model, R>& e, std::int64_t i) {
    constexpr int n = n_state<Model>;
    const auto p = inputs_of(e, i);
    const R t = e.t()[i];
    vec<R, n> y, v;
    for (int c = 0; c < n; ++c) {
        y[c] = e.state(c)[i];
        v[c] = R(1) / static_cast<R>(c + 1);  // unlikely to be orthogonal to any mode
    }
    const auto f = detail::evaluate_rhs<Model>(t, y, p);
    const double root = std::sqrt(static_cast<double>(epsilon_of<R>));
    const auto length = [](const vec<R, n>& x) {
        double sum = 0;
        for (int c = 0; c < n; ++c) sum += static_cast<double>(x[c]) * static_cast<double>(x[c]);
        return std::sqrt(sum);
    };
    // Power iteration with a difference quotient for the Jacobian; a geometric mean, because complex pairs rotate the
    // vector.
    constexpr int settling = 12, iterations = 24;
    double logarithms = 0, along = 0;
    for (int k = 0; k < iterations; ++k) {
        const double scale = 1 / length(v);
        double step = std::numeric_limits<double>::infinity();  // no component changes by more than `root` of its size
        for (int c = 0; c < n; ++c) {
            v[c] = static_cast<R>(static_cast<double>(v[c]) * scale);
            const double size = y[c] == R(0) ? 1 : std::abs(static_cast<double>(y[c]));
            if (std::abs(static_cast<double>(v[c])) > 1e-6)
                step = std::min(step, root * size / std::abs(static_cast<double>(v[c])));
        }
        vec<R, n> moved;
        for (int c = 0; c < n; ++c)
            moved[c] = static_cast<R>(static_cast<double>(y[c]) + step * static_cast<double>(v[c]));
        const auto f_moved = detail::evaluate_rhs<Model>(t, moved, p);
        along = 0;
        vec<R, n> product;
        for (int c = 0; c < n; ++c) {
            product[c] = static_cast<R>(static_cast<double>(f_moved[c] - f[c]) / step);
            along += static_cast<double>(product[c]) * static_cast<double>(v[c]);
        }
        v = product;
        if (k >= settling) logarithms += std::log(length(v));
        if (!(length(v) > 0)) return 0;
    }
    const double rate = std::exp(logarithms / (iterations - settling));
    const double h = step_of(e, i);
    const bool decays = h * along < 0 && std::abs(along) > 0.7 * rate;
    return decays ? std::abs(h) * rate : 0;
}

/// Trial steps of rodas_5p from one instance, with derivatives by differences, so that only `rhs` in R needs to be
/// compiled. Slow, but good enough to find how long a step the tolerances would allow.
template <class Model, class R>
class stiff_trial {
    static constexpr int n = n_state<Model>;
    using column = vec<double, n>;

public:
    stiff_trial(ensemble<Model, R>& e, std::int64_t i)
        : p_(inputs_of(e, i)), begin_(static_cast<double>(e.t_begin_of(i))), t0_(static_cast<double>(e.t()[i])),
          t_(t0_) {
        for (int c = 0; c < n; ++c) y_[c] = static_cast<double>(e.state(c)[i]);
    }

    /// Takes a step of length h and returns the largest ratio of error to tolerance over all components; infinite if
    /// the step cannot be taken.
    double step(double h, const options& o, double scale) {
        constexpr auto w = rodas_5p::tableau();
        const double root = std::sqrt(static_cast<double>(epsilon_of<R>));
        const column f = rhs(t_, y_);
        const auto lu = std::make_unique<lu_factors<double, n>>();
        for (int j = 0; j < n; ++j) {
            column moved = y_;
            moved[j] = static_cast<double>(static_cast<R>(y_[j] + root * (y_[j] == 0 ? 1 : std::abs(y_[j]))));
            const column there = rhs(t_, moved);
            for (int i = 0; i < n; ++i) lu->a[i][j] = -(there[i] - f[i]) / (moved[j] - y_[j]);
            lu->a[j][j] += 1 / (h * w.gamma);
        }
        if (!factorise(*lu)) return std::numeric_limits<double>::infinity();
        const double later = static_cast<double>(static_cast<R>(t_ + root * h));
        const column f_later = rhs(later, y_);

        vec<column, rodas_5p::stages> u;
        column y1 = y_, error{};
        for (int s = 0; s < rodas_5p::stages; ++s) {
            const auto row = static_cast<std::size_t>(s);
            column argument = y_;
            for (int j = 0; j < s; ++j)
                for (int c = 0; c < n; ++c) argument[c] += w.weight(s, j) * u[j][c];
            u[s] = rhs(t_ + w.c[row] * h, argument);
            for (int c = 0; c < n; ++c) {
                if (later != t_) u[s][c] += h * w.d[row] * (f_later[c] - f[c]) / (later - t_);
                for (int j = 0; j < s; ++j) u[s][c] += w.coupling[row][static_cast<std::size_t>(j)] / h * u[j][c];
            }
            solve_factorised(*lu, u[s]);
            for (int c = 0; c < n; ++c) {
                y1[c] += w.m[row] * u[s][c];
                error[c] += w.e[row] * u[s][c];
            }
        }
        double worst = 0;
        for (int c = 0; c < n; ++c) {
            const auto at = static_cast<std::size_t>(c);
            const double relative =
                std::max(o.relative_tolerance[at], static_cast<double>(least_relative_tolerance<R>));
            const double size = std::max(std::abs(y_[c]), std::abs(y1[c]));
            const double ratio = std::abs(error[c]) / (scale * std::max(o.absolute_tolerance[at], relative * size));
            worst = ratio <= worst ? worst : ratio;  // NaN propagates
        }
        t_ += h;
        y_ = y1;
        return worst;
    }

private:
    /// Time runs backwards, into the domain, as a forcing may be undefined beyond its end; backwards it varies as fast.
    column rhs(double t, const column& y) const {
        const double back = t0_ - (t - t0_), seen = begin_ < t0_ ? std::max(back, begin_) : std::min(back, begin_);
        vec<R, n> at;
        for (int c = 0; c < n; ++c) at[c] = static_cast<R>(y[c]);
        const auto f = detail::evaluate_rhs<Model>(static_cast<R>(seen), at, p_);
        column out;
        for (int c = 0; c < n; ++c) out[c] = static_cast<double>(f[c]);
        return out;
    }

    inputs<Model, R> p_;
    double begin_, t0_, t_;
    column y_;
};

/// Whether accuracy would allow a stiff method far longer steps than h, the next one of instance i. What the explicit
/// method has left of the fast modes, and what reversing time excites, decays in first steps of the same length.
template <class Model, class R>
bool accuracy_allows_more(ensemble<Model, R>& e, std::int64_t i, double h, const options& o) {
    const auto& scales = ensemble_access::data(e).tolerance_scale;  // none, unless the method has them
    const double scale = scales.components() > 0 ? static_cast<double>(scales.data()[i]) : 1;
    stiff_trial<Model, R> trial(e, i);
    double error = trial.step(h, o, scale);
    while (!(error <= 1)) {  // still decaying as long as each step halves it
        const double before = error;
        error = trial.step(h, o, scale);
        if (!(error <= 0.5 * before)) return false;
    }
    // A single long step may skip what a shorter one would have resolved, and a calm stretch of a hundred steps does
    // not last.
    for (const double share : {0.1, 0.3, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0})
        if (!(trial.step(share * worthwhile_stretch * h, o, scale) <= 1)) return false;
    return true;
}

/// For an explicit method whose steps are stable up to `limit`, examines 64 or so instances in their current states.
/// Steps limited by stability stay near that limit; those limited by accuracy resolve the fastest mode and stay well
/// below. But a step may be near both limits, as in the calm parts of chaotic motion: then a stiff method gains
/// nothing, which a trial step shows.
template <class Model, class R>
stiffness find_stiffness(ensemble<Model, R>& e, const options& o, double limit) {
    stiffness found;
    const std::int64_t stride = std::max<std::int64_t>(e.size() / 64, 1);
    for (std::int64_t i = 0; i < e.size(); i += stride) {
        const double h = std::abs(step_of(e, i));
        if (!std::isfinite(h) || h >= o.maximum_step) continue;
        ++found.looked_at;
        const double share = fastest_decay(e, i) / limit;
        if (!(share > 0.5) || !accuracy_allows_more(e, i, step_of(e, i), o)) continue;
        ++found.limited;
        found.share = std::max(found.share, share);
    }
    return found;
}

}  // namespace myriad::host::inline MYRIAD_ABI
