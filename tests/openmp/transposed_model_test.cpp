// SPDX-License-Identifier: MIT
// Products with the transposed derivatives of whole models: those of the benchmarks, and one with a table.

#include "myriad/openmp/transposed_model.hpp"

#include <cmath>

#include "myriad/kernel/model/tables.hpp"
#include "problems/hires.hpp"
#include "problems/hodgkin_huxley.hpp"
#include "problems/kuramoto.hpp"
#include "problems/pollution.hpp"
#include "problems/ring_modulator.hpp"
#include "problems/van_der_pol_ring.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::dual;
using myriad::vec;

/// A table that is interpolated between its rows.
struct driven {
    enum state { x, n_state };
    enum parameter { gain, n_parameter };
    enum shared { first, last = first + 3, n_shared };

    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto& p) {
        const R row = myriad::floor(R(t)), low = myriad::lookup(&p.shared[first], 1, 4, row);
        const R high = myriad::lookup(&p.shared[first], 1, 4, row + 1.0);
        return {p[gain] * (low + (R(t) - row) * (high - low)) - y[x]};
    }
};

/// A number between 0.2 and 1.2 that looks random.
double some(int i) { return 0.2 + std::fmod(0.61803398875 * (i + 1), 1.0); }

/// Compares the products with those by dual numbers, one direction after the other.
template <class Model>
void check() {
    using adjoint = myriad::detail::transposed_model<Model>;
    constexpr int n = adjoint::n, m = adjoint::n_wrt, all = n + m;
    const double shared[] = {0.3, 0.9, 0.5, 1.4, 0.7, 0.8, 0.6, 0.2};
    static_assert(myriad::detail::n_shared<Model> <= 8);
    const std::int32_t shared_integer[8] = {};
    vec<double, all> at;
    for (int i = 0; i < all; ++i) at[i] = some(i);
    vec<double, n> v, u;
    for (int c = 0; c < n; ++c) v[c] = some(all + c) - 0.7, u[c] = some(2 * all + c) - 0.7;
    const double t = 1.3, tau = 0.4;

    myriad::inputs<adjoint, double> p{};
    p.shared = shared;
    p.shared_integer = shared_integer;
    vec<double, n> y;
    for (int c = 0; c < n; ++c) y[c] = at[c];
    for (int i = 0; i < m; ++i) p.parameter[i] = at[n + i];
    const auto first = adjoint::template transposed_rhs<double>(t, y, p, v);
    const auto second = adjoint::template transposed_slope<double>(t, y, p, u, tau, v);

    using D = dual<double>;
    using DD = dual<D>;
    for (int i = 0; i < all; ++i) {  // by component i: derivative; along (u, tau): that of `value`
        const auto number = [&](int j, double along) { return DD(D(at[j], along), D(i == j ? 1.0 : 0.0)); };
        vec<DD, n> state;
        myriad::inputs<Model, DD> inputs{};
        for (int c = 0; c < n; ++c) state[c] = number(c, u[c]);
        for (int k = 0; k < m; ++k) inputs.parameter[k] = number(n + k, 0.0);
        inputs.shared = shared;
        inputs.shared_integer = shared_integer;
        const auto f = Model::template rhs<DD>(DD(D(t, tau)), state, inputs);
        double expected = 0, expected_second = 0, size = 1, size_of_second = 1;
        for (int c = 0; c < n; ++c) {
            const double term = v[c] * f[c].derivative.value, term_of_second = v[c] * f[c].derivative.derivative;
            expected += term;
            size += std::abs(term);
            expected_second += term_of_second;
            size_of_second += std::abs(term_of_second);
        }
        CAPTURE(i, first[i], expected, second[i], expected_second);
        CHECK(std::abs(first[i] - expected) <= 1e-13 * size);
        CHECK(std::abs(second[i] - expected_second) <= 1e-12 * size_of_second);
    }
}

}  // namespace

TEST_CASE("transposed derivatives of whole models are those of dual numbers", "[transposed_model]") {
    SECTION("hires") { check<problems::hires>(); }
    SECTION("hodgkin_huxley") { check<problems::hodgkin_huxley>(); }
    SECTION("kuramoto") { check<problems::kuramoto<8>>(); }
    SECTION("pollution") { check<problems::pollution>(); }
    SECTION("ring_modulator") { check<problems::ring_modulator>(); }
    SECTION("van_der_pol_ring") { check<problems::van_der_pol_ring<4>>(); }
    SECTION("a table") { check<driven>(); }
}
