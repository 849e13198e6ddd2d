// SPDX-License-Identifier: MIT
// Dual numbers: their values are those of plain code, their derivatives agree with a central difference in long double,
// and packs agree lane by lane.

#include "myriad/kernel/scalar/dual.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

#include "myriad/kernel/scalar/floored_division.hpp"
#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

using myriad::detail::any;
using myriad::detail::bits;
using myriad::detail::get_lane;
using myriad::detail::partial;
using myriad::detail::partials;
using myriad::detail::set_lane;

namespace {

using myriad::dual;
using myriad::pack;
using wide = long double;

/// f'(x) by the difference of sixth order, whose error here is below 1e-13 of the function's scale.
template <class F>
wide difference(F f, wide x) {
    const wide h = 1e-3L;
    return (45 * (f(x + h) - f(x - h)) - 9 * (f(x + 2 * h) - f(x - 2 * h)) + (f(x + 3 * h) - f(x - 3 * h))) / (60 * h);
}

template <class T>
void check_close(T got, wide wanted) {
    // A few roundings of the formula and, for double, the error of the difference.
    const wide tolerance = 16 * static_cast<wide>(std::numeric_limits<T>::epsilon()) + 1e-11L;
    CAPTURE(sizeof(T), static_cast<double>(got), static_cast<double>(wanted));
    CHECK(std::fabs(static_cast<wide>(got) - wanted) <= tolerance * (1 + std::fabs(wanted)));
}

/// The derivative of f at x for dual<double>, dual<float> and duals of packs; f is called with a dual number, g is the
/// same function in long double.
template <class F, class G>
void check_derivative(const char* name, F f, G g, double x) {
    CAPTURE(name, x);
    const auto of_type = [&]<class T>(T) {
        const T at = static_cast<T>(x);
        const wide slope = difference(g, static_cast<wide>(at));
        // The direction is not 1, so that a missing factor shows.
        const auto plain = f(dual<T>(at, T(3)));
        check_close(plain.value, g(static_cast<wide>(at)));
        check_close(plain.derivative, 3 * slope);

        // The same, and no operation with a derivative that is always zero.
        const auto moving = f(dual<T, partial<T>>(at, T(3))), still = f(dual<T, partial<T>>(at));
        CHECK(bits(moving.value) == bits(plain.value));
        CHECK(bits(moving.derivative.value) == bits(plain.derivative));
        CHECK(!moving.derivative.zero);
        CHECK(bits(still.value) == bits(plain.value));
        CHECK(still.derivative.zero);
        CHECK(still.derivative == T(0));

        // Three at once, of which one is always zero. Quotients are by a reciprocal, which rounds once more.
        const partials<T, 3> given{{partial<T>(T(3)), partial<T>::none(), partial<T>(T(-1))}};
        const auto several = f(dual<T, partials<T, 3>>(at, given));
        CHECK(bits(several.value) == bits(plain.value));
        check_close(several.derivative.in[0].value, plain.derivative);
        CHECK(several.derivative.in[1].zero);
        check_close(several.derivative.in[2].value, -plain.derivative / 3);

        using P = pack<T, 2>;
        P lanes(T(0.25));
        P direction(T(1));
        set_lane(lanes, P::lanes - 1, at);
        set_lane(direction, P::lanes - 1, T(3));
        const auto packed = f(dual<P>(lanes, direction));
        const dual<T> lane = get_lane(packed, P::lanes - 1);
        check_close(lane.value, plain.value);
        check_close(lane.derivative, plain.derivative);
        const wide other = difference(g, 0.25L);
        check_close(get_lane(packed, 0).derivative, other);
    };
    of_type(double{});
    of_type(float{});
}

#define CHECK_DERIVATIVE(expression, ...)             \
    for (const double point : {__VA_ARGS__}) {        \
        check_derivative(                             \
            #expression,                              \
            [](auto x) {                              \
                using namespace myriad;               \
                return expression;                    \
            },                                        \
            [](wide x) {                              \
                using namespace std;                  \
                return static_cast<wide>(expression); \
            },                                        \
            point);                                   \
    }

wide sinpi(wide x) { return std::sin(3.14159265358979323846264338327950288L * x); }
struct both {
    wide sine, cosine;
};
both sincos(wide x) { return {std::sin(x), std::cos(x)}; }
both sincospi(wide x) { return {sinpi(x), std::cos(3.14159265358979323846264338327950288L * x)}; }
wide powr(wide x, wide y) { return std::pow(x, y); }
wide floor_divide(wide x, wide y) { return std::floor(x / y); }
wide floor_mod(wide x, wide y) { return x - y * std::floor(x / y); }
wide reciprocal(wide x) { return 1 / x; }
wide rsqrt(wide x) { return 1 / std::sqrt(x); }
wide cospi(wide x) { return std::cos(3.14159265358979323846264338327950288L * x); }

}  // namespace

TEST_CASE("derivatives of sums, products and quotients follow the rules, constants on either side"){
    CHECK_DERIVATIVE(x + x * x, 0.3, -2.0) CHECK_DERIVATIVE(x * x - 2 * x + 1, 0.3, -2.0) CHECK_DERIVATIVE(1 - x, 0.7)
        CHECK_DERIVATIVE(x - 1, 0.7) CHECK_DERIVATIVE(-x * x, 0.7) CHECK_DERIVATIVE(1 / x, 0.7, -3.0)
            CHECK_DERIVATIVE(x / 2, 0.7, -3.0) CHECK_DERIVATIVE((x + 1) / (x * x + 3), 0.7, -3.0)
                CHECK_DERIVATIVE(+x * 3 * x, 0.7, -3.0)}

TEST_CASE("derivatives of elementary functions agree with differences"){
    CHECK_DERIVATIVE(sqrt(x), 0.3, 2.0, 900.0) CHECK_DERIVATIVE(cbrt(x), 0.3, 2.0) CHECK_DERIVATIVE(abs(x), 0.3, -2.0)
        CHECK_DERIVATIVE(floor(x) + x, 0.3, -2.4) CHECK_DERIVATIVE(round(x) + x, 0.3, -2.4) CHECK_DERIVATIVE(
            rint(x) + x, 0.3, -2.4) CHECK_DERIVATIVE(expm1(x), 0.3, -2.0) CHECK_DERIVATIVE(log1p(x), 0.3, -0.7)
            CHECK_DERIVATIVE(sin(x), 0.3, -2.0, 40.0) CHECK_DERIVATIVE(cos(x), 0.3, -2.0, 40.0)
                CHECK_DERIVATIVE(tan(x), 0.3, -1.2) CHECK_DERIVATIVE(asin(x), 0.3, -0.8)
                    CHECK_DERIVATIVE(acos(x), 0.3, -0.8) CHECK_DERIVATIVE(atan(x), 0.3, -5.0)
                        CHECK_DERIVATIVE(sinpi(x), 0.3, -1.2) CHECK_DERIVATIVE(cospi(x), 0.3, -1.2)
                            CHECK_DERIVATIVE(sincos(x).sine, 0.3, -2.0) CHECK_DERIVATIVE(sincos(x).cosine, 0.3, -2.0)
                                CHECK_DERIVATIVE(sincospi(x).sine, 0.3, -1.2) CHECK_DERIVATIVE(sincospi(x).cosine, 0.3,
                                                                                               -1.2)
                                    CHECK_DERIVATIVE(reciprocal(x), 0.3, -2.0) CHECK_DERIVATIVE(rsqrt(x), 0.3, 900.0)
                                        CHECK_DERIVATIVE(powr(x, 1.4), 0.3, 4.0) CHECK_DERIVATIVE(sinh(x), 0.3, -2.0)
                                            CHECK_DERIVATIVE(cosh(x), 0.3, -2.0) CHECK_DERIVATIVE(tanh(x), 0.3, -2.0)
                                                CHECK_DERIVATIVE(exp(x), 0.3, -2.0) CHECK_DERIVATIVE(exp2(x), 0.3, -2.0)
                                                    CHECK_DERIVATIVE(log(x), 0.3, 20.0)
                                                        CHECK_DERIVATIVE(log2(x), 0.3, 20.0)
                                                            CHECK_DERIVATIVE(log10(x), 0.3, 20.0)}

TEST_CASE("derivatives of functions of two arguments agree with differences in each of them"){
    CHECK_DERIVATIVE(pow(x, 2.5), 0.3, 4.0) CHECK_DERIVATIVE(pow(2.5, x), 0.3, -2.0)
        CHECK_DERIVATIVE(pow(x, x), 0.3, 2.0) CHECK_DERIVATIVE(pow(x, 3), 0.3, -2.0)
            CHECK_DERIVATIVE(pow(x, -2), 0.3, -2.0) CHECK_DERIVATIVE(atan2(x, 1.5), 0.3, -2.0)
                CHECK_DERIVATIVE(atan2(1.5, x), 0.3, -2.0) CHECK_DERIVATIVE(atan2(x, x* x), 0.3, 2.0)
                    CHECK_DERIVATIVE(hypot(x, 1.5), 0.3, -2.0) CHECK_DERIVATIVE(hypot(x, x* x), 0.3, -2.0)
                        CHECK_DERIVATIVE(fmod(x, 0.7), 2.4, -2.4) CHECK_DERIVATIVE(fmod(2.6, x), 0.7, -0.7)
                            CHECK_DERIVATIVE(floor_mod(x, 0.7), 2.4, -2.4) CHECK_DERIVATIVE(floor_mod(-2.6, x), 0.7)
                                CHECK_DERIVATIVE(floor_divide(x, 0.7) + x, 2.4, -2.4)
                                    CHECK_DERIVATIVE(fma(x, x, 2 * x), 0.3, -2.0)
                                        CHECK_DERIVATIVE(fma(x, 1.5, x), 0.3, -2.0)}

TEST_CASE("a model's expression has the derivative of its difference quotient"){
    CHECK_DERIVATIVE(x - x * x * x - x / 4 + cos(x * 2) * exp(-x * x) + pow(1 / (x + 3), 2.5) * log(x + 4), 0.3, -1.2,
                     2.0)}

TEST_CASE("infinity, NaN and the spacing of numbers are those of their real type") {
    CHECK(myriad::infinity_of<dual<double>> == std::numeric_limits<double>::infinity());
    CHECK(myriad::epsilon_of<dual<double>> == std::numeric_limits<double>::epsilon());
    CHECK(myriad::nan_of<dual<double>> != myriad::nan_of<dual<double>>);
}

TEST_CASE("min, max and copysign take the derivative of what they return") {
    const dual<double> a(1, 10);
    const dual<double> b(2, 20);
    const dual<double> nothing(std::numeric_limits<double>::quiet_NaN(), 30);
    REQUIRE(myriad::min(a, b).derivative == 10);
    REQUIRE(myriad::max(a, b).derivative == 20);
    REQUIRE(myriad::max(a, nothing).derivative == 10);
    REQUIRE(myriad::max(nothing, a).derivative == 10);
    REQUIRE(myriad::max(a, 0.0).derivative == 10);
    REQUIRE(myriad::max(a, 5.0).derivative == 0);
    REQUIRE(myriad::copysign(a, -1.0).value == -1);
    REQUIRE(myriad::copysign(a, -1.0).derivative == -10);
    REQUIRE(myriad::copysign(a, 2.0).derivative == 10);
}

TEST_CASE("pow of a base zero or negative keeps a finite derivative") {
    const dual<double> zero(0, 1);
    REQUIRE(myriad::pow(zero, 2.0).derivative == 0);
    REQUIRE(myriad::pow(zero, 1.0).derivative == 1);
    REQUIRE(myriad::pow(dual<double>(-2, 1), 3.0).derivative == 12);
    REQUIRE(myriad::pow(dual<double>(-2, 1), 2).derivative == -4);
    // the exponent is a dual number but constant, like R(2) in a model
    REQUIRE(myriad::pow(zero, dual<double>(2)).derivative == 0);
    REQUIRE(myriad::pow(zero, dual<double>(1)).derivative == 1);
    REQUIRE(myriad::pow(dual<double>(-2, 1), dual<double>(3)).derivative == 12);
    REQUIRE(myriad::pow(zero, dual<double>(0)).derivative == 0);
    REQUIRE(myriad::pow(zero, 0.0).derivative == 0);
}

TEST_CASE("a derivative that is always zero stays zero beside infinities, and others do not see it") {
    using number = dual<double, partial<double>>;
    const double infinity = std::numeric_limits<double>::infinity();
    const number still(0.0), moving(2.0, 3.0);
    CHECK((sqrt(still) + moving).derivative == 3);  // 0 / (2 sqrt(0)) would be NaN
    CHECK((still * number(infinity) * moving).derivative.value != 0);
    CHECK((number(infinity) * still).derivative.zero);
    CHECK((moving - still).derivative == 3);
    CHECK((still - moving).derivative == -3);
    CHECK(fma(still, moving, moving).derivative == 3);
    CHECK(fma(number(5.0), moving, still).derivative == 15);
    CHECK(select(true, moving, still).derivative == 3);
    CHECK(!select(true, still, moving).derivative.zero);
    CHECK(select(true, still, number(1.0)).derivative.zero);
}

TEST_CASE("an exponent that moves in one direction does not spoil the power of a negative base in another") {
    using number = dual<double, partials<double, 2>>;
    const number base(-2.0, {{partial<double>(1.0), partial<double>::none()}});
    const number exponent(3.0, {{partial<double>::none(), partial<double>(1.0)}});
    const number power = pow(base, exponent);
    CHECK(power.value == -8);
    check_close(power.derivative.in[0].value, 12.0L);
    CHECK(std::isnan(power.derivative.in[1].value));
    CHECK(!is_finite(power));
    CHECK(is_finite(number(power.value)));
}

TEST_CASE("a quotient by what overflows has the derivative zero") {
    using second = dual<dual<double>>;
    using several = dual<double, partials<double, 2>>;
    const auto sigmoid = [](const auto& x) { return 1.0 / (1.0 + exp(x)); };
    const auto weighted = [](const auto& x) { return x / (1.0 + exp(x)); };
    for (const double at : {710.0, 800.0, 1e300}) {
        const dual<double> x(at, 3.0);
        CHECK(sigmoid(x).derivative == 0);
        CHECK(weighted(x).derivative == 0);
        CHECK(sigmoid(dual<double, partial<double>>(at, 3.0)).derivative == 0);
        const several both(at, {{partial<double>(3.0), partial<double>(-2.0)}});
        for (int i = 0; i < 2; ++i) CHECK(sigmoid(both).derivative.in[i] == 0);
        for (int i = 0; i < 2; ++i) CHECK(weighted(both).derivative.in[i] == 0);
        const second twice(dual<double>(at, 1.0), dual<double>(1.0, 0.0));
        CHECK(sigmoid(twice).derivative.derivative == 0);
        const dual<pack<double, 4>> lanes{pack<double, 4>(at), pack<double, 4>(3.0)};
        CHECK(get_lane(sigmoid(lanes), 2).derivative == 0);
    }
    check_close(sigmoid(dual<double>(600.0, 1.0)).derivative / std::exp(-600.0), -1.0L);
    CHECK(std::fabs(sigmoid(dual<double>(708.0, 1000.0)).derivative) < 1e-290);  // of which exp's is infinite alone
    CHECK(std::fabs(weighted(dual<double>(708.0, 1000.0)).derivative) < 1e-290);
    CHECK(std::isnan((1.0 / dual<double>(std::nan(""), 1.0)).derivative));
    CHECK(std::isinf((1.0 / dual<double>(0.0, 1.0)).derivative));
}

TEST_CASE("what becomes flat has the derivative zero where its argument overflows") {
    using several = dual<double, partials<double, 2>>;
    const auto all = [](const auto& x, auto&& check) {
        const auto large = 1.0 + exp(x);
        check(tanh(large)), check(tanh(-exp(x))), check(atan(large)), check(rsqrt(large)), check(reciprocal(large));
        check(pow(large, -2.0)), check(powr(large, -1.5)), check(pow(large, -decltype(large)(1.0)));
        check(expm1(-exp(x)));
    };
    for (const double at : {710.0, 800.0, 1e300}) {
        all(dual<double>(at, 3.0), [](const auto& f) { CHECK(f.derivative == 0); });
        all(dual<double, partial<double>>(at, 3.0), [](const auto& f) { CHECK(f.derivative == 0); });
        all(several(at, {{partial<double>(3.0), partial<double>(-2.0)}}), [](const auto& f) {
            for (int i = 0; i < 2; ++i) CHECK(f.derivative.in[i] == 0);
        });
        all(dual<pack<double, 4>>(pack<double, 4>(at), pack<double, 4>(3.0)),
            [](const auto& f) { CHECK(get_lane(f, 2).derivative == 0); });
    }
    // of which exp's is infinite alone
    all(dual<double>(709.0, 1000.0), [](const auto& f) { CHECK(std::fabs(f.derivative) < 1e-140); });
    // and none is lost that is not zero, or has no value otherwise
    const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
    const auto large = [](double v, double by) { return 1.0 + exp(dual<double>(v, by)); };
    CHECK(std::isinf(pow(large(709.0, 1000.0), -0.01).derivative));
    CHECK(std::isinf(sqrt(large(709.0, 1000.0)).derivative));
    CHECK(std::isnan(tanh(dual<double>(2.0, nan)).derivative));
    CHECK(std::isnan(pow(dual<double>(1e300, nan), -1.0).derivative));
    CHECK(std::isinf(tanh(dual<double>(2.0, infinity)).derivative));
    check_close(pow(large(100.0, 1.0), -1.5).derivative / std::exp(-150.0), -1.5L);
    check_close(pow(1.0 + dual<double>(1e10, 1.0), 2.0).derivative, 2.0L * (1.0L + 1e10L));
}

TEST_CASE("quotients whose parts are nearly too large have their derivatives, and lose none that is not") {
    const auto ratio = [](const auto& x) { return exp(x) / (1.0 + exp(x)); };
    CHECK(std::fabs(ratio(dual<double>(690.0, 1000.0)).derivative) < 1e-9);
    const dual<double, partials<double, 2>> both(690.0, {{partial<double>(1000.0), partial<double>(3.0)}});
    for (int i = 0; i < 2; ++i) CHECK(std::fabs(ratio(both).derivative.in[i]) < 1e-9);
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(std::isinf((1.0 / (1.0 + dual<double>(1.0, infinity))).derivative));
    CHECK(std::isnan((1.0 / dual<double>(1e300, std::nan(""))).derivative));
}

TEST_CASE("comparisons look at values alone, and select takes values with their derivatives") {
    const dual<double> a(1, 10);
    const dual<double> b(2, -20);
    REQUIRE(a < b);
    REQUIRE(a <= 1.0);
    REQUIRE(2.0 >= b);
    REQUIRE(b > a);
    REQUIRE(a == dual<double>(1, 7));
    REQUIRE(a != b);
    REQUIRE(myriad::select(a < b, a, b).derivative == 10);
    REQUIRE(myriad::select(a > 5.0, a, 0.0).derivative == 0);

    using P = pack<double, 2>;
    P value(1.0);
    set_lane(value, 1, 3.0);
    const dual<P> c(value, P(5.0));
    const auto chosen = myriad::select(c > 2.0, c, -c);
    REQUIRE(get_lane(chosen, 0).derivative == -5);
    REQUIRE(get_lane(chosen, 1).derivative == 5);
    REQUIRE(get_lane(chosen, 1).value == 3);
    REQUIRE(bits(c > 2.0) == 2);
    STATIC_REQUIRE(std::is_same_v<decltype(c > 2.0), myriad::mask_of<P>>);
}

TEST_CASE("a dual number is finite if value and derivative are") {
    const double infinity = std::numeric_limits<double>::infinity();
    REQUIRE(myriad::is_finite(dual<double>(1, 2)));
    REQUIRE(!myriad::is_finite(dual<double>(infinity, 2)));
    REQUIRE(!myriad::is_finite(dual<double>(1, infinity)));
    REQUIRE(!any(myriad::is_finite(dual<pack<double, 1>>(1.0, pack<double, 1>(infinity)))));
}

TEST_CASE("compound assignments and lanes of dual numbers change value and derivative") {
    dual<double> a(2, 1);
    a += 1;
    a *= a;
    a -= dual<double>(0, 1);
    a /= 3.0;
    REQUIRE(a.value == 3);
    REQUIRE(a.derivative == 5.0 / 3);
    dual<pack<float, 1>> p(1.0f);
    set_lane(p, 1, dual<float>(4, 5));
    REQUIRE(get_lane(p, 1).value == 4);
    REQUIRE(get_lane(p, 1).derivative == 5);
    REQUIRE(get_lane(p, 0).derivative == 0);
}

TEST_CASE("the traits of a dual number are those of what it is made of") {
    using P = pack<float, 2>;
    STATIC_REQUIRE(std::is_same_v<myriad::real_of<dual<P>>, float>);
    STATIC_REQUIRE(std::is_same_v<myriad::mask_of<dual<P>>, myriad::mask_of<P>>);
    STATIC_REQUIRE(std::is_same_v<myriad::integer_of<dual<P>>, myriad::integer_of<P>>);
    STATIC_REQUIRE(myriad::lanes_of<dual<P>> == P::lanes);
    STATIC_REQUIRE(std::is_same_v<decltype(dual<P>() + P()), dual<P>>);
    STATIC_REQUIRE(std::is_same_v<decltype(2 * dual<P>()), dual<P>>);
    STATIC_REQUIRE(std::is_same_v<decltype(2.0 * dual<float>()), dual<float>>);
    STATIC_REQUIRE(std::is_trivially_copyable_v<dual<double>>);
}

TEST_CASE("dual numbers of dual numbers have second derivatives") {
    using twice = dual<dual<double>>;
    // along one direction twice, and mixed with what is constant in the outer or in both derivatives
    const auto f = [](auto x, auto t) {
        using myriad::abs, myriad::copysign, myriad::exp, myriad::fma, myriad::log, myriad::max, myriad::min,
            myriad::pow, myriad::powr, myriad::sin, myriad::sqrt, myriad::tanh;
        return sin(x) * exp(2.0 * x) / (1.0 + x * x) + pow(x, 3) + powr(x, 2.5) + tanh(x * t) * log(x) +
               fma(x, t, 2.0) + sqrt(x) * t + abs(-x) + max(x, 0.1) - min(x, t) + myriad::cbrt(x) +
               myriad::reciprocal(x) + myriad::rsqrt(x) + myriad::asin(x * 0.5) + myriad::fmod(x, 0.5) +
               copysign(x, -1.0) + pow(x, t) + myriad::hypot(x, 2.0) + myriad::atan2(x, t);
    };
    // of the sixth order, of first derivatives by dual numbers
    const auto difference_of = [](auto slope) {
        const double h = 1e-3;
        return (45 * (slope(h) - slope(-h)) - 9 * (slope(2 * h) - slope(-2 * h)) + slope(3 * h) - slope(-3 * h)) /
               (60 * h);
    };
    const double x = 0.7, t = 1.3;
    const twice by_x = f(twice(dual<double>(x, 1), dual<double>(1, 0)), t);
    CHECK(by_x.value.value == f(x, t));
    CHECK(by_x.derivative.value == by_x.value.derivative);
    const double curvature = difference_of([&](double h) { return f(dual<double>(x + h, 1), t).derivative; });
    CHECK(std::abs(by_x.derivative.derivative - curvature) <= 1e-9 * std::abs(curvature));
    // t with the inner derivative alone
    const twice mixed = f(twice(dual<double>(x, 0), dual<double>(1, 0)), dual<double>(t, 1));
    const double by_both = difference_of([&](double h) { return f(dual<double>(x, 1), t + h).derivative; });
    CHECK(std::abs(mixed.derivative.derivative - by_both) <= 1e-9 * std::abs(by_both));
}

TEST_CASE("a derivative that is zero stays zero where the slope of a function is infinite") {
    const auto check = []<class S, class Derivative>(const char* name, auto f, S at, Derivative none) {
        const auto got = f(dual<S, Derivative>(at, none));
        CAPTURE(name);
        if constexpr (requires { got.derivative.in; }) {
            CHECK(get_lane(got.derivative.in[0].value, 0) == 0);
            CHECK(get_lane(got.derivative.in[1].value, 0) == 0);
        } else if constexpr (requires { got.derivative.derivative; }) {
            CHECK(got.derivative.value == 0);
            CHECK(got.derivative.derivative == 0);
        } else {
            CHECK(get_lane(static_cast<const S&>(got.derivative), 0) == 0);
        }
    };
    const auto of_all_kinds = [&](const char* name, double x, auto f) {
        check(name, f, x, 0.0);
        check(name, f, static_cast<float>(x), 0.0f);
        check(name, f, x, partial<double>(0.0));
        check(name, f, x, partials<double, 2>{{partial<double>(0.0), partial<double>(-0.0)}});
        check(name, f, pack<double, 2>(x), pack<double, 2>(0.0));
        check(name, f, pack<float, 2>(static_cast<float>(x)), pack<float, 2>(0.0f));
        check(name, f, dual<double>(x, 0.0), dual<double>(0.0, 0.0));
    };
#define CHECK_STAYS_ZERO(expression, ...)             \
    for (const double point : {__VA_ARGS__}) {        \
        of_all_kinds(#expression, point, [](auto x) { \
            using namespace myriad;                   \
            return expression;                        \
        });                                           \
    }
    CHECK_STAYS_ZERO(sqrt(x), 0.0)
    CHECK_STAYS_ZERO(sqrt(max(x, 0.0)), 0.0, -1.0)
    CHECK_STAYS_ZERO(cbrt(x), 0.0)
    CHECK_STAYS_ZERO(asin(x), 1.0, -1.0)
    CHECK_STAYS_ZERO(acos(x), 1.0, -1.0)
    CHECK_STAYS_ZERO(log(x), 0.0)
    CHECK_STAYS_ZERO(log2(x), 0.0)
    CHECK_STAYS_ZERO(log10(x), 0.0)
    CHECK_STAYS_ZERO(log1p(x), -1.0)
    CHECK_STAYS_ZERO(pow(x, 0.3), 0.0)
    CHECK_STAYS_ZERO(powr(x, 0.3), 0.0)
    CHECK_STAYS_ZERO(pow(x, x), 0.0)
    CHECK_STAYS_ZERO(hypot(x, x), 0.0)
    CHECK_STAYS_ZERO(atan2(x, x), 0.0)
    CHECK_STAYS_ZERO(exp(1.5 * log(x)), 0.0)
}

TEST_CASE("a weight that is zero makes a derivative zero, as that of a power of zero by its exponent") {
    const auto of_exponent = [](auto x) {
        return [x](auto n) {
            using namespace myriad;
            return pow(decltype(n)(x), n);
        };
    };
    for (const double n : {0.5, 1.0, 2.5}) {
        CHECK(of_exponent(0.0)(dual<double>(n, 1)).derivative == 0);
        CHECK(pow(0.0, dual<double>(n, 1)).derivative == 0);
        CHECK(pow(0.0f, dual<float>(static_cast<float>(n), 1)).derivative == 0);
        CHECK(get_lane(pow(dual<pack<double, 2>>(pack<double, 2>(0.0)), dual<pack<double, 2>>(n, 1)).derivative, 1) ==
              0);
        const auto twice = of_exponent(0.0)(dual<dual<double>>(dual<double>(n, 1), dual<double>(1, 0)));
        CHECK(twice.derivative.value == 0);
        CHECK(twice.derivative.derivative == 0);
        CHECK(exp(dual<double>(n, 1) * log(dual<double>(0.0))).derivative == 0);  // the same, as it is often written
    }
    CHECK(hypot(dual<double>(0, 3), dual<double>(0, 4)).derivative == 0);  // as of abs, one of those between -5 and 5
    CHECK(pow(dual<double>(0, 3), 1.0).derivative == 3);
    CHECK(pow(dual<double>(0, 3), dual<double>(1, 2)).derivative == 3);
}

TEST_CASE("a zero derivative of the first order has those of the second that it has by itself") {
    // sqrt(x^2) along x at a point where x' = 0 and x'' is not: the derivative of sqrt(u) u'
    using twice = dual<dual<double>>;
    const twice u(dual<double>(4, 0), dual<double>(0, 5));  // u' = 0, whose own derivative is 5
    CHECK(sqrt(u).derivative.derivative == 0.5 / 2 * 5);
    CHECK(log(u).derivative.derivative == 5.0 / 4);
    CHECK(pow(u, 0.5).derivative.derivative == Approx(0.5 / 2 * 5));
}
