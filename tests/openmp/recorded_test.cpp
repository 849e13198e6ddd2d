// SPDX-License-Identifier: MIT
// Derivatives that are recorded: products with the transposed Jacobian are those of dual numbers, of first and second
// order, for every function.

#include "myriad/openmp/recorded.hpp"

#include <cmath>

#include "myriad/kernel/scalar/floored_division.hpp"
#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::dual;
using myriad::pack;
using myriad::vec;
using myriad::detail::derivative_list;
using myriad::detail::recorded;

constexpr int n = 2;

/// The gradient of v f at x, where f takes two numbers, by recorded derivatives.
template <class S, class F>
vec<S, n> gradient(F f, const vec<S, n>& x, const S& v) {
    derivative_list<S> list;
    list.begin(n);
    using D = dual<S, recorded<S>>;
    const D result = f(D(x[0], recorded<S>{&list, {0}}), D(x[1], recorded<S>{&list, {1}}));
    if (!result.derivative.is_zero()) list.result_by(result.derivative.at) = v;
    list.transpose();
    return {list.result_by({0}), list.result_by({1})};
}
/// The same by dual numbers, one after the other.
template <class S, class F>
vec<S, n> by_dual_numbers(F f, const vec<S, n>& x, const S& v) {
    const S zero(0.0), one(1.0);
    return {v * f(dual<S>(x[0], one), dual<S>(x[1], zero)).derivative,
            v * f(dual<S>(x[0], zero), dual<S>(x[1], one)).derivative};
}

void check_close(double got, double wanted) {
    CAPTURE(got, wanted);
    CHECK(std::abs(got - wanted) <= 1e-13 * (1 + std::abs(wanted)));
}

template <class F>
void check(const char* name, F f, double a, double b) {
    CAPTURE(name, a, b);
    const vec<double, n> x{a, b};
    const auto got = gradient(f, x, 1.5), wanted = by_dual_numbers(f, x, 1.5);
    for (int i = 0; i < n; ++i) check_close(got[i], wanted[i]);

    using P = pack<double, 1>;
    const auto in_pack = gradient(f, vec<P, n>{P(a), P(b)}, P(1.5));
    for (int i = 0; i < n; ++i) check_close(myriad::detail::get_lane(in_pack[i], 0), got[i]);

    // along (0.3, -0.7): the derivatives of a directional derivative
    using D = dual<double>;
    const vec<D, n> moving{D(a, 0.3), D(b, -0.7)};
    const auto second = gradient(f, moving, D(1.5)), expected = by_dual_numbers(f, moving, D(1.5));
    for (int i = 0; i < n; ++i) check_close(second[i].derivative, expected[i].derivative);
}

}  // namespace

TEST_CASE("recorded derivatives are transposed as dual numbers have them", "[recorded]") {
    using namespace myriad;
#define MYRIAD_CHECK_ONE(name) \
    check(                     \
        #name, [](auto x, auto y) { return name(x) * y; }, 0.4, 1.3);
    MYRIAD_SMOOTH_FUNCTIONS(MYRIAD_CHECK_ONE)
    MYRIAD_STEP_FUNCTIONS(MYRIAD_CHECK_ONE)
    const auto of_two = [](const char* name, auto f) { check(name, f, 0.4, 1.3); };
    of_two("pow", [](auto x, auto y) { return pow(x, y); });
    of_two("powr", [](auto x, auto y) { return powr(x, 1.7) * y; });
    of_two("atan2", [](auto x, auto y) { return atan2(x, y); });
    of_two("hypot", [](auto x, auto y) { return hypot(x, y); });
    of_two("fmod", [](auto x, auto y) { return fmod(y, x); });
    of_two("min", [](auto x, auto y) { return min(x, y); });
    of_two("max", [](auto x, auto y) { return max(x, y); });
    check(
        "operators", [](auto x, auto y) { return (x + y) * (x - y) / (2.0 * y - x / 3.0) - -x + 1.0 / y; }, 0.4, 1.3);
    check(
        "fma", [](auto x, auto y) { return fma(x, y, fma(y, 2.0, x)); }, 0.4, 1.3);
    check(
        "select", [](auto x, auto y) { return select(x < y, x * y, exp(x)) + select(x > y, x, 2.0 * y); }, 0.4, 1.3);
    check(
        "copysign", [](auto x, auto y) { return copysign(x, -y); }, 0.4, 1.3);
    check(
        "sincos",
        [](auto x, auto y) {
            const auto [sine, cosine] = sincos(x);
            return sine * y + cosine;
        },
        0.4, 1.3);
    check(
        "one that does not depend on them", [](auto x, auto) { return decltype(x)(2.0); }, 0.4, 1.3);
}

TEST_CASE("what is not chosen leaves no NaN in recorded derivatives", "[recorded]") {
    const auto f = [](auto x, auto y) { return y + myriad::sqrt(myriad::max(x, 0.0)); };
    const auto got = gradient(f, vec<double, n>{-1.0, 1.0}, 1.0);
    CHECK(got[0] == 0.0);
    CHECK(got[1] == 1.0);
}

TEST_CASE("a list of recorded derivatives grows with what is computed", "[recorded]") {
    const auto f = [](auto x, auto y) {
        for (int i = 0; i < 5000; ++i) x = x + 1e-4 * y;
        return x;
    };
    const auto got = gradient(f, vec<double, n>{0.0, 1.0}, 1.0);
    CHECK(got[0] == 1.0);
    CHECK(got[1] == Approx(0.5));
}
