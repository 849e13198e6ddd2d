// SPDX-License-Identifier: MIT
// Derivatives of right-hand sides by dual numbers against those written out, and the check of a model's own Jacobian.
#include "myriad/kernel/model/jacobian.hpp"

#include <cmath>
#include <limits>

#include "myriad/host/checks/jacobian_check.hpp"
#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/support/prepared.hpp"
#include "tests/support/stiff.hpp"

namespace {

using myriad::ensemble;
using myriad::inputs;
using myriad::matrix;
using myriad::vec;

/// Time, parameters, an accessory and shared values in one right-hand side, with functions of several kinds.
struct everything {
    enum state { x, y, n_state };
    enum parameter { k, n_parameter };
    enum shared { s, n_shared };
    enum accessory { a, n_accessory };
    template <class R>
    MYRIAD_FUNCTION static vec<R, 2> rhs(auto t, const vec<R, 2>& v, const auto& p) {
        using myriad::cos, myriad::exp;
        return {p[k] * exp(v[x] * v[y]) + p.shared[s] * cos(t), p.accessory[a] * v[x] / v[y] * t};
    }
};

/// Jacobians with one wrong entry each.
struct transposed : stiff::robertson {
    template <class R>
    MYRIAD_FUNCTION static matrix<R, 3> jacobian(auto t, const vec<R, 3>& y, const auto& p) {
        const auto right = stiff::robertson_with_jacobian::jacobian<R>(t, y, p);
        matrix<R, 3> wrong;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) wrong[i][j] = right[j][i];
        return wrong;
    }
};
struct nan_inside : stiff::robertson {
    template <class R>
    MYRIAD_FUNCTION static matrix<R, 3> jacobian(auto t, const vec<R, 3>& y, const auto& p) {
        auto wrong = stiff::robertson_with_jacobian::jacobian<R>(t, y, p);
        wrong[2][2] = std::numeric_limits<R>::quiet_NaN();
        return wrong;
    }
};

template <class Model>
ensemble<Model> some() {
    ensemble<Model> e(3000);
    e.state(0) = 0.9;
    e.state(1) = 1e-5;
    e.state(2) = 0.1;
    e.time_domain(0, 1);
    return e;
}

/// n components with f_i = i y_(n-1-i) + y_0^2: for unrolled and rolled loops over columns.
template <int size>
struct mirror {
    enum { n_state = size };
    template <class R>
    MYRIAD_FUNCTION static vec<R, size> rhs(auto, const vec<R, size>& y, const auto&) {
        vec<R, size> f;
        for (int i = 0; i < size; ++i) f[i] = R(i) * y[size - 1 - i] + y[0] * y[0];
        return f;
    }
};

template <int n>
void check_mirror() {
    vec<double, n> y;
    for (int i = 0; i < n; ++i) y[i] = 3 + i;
    matrix<double, n> j;
    myriad::detail::dual_jacobian<mirror<n>>(0.0, y, inputs<mirror<n>, double>{}, j);
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column)
            CHECK(j[row][column] == (column == n - 1 - row ? row : 0) + (column == 0 ? 6 : 0));  // integers: exact
}

}  // namespace

TEST_CASE("derivatives by dual numbers are those written out") {
    const double shared[] = {0.7};
    inputs<everything, double> p{};
    p.parameter[0] = 1.3;
    p.accessory[0] = -0.4;
    p.shared = shared;
    const double t = 0.6;
    const vec<double, 2> v{0.8, 1.7};
    matrix<double, 2> j;
    myriad::detail::dual_jacobian<everything>(t, v, p, j);
    const auto by_time = myriad::detail::time_derivative<everything>(t, v, p);
    const double e = 1.3 * std::exp(0.8 * 1.7);
    const double expected[2][2] = {{e * 1.7, e * 0.8}, {-0.4 / 1.7 * 0.6, 0.4 * 0.8 / (1.7 * 1.7) * 0.6}};
    // five roundings or so on each side
    const auto close = [](double a, double b) {
        return std::abs(a - b) <= 10 * std::numeric_limits<double>::epsilon() * std::abs(b);
    };
    for (int i = 0; i < 2; ++i)
        for (int c = 0; c < 2; ++c) CHECK(close(j[i][c], expected[i][c]));
    CHECK(close(by_time[0], -0.7 * std::sin(0.6)));
    CHECK(close(by_time[1], -0.4 * 0.8 / 1.7));
}

TEST_CASE("Jacobians of small and of large systems have their entries where they belong") {
    check_mirror<1>();
    check_mirror<2>();
    check_mirror<6>();
    check_mirror<7>();
    check_mirror<32>();
}

TEST_CASE("a model's own Jacobian takes the place of the one by dual numbers") {
    matrix<double, 3> own, dual;
    const vec<double, 3> y{0.9, 1e-5, 0.1};
    myriad::detail::evaluate_jacobian<transposed>(0.0, y, inputs<transposed, double>{}, own);
    myriad::detail::dual_jacobian<transposed>(0.0, y, inputs<transposed, double>{}, dual);
    CHECK(own[0][1] == 0.04);
    CHECK(dual[1][0] == 0.04);
}

template <class Model>
void check_jacobian_of(myriad::ensemble<Model>& e) {
    myriad::host::check_jacobian<Model>(tests::prepare<myriad::rosenbrock_23>(e, {}).arguments(), e.size());
}

TEST_CASE("a wrong Jacobian is refused, with the entry, the instance and both values") {
    auto right = some<stiff::robertson_with_jacobian>();
    CHECK_NOTHROW(check_jacobian_of(right));
    auto wrong = some<transposed>();
    refused([&] { check_jacobian_of(wrong); },
            {"jacobian gives 0.04 for the derivative of component 0 by state 1 at the start of instance 0",
             "that of rhs is 1000", "mend the formula"});
    auto bad = some<nan_inside>();
    refused([&] { check_jacobian_of(bad); }, {"jacobian gives nan for the derivative of component 2 by state 2"});
}
