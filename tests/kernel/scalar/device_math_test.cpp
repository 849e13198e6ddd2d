// SPDX-License-Identifier: MIT
// The branch-free functions on the device under test: errors in ulp against the next wider type.
#include <random>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/scalar/function_values.hpp"
#include "tests/kernel/scalar/ulp.hpp"
#include "tests/support/device.hpp"

namespace {

using function_values::values;
using tests::error_in_ulp;

/// The function values for the given arguments and exponents.
template <class R>
myriad::ensemble<values, R> evaluate(const std::vector<R>& x, R exponent) {
    myriad::ensemble<values, R> all(static_cast<std::int64_t>(x.size()));
    all.state(values::unused) = R(0);
    all.parameter(values::x) = Eigen::Map<const Eigen::Array<R, Eigen::Dynamic, 1>>(x.data(), all.size());
    all.parameter(values::y) = exponent;
    all.time_domain(0, 0);
    myriad::solve<myriad::runge_kutta_4>(tests::test_device(), all, {.step = 0.1});
    return all;
}

/// Arguments evenly between the bounds, or their powers of ten.
template <class R>
std::vector<R> spread(double low, double high, bool as_exponents) {
    std::mt19937_64 random(41);
    std::uniform_real_distribution<double> distribution(low, high);
    std::vector<R> x(20000);
    for (R& value : x)
        value = static_cast<R>(as_exponents ? std::pow(10.0, distribution(random)) : distribution(random));
    return x;
}

template <class R, class Truth>
double worst(const myriad::ensemble<values, R>& all, values::accessory which, Truth&& truth) {
    double largest = 0;
    for (std::int64_t i = 0; i < all.size(); ++i) {
        const auto x = static_cast<tests::wider<R>>(all.parameter(values::x)[i]);
        largest = std::fmax(largest, error_in_ulp<R>(all.accessory(which)[i], truth(x)));
    }
    return largest;
}

}  // namespace

TEMPLATE_TEST_CASE("powr errs by at most 1.2 + |y| / 5 ulps on the device", "", double, float) {
    using R = TestType;
    using W = tests::wider<R>;
    const double decades = sizeof(R) == 8 ? 250 : 30;
    for (const double y : {0.5, 1.4, -1.4, 4.2, -4.2, -7.0, 13.7}) {
        const R exponent = static_cast<R>(y);
        const double reach = decades / std::fmax(1, std::fabs(y));
        for (const double range : {0.3, reach}) {
            CAPTURE(sizeof(R), y, range);
            const auto all = evaluate<R>(spread<R>(-range, range, true), exponent);
            CHECK(worst(all, values::power, [&](W x) { return std::pow(x, static_cast<W>(exponent)); }) <=
                  (MYRIAD_FUSED || !tests::tests_cpu() ? 1.2 + std::fabs(y) / 5 : 1.5 + std::fabs(y) / 2));
        }
    }
}

TEMPLATE_TEST_CASE("reciprocal errs by at most one ulp on the device", "", double, float) {
    using R = TestType;
    using W = tests::wider<R>;
    const double decades = sizeof(R) == 8 ? 300 : 36;
    const auto all = evaluate<R>(spread<R>(-decades, decades, true), 1);
    CHECK(worst(all, values::inverse, [](W x) { return 1 / x; }) <= 1);
}

TEMPLATE_TEST_CASE("rsqrt errs by at most 1.5 ulps on the device, 2 in single precision", "", double, float) {
    using R = TestType;
    using W = tests::wider<R>;
    for (const double decades : {0.6, sizeof(R) == 8 ? 307.0 : 37.0}) {
        CAPTURE(decades);
        std::vector<R> positive = spread<R>(-decades, decades, true);
        for (R& x : positive) x = std::fabs(x);
        const auto all = evaluate<R>(positive, 1);
        CHECK(worst(all, values::inverse_root, [](W x) { return 1 / std::sqrt(x); }) <= (sizeof(R) == 8 ? 1.5 : 2));
    }
}

TEMPLATE_TEST_CASE("sincos and sincospi err by at most 2.5 and 2 ulps on the device", "", double, float) {
    using R = TestType;
    using W = tests::wider<R>;
    for (const double range : {0.8, 60.0, 8000.0}) {
        CAPTURE(sizeof(R), range);
        const auto all = evaluate<R>(spread<R>(-range, range, false), 1);
        CHECK(worst(all, values::sine, [](W x) { return std::sin(x); }) <= 2.5);
        CHECK(worst(all, values::cosine, [](W x) { return std::cos(x); }) <= 2.5);
        CHECK(worst(all, values::sine_pi, [](W x) { return tests::wide_sinpi(x); }) <= 2);
        CHECK(worst(all, values::cosine_pi, [](W x) { return tests::wide_cospi(x); }) <= 2);
    }
}

TEST_CASE("sin and cos err by at most 2.1 ulps on the device, at any angle") {
    for (const double range : {0.8, 60.0, 8000.0, 1e9, 1e12, 1e15, 1e22}) {
        CAPTURE(range);
        const auto all = evaluate<double>(spread<double>(-range, range, false), 1);
        CHECK(worst(all, values::sine_alone, [](long double x) { return std::sin(x); }) <= 2.1);
        CHECK(worst(all, values::cosine_alone, [](long double x) { return std::cos(x); }) <= 2.1);
    }
}

TEMPLATE_TEST_CASE(
    "sqrt is rounded correctly on the device, but for single precision on GPUs, and special values are "
    "those of the standard",
    "", double, float) {
    using R = TestType;
    using limits = std::numeric_limits<R>;
    std::vector<R> x = spread<R>(sizeof(R) == 8 ? -307 : -37, sizeof(R) == 8 ? 308 : 38, true);
    const std::vector<R> near_one = spread<R>(0.25, 4, false);
    x.insert(x.end(), near_one.begin(), near_one.end());
    // squares, and their neighbours, whose roots are close to a change of rounding
    for (int k = 1; k < 2000; ++k) {
        const R square = static_cast<R>(k) * static_cast<R>(k);
        x.insert(x.end(), {square, std::nextafter(square, limits::max()), std::nextafter(square, R(0))});
    }
    if (sizeof(R) == 8)  // float subnormals count as zero on some devices
        x.insert(x.end(), {limits::denorm_min(), 3 * limits::denorm_min(), limits::min() / 2});
    x.insert(x.end(), {R(0), -R(0), limits::min(), limits::max()});
    const auto all = evaluate<R>(x, 1);
    std::int64_t wrong = 0;
    for (std::int64_t i = 0; i < all.size(); ++i) {
        const R got = all.accessory(values::root)[i], wanted = std::sqrt(x[static_cast<std::size_t>(i)]);
        if (got == wanted && std::signbit(got) == std::signbit(wanted)) continue;
        if (sizeof(R) == 4 && !tests::tests_cpu() && error_in_ulp<R>(got, tests::wider<R>(wanted)) <= 1) continue;
        ++wrong;
        CAPTURE(x[static_cast<std::size_t>(i)], got, wanted);
        CHECK(got == wanted);
    }
    CHECK(wrong == 0);
    const auto negative = evaluate<R>({R(-1), -limits::min()}, 1);
    CHECK(negative.accessory(values::root).isNaN().all());
}

namespace {

using function_values::elementary;

myriad::ensemble<elementary, float> evaluate_elementary(const std::vector<float>& x, const std::vector<float>& y) {
    myriad::ensemble<elementary, float> all(static_cast<std::int64_t>(x.size()));
    all.state(elementary::unused) = 0.0f;
    all.parameter(elementary::x) = Eigen::Map<const Eigen::ArrayXf>(x.data(), all.size());
    all.parameter(elementary::y) = Eigen::Map<const Eigen::ArrayXf>(y.data(), all.size());
    const auto replace = [](auto&& values, auto&& kinds) {
        for (std::int64_t i = 0; i < values.size(); ++i) {
            kinds[i] = std::isinf(values[i])   ? elementary::infinite
                       : std::isnan(values[i]) ? elementary::not_a_number
                                               : 0;
            if (kinds[i] != 0) values[i] = std::copysign(1.0f, values[i]);
        }
    };
    replace(all.parameter(elementary::x), all.parameter(elementary::kind_of_x));
    replace(all.parameter(elementary::y), all.parameter(elementary::kind_of_y));
    all.time_domain(0, 0);
    myriad::solve<myriad::runge_kutta_4>(tests::test_device(), all, {.step = 0.1});
    return all;
}

/// In the order of elementary::accessory, in double precision.
using function_of_two = double (*)(double, double);
constexpr function_of_two exact_functions[] = {[](double x, double) { return std::exp(x); },
                                               [](double x, double) { return std::exp2(x); },
                                               [](double x, double) { return std::log(x); },
                                               [](double x, double) { return std::log2(x); },
                                               [](double x, double) { return std::log10(x); },
                                               [](double x, double) { return std::sin(x); },
                                               [](double x, double) { return std::cos(x); },
                                               [](double x, double) { return std::tan(x); },
                                               [](double x, double) { return std::tanh(x); },
                                               [](double x, double) { return std::sinh(x); },
                                               [](double x, double) { return std::cosh(x); },
                                               [](double x, double) { return std::expm1(x); },
                                               [](double x, double) { return std::log1p(x); },
                                               [](double x, double) { return std::sqrt(x); },
                                               [](double x, double y) { return std::pow(x, y); },
                                               [](double x, double y) { return x / y; },
                                               [](double x, double) { return 1 / x; },
                                               [](double x, double) { return x / 10; },
                                               [](double x, double y) { return std::atan2(x, y); }};
static_assert(std::size(exact_functions) == elementary::n_accessory);

/// The error of a function relative to its value, and where that is zero or subnormal to the smallest normal number.
double relative_error(float got, double wanted) {
    constexpr float smallest = std::numeric_limits<float>::min(), largest = std::numeric_limits<float>::max();
    if (std::isnan(wanted) || std::isnan(got)) return std::isnan(wanted) && std::isnan(got) ? 0 : 1e30;
    if (std::fabs(wanted) > largest * (1 + 1e-6))
        return std::isinf(got) && std::signbit(got) == std::signbit(wanted) ? 0 : 1e30;
    if (std::fabs(wanted) > largest * (1 - 1e-6) && std::isinf(got)) return 0;
    if (std::fabs(wanted) < smallest)
        return std::fabs(got) <= smallest && std::signbit(got) == std::signbit(wanted) ? 0 : 1e30;
    return std::fabs(static_cast<double>(got) - wanted) / std::fabs(wanted);
}

}  // namespace

TEST_CASE(
    "functions and quotients in single precision err by at most 1e-6 on the device, of sine and cosine absolutely") {
    for (const double range : {1.0, 30.0, 1e5, 1e30}) {
        std::vector<float> x = spread<float>(-range, range, false), y = spread<float>(-30, 30, false);
        const std::vector<float> sizes = spread<float>(-30, 30, true);
        if (range > 1e5) x = sizes;
        const auto all = evaluate_elementary(x, y);
        for (int which = 0; which < elementary::n_accessory; ++which) {
            double worst = 0;
            for (std::int64_t i = 0; i < all.size(); ++i) {
                const double a = x[static_cast<std::size_t>(i)], b = y[static_cast<std::size_t>(i)];
                const float got = all.accessory(which)[i];
                const double wanted = exact_functions[which](a, b);
                const bool wave = which == elementary::sin || which == elementary::cos;
                const double error = wave ? std::fabs(got - wanted) : relative_error(got, wanted);
                if (!(error <= worst)) worst = error;
            }
            CAPTURE(range, which);
            CHECK(worst <= 1e-6);
        }
    }
}

TEST_CASE(
    "functions in single precision of NaN, infinities, zeros, subnormal and huge numbers are those of the standard "
    "library on the device") {
    using limits = std::numeric_limits<float>;
    constexpr elementary::accessory of_one[] = {elementary::exp,  elementary::exp2,  elementary::log,
                                                elementary::log2, elementary::log10, elementary::sin,
                                                elementary::cos,  elementary::tan,   elementary::root};
    const std::vector<float> special{limits::infinity(),
                                     -limits::infinity(),
                                     limits::quiet_NaN(),
                                     0.0f,
                                     -0.0f,
                                     1.0f,
                                     -1.0f,
                                     2.0f,
                                     -3.0f,
                                     2.5f,
                                     1e-40f,
                                     -1e-40f,
                                     limits::min(),
                                     limits::max(),
                                     -limits::max(),
                                     1e10f,
                                     -1e20f,
                                     88.8f,
                                     -104.5f,
                                     128.5f,
                                     131071.0f,
                                     131072.0f};
    std::vector<float> x, y;
    for (const float a : special)
        for (const float b : special) x.push_back(a), y.push_back(b);
    const auto all = evaluate_elementary(x, y);
    for (std::int64_t i = 0; i < all.size(); ++i) {
        const double a = x[static_cast<std::size_t>(i)], b = y[static_cast<std::size_t>(i)];
        CAPTURE(a, b);
        for (const int which : of_one) {
            CAPTURE(which);
            const bool wave = which == elementary::sin || which == elementary::cos;
            const float got = all.accessory(which)[i];
            const double wanted = exact_functions[which](a, b);
            CHECK((relative_error(got, wanted) <= 1e-6 || (wave && wanted != 0 && std::fabs(got - wanted) <= 1e-6)));
        }
        for (const int which : {int(elementary::pow), int(elementary::quotient), int(elementary::angle)}) {
            CAPTURE(which);
            CHECK(relative_error(all.accessory(which)[i], exact_functions[which](a, b)) <= 1e-6);
        }
    }
}

TEST_CASE("min and max choose on the device") {
    const auto all = evaluate<double>({-1, 0, 1, 2, 3}, 1);
    CHECK((all.accessory(values::smaller) == Eigen::ArrayXd{{-1, 0, 1, 1, 1}}).all());
    CHECK((all.accessory(values::larger) == Eigen::ArrayXd{{1, 1, 1, 2, 3}}).all());
}

TEST_CASE("powr of zero, infinity, negative numbers and beyond the range is that of IEEE 754 on the device") {
    const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> x{0, 1e200, 1e-200, std::numeric_limits<double>::denorm_min(), 2};
    const auto check = [&](double y, const std::vector<double>& wanted) {
        const auto all = evaluate<double>(x, y);
        for (std::size_t i = 0; i < x.size(); ++i) {
            CAPTURE(x[i], y);
            const double got = all.accessory(values::power)[static_cast<std::int64_t>(i)];
            CHECK((got == wanted[i] || (std::isnan(got) && std::isnan(wanted[i]))));
        }
    };
    check(2, {0, inf, 0, 0, 4});
    check(-2, {inf, 0, inf, inf, 0.25});
    check(0, {nan, 1, 1, nan, 1});
    const auto negative = evaluate<double>({-1}, 2);
    CHECK(std::isnan(negative.accessory(values::power)[0]));
}

TEST_CASE("sincos and sincospi are NaN, and not wrong, beyond their range on the device") {
    const auto all = evaluate<double>({0x1p31, 0x1.8p50, -0x1.8p50}, 1);
    CHECK(all.accessory(values::sine).isNaN().all());
    CHECK(all.accessory(values::cosine).isNaN().all());
    CHECK(all.accessory(values::sine_pi).tail(2).isNaN().all());
    CHECK(all.accessory(values::cosine_pi).tail(2).isNaN().all());
}
