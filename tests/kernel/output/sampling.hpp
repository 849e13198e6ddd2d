// SPDX-License-Identifier: MIT
// Ensembles to sample, kinds of sampling, and comparisons of samples. Host test files only.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/kernel/output/models.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

namespace output {

using myriad::cash_karp;
using myriad::dense;
using myriad::device;
using myriad::dormand_prince_5;
using myriad::dormand_prince_8;
using myriad::ensemble;
using myriad::options;
using myriad::runge_kutta_4;
using myriad::solve;
using myriad::status;
using myriad::tsitouras_5;
using myriad::verner_7;

template <class R>
inline constexpr double eps_of = static_cast<double>(std::numeric_limits<R>::epsilon());

/// Curves on their exact solutions, with different starting times and lengths; a negative span goes backwards.
template <class R = double>
ensemble<curve, R> curves(double span = 1, std::int64_t size = 19) {
    ensemble<curve, R> e(size);
    for (std::int64_t i = 0; i < size; ++i) {
        e.t_begin()[i] = static_cast<R>(0.25 + 0.0625 * static_cast<double>(i));
        e.t_end()[i] = e.t_begin()[i] + static_cast<R>(span * (1 + 0.03125 * static_cast<double>(i)));
        const auto start = curve::exact(e.t_begin()[i]);
        for (int c = 0; c < curve::n_state; ++c) e.state(c)[i] = start[c];
    }
    return e;
}

/// Both states of the curve, or one; fixed steps where the method takes them.
inline options evenly(std::int64_t count, std::int64_t phases = 1) {
    options o = compare::with_tolerance(1e-6);
    o.phases = phases;
    o.samples.states = {curve::u, curve::w};
    o.samples.evenly = count;
    o.samples.capacity = count * phases;
    return o;
}
inline options by_steps(std::int64_t every, std::int64_t capacity) {
    options o = compare::with_tolerance(1e-6);
    o.samples.states = {curve::u, curve::w};
    o.samples.every = every;
    o.samples.capacity = capacity;
    return o;
}

/// Largest distance of a stored sample of instance i to the exact solution.
template <class R>
double distance(const ensemble<curve, R>& e, std::int64_t i) {
    double worst = 0;
    for (std::int64_t k = 0; k < e.samples().stored()[i]; ++k) {
        const auto exact = curve::exact(static_cast<double>(e.samples().time()(i, k)));
        for (int c = 0; c < curve::n_state; ++c) {
            const double off = std::abs(static_cast<double>(e.samples().state(c)(i, k)) - exact[c]);
            worst = off <= worst ? worst : off;  // NaN wins
        }
    }
    return worst;
}

/// Whether both hold the same samples, bit for bit, NaN where there are none.
template <class Model, class R>
bool same_samples(const ensemble<Model, R>& a, const ensemble<Model, R>& b) {
    bool same = (a.samples().stored() == b.samples().stored()).all() &&
                compare::same_bits_everywhere(a.samples().time(), b.samples().time());
    for (int c = 0; c < myriad::detail::n_state<Model>; ++c)
        same = same && compare::same_bits_everywhere(a.samples().state(c), b.samples().state(c));
    return same;
}

/// Calls `test.operator()<dense<Method>, Method>()` for every method.
template <class Test>
void each_dense_method(Test test) {
    compare::each_method([&]<class Method> { test.template operator()<dense<Method>, Method>(); });
}

}  // namespace output
