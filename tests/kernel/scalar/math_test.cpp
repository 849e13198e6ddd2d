// SPDX-License-Identifier: MIT
// The elementary functions of plain numbers and packs: accuracy in ulp against the next wider type, special values
// against the standard library, and above all that a lane's result never depends on its neighbours.

#include "myriad/kernel/scalar/math.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"
#include "tests/kernel/scalar/ulp.hpp"

using myriad::detail::all;
using myriad::detail::get_lane;
using myriad::detail::set_lane;

namespace {

using myriad::pack;
using namespace tests;

template <class T>
bool same_bits(T a, T b) {
    if (std::isnan(a) && std::isnan(b)) return true;
    using bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
    return std::bit_cast<bits>(a) == std::bit_cast<bits>(b);
}

// One function: how to call it, its name in messages, the scalar and the wide version.
#define FUNCTION(name, wide_expression)            \
    struct name##_function {                       \
        static constexpr const char* text = #name; \
        template <class S>                         \
        static S of(const S& x) {                  \
            using myriad::name;                    \
            return name(x);                        \
        }                                          \
        template <class W>                         \
        static W wide(W x) {                       \
            return wide_expression;                \
        }                                          \
    };
FUNCTION(sqrt, std::sqrt(x))
FUNCTION(cbrt, std::cbrt(x))
FUNCTION(abs, std::fabs(x))
FUNCTION(floor, std::floor(x))
FUNCTION(round, std::round(x))
FUNCTION(rint, std::rint(x))
FUNCTION(sin, std::sin(x))
FUNCTION(cos, std::cos(x))
FUNCTION(tan, std::tan(x))
FUNCTION(asin, std::asin(x))
FUNCTION(acos, std::acos(x))
FUNCTION(atan, std::atan(x))
FUNCTION(sinpi, wide_sinpi(x))
FUNCTION(cospi, wide_cospi(x))
FUNCTION(sinh, std::sinh(x))
FUNCTION(cosh, std::cosh(x))
FUNCTION(tanh, std::tanh(x))
FUNCTION(exp, std::exp(x))
FUNCTION(exp2, std::exp2(x))
FUNCTION(log, std::log(x))
FUNCTION(log2, std::log2(x))
FUNCTION(log10, std::log10(x))
FUNCTION(expm1, std::expm1(x))
FUNCTION(log1p, std::log1p(x))
FUNCTION(reciprocal, 1 / x)
FUNCTION(rsqrt, 1 / std::sqrt(x))
#undef FUNCTION

// The two results of one call, as functions of their own.
#define FUNCTION(name, call, member, wide_expression) \
    struct name##_function {                          \
        static constexpr const char* text = #name;    \
        template <class S>                            \
        static S of(const S& x) {                     \
            return myriad::call(x).member;            \
        }                                             \
        template <class W>                            \
        static W wide(W x) {                          \
            return wide_expression;                   \
        }                                             \
    };
FUNCTION(sine_of_both, sincos, sine, std::sin(x))
FUNCTION(cosine_of_both, sincos, cosine, std::cos(x))
FUNCTION(sine_of_both_pi, sincospi, sine, wide_sinpi(x))
FUNCTION(cosine_of_both_pi, sincospi, cosine, wide_cospi(x))
#undef FUNCTION

#define FUNCTION(name, wide_expression)            \
    struct name##_function {                       \
        static constexpr const char* text = #name; \
        template <class S>                         \
        static S of(const S& x, const S& y) {      \
            using myriad::name;                    \
            return name(x, y);                     \
        }                                          \
        template <class W>                         \
        static W wide(W x, W y) {                  \
            return wide_expression;                \
        }                                          \
    };
FUNCTION(min, std::fmin(x, y))
FUNCTION(max, std::fmax(x, y))
FUNCTION(copysign, std::copysign(x, y))
FUNCTION(atan2, std::atan2(x, y))
FUNCTION(hypot, std::hypot(x, y))
FUNCTION(fmod, std::fmod(x, y))
FUNCTION(pow, std::pow(x, y))
FUNCTION(powr, std::pow(x, y))
#undef FUNCTION

// The only place where a function is called with a kind of number; otherwise each test would compile all of them again.
template <class F, class S, class... More>
[[gnu::noinline]] void evaluate(S& result, const S& x, const More&... more) {
    result = F::of(x, more...);
}

template <class Check>
void for_unary_functions(Check check) {
    check(sqrt_function{});
    check(cbrt_function{});
    check(abs_function{});
    check(floor_function{});
    check(round_function{});
    check(rint_function{});
    check(sin_function{});
    check(cos_function{});
    check(tan_function{});
    check(asin_function{});
    check(acos_function{});
    check(atan_function{});
    check(sinpi_function{});
    check(cospi_function{});
    check(sinh_function{});
    check(cosh_function{});
    check(tanh_function{});
    check(exp_function{});
    check(exp2_function{});
    check(log_function{});
    check(log2_function{});
    check(log10_function{});
    check(expm1_function{});
    check(log1p_function{});
    check(reciprocal_function{});
    check(rsqrt_function{});
}
template <class Check>
void for_binary_functions(Check check) {
    check(min_function{});
    check(max_function{});
    check(copysign_function{});
    check(atan2_function{});
    check(hypot_function{});
    check(fmod_function{});
    check(pow_function{});
}
template <class Check>
void for_sizes(Check check) {
    check.template operator()<1>();
    check.template operator()<2>();
#if !defined(MYRIAD_ONE_BATCH)  // else preset strict has them, of AVX2, for which packs may be so large
    check.template operator()<3>();
    check.template operator()<4>();
#endif
}

/// Numbers that functions, reductions or neighbours treat specially.
template <class T>
std::vector<T> special_values() {
    using limits = std::numeric_limits<T>;
    const T huge = std::is_same_v<T, double> ? T(1e300L) : T(1e30f);
    return {T(0),
            T(-0.0),
            limits::infinity(),
            -limits::infinity(),
            limits::quiet_NaN(),
            limits::denorm_min(),
            -limits::denorm_min(),
            T(3) * limits::denorm_min(),
            limits::min() / 2,
            limits::min(),
            limits::max(),
            limits::lowest(),
            huge,
            -huge,
            T(1) / huge,
            T(1e7),
            T(-1e7),
            T(1e5),
            T(70),
            T(-70),
            T(800),
            T(-800)};
}

/// The special values, pi/4 with its neighbours, multiples of pi/2 and of 20 pi, where argument reductions change, and
/// numbers in between.
template <class T>
std::vector<T> arguments() {
    std::vector<T> values = special_values<T>();
    const T pi = T(3.14159265358979323846L);
    for (const T x : {pi / 4, pi / 2, 3 * pi / 4, pi, 20 * pi, T(0.5), T(1), T(0.625), T(2), T(3)}) {
        T below = x;
        T above = x;
        for (int k = 0; k < 3; ++k) {
            values.insert(values.end(), {below, above, -below, -above});
            below = std::nextafter(below, T(0));
            above = std::nextafter(above, T(10000));
        }
    }
    for (const double x :
         {0.1, 0.3, 0.69, 1.3, 2.5, 4.7, 7.3, 12.9, 33.3, 62.0, 64.0, 333.3, 1234.5, 45678.9, 234567.8}) {
        values.insert(values.end(), {T(x), T(-x)});
    }
    return values;
}

}  // namespace

TEST_CASE("a lane's result does not depend on its neighbours nor on the pack's size") {
    const auto of_type = []<class T>(T) {
        const std::vector<T> all_arguments = arguments<T>();
        const std::vector<T> neighbours = special_values<T>();
        for_unary_functions([&]<class F>(F) {
            for (const T x : all_arguments) {
                using one = pack<T, 1>;
                one alone;
                evaluate<F>(alone, one(x));
                const T expected = get_lane(alone, 0);
                for_sizes([&]<int batches>() {
                    using P = pack<T, batches>;
                    for (const T neighbour : neighbours) {
                        for (const int lane : {0, P::lanes / 2, P::lanes - 1}) {
                            P argument(neighbour);
                            set_lane(argument, lane, x);
                            P result;
                            evaluate<F>(result, argument);
                            const T got = get_lane(result, lane);
                            if (!same_bits(got, expected)) {
                                CAPTURE(F::text, sizeof(T), batches, lane, x, neighbour, got, expected);
                                FAIL();
                            }
                        }
                    }
                });
            }
        });
        const std::vector<T> bases{T(0),
                                   T(-0.0),
                                   T(0.3),
                                   T(1),
                                   T(-2),
                                   T(7.7),
                                   std::numeric_limits<T>::denorm_min(),
                                   std::numeric_limits<T>::max(),
                                   std::numeric_limits<T>::infinity(),
                                   std::numeric_limits<T>::quiet_NaN()};
        for_binary_functions([&]<class F>(F) {
            for (const T x : bases) {
                for (const T y : {T(0), T(1.4), T(-3), T(0.5), T(200)}) {
                    using one = pack<T, 1>;
                    one alone;
                    evaluate<F>(alone, one(x), one(y));
                    const T expected = get_lane(alone, 0);
                    for_sizes([&]<int batches>() {
                        using P = pack<T, batches>;
                        for (const T neighbour : neighbours) {
                            const int lane = P::lanes - 1;
                            P a(neighbour);
                            P b(T(2.5));
                            set_lane(a, lane, x);
                            set_lane(b, lane, y);
                            P result;
                            evaluate<F>(result, a, b);
                            const T got = get_lane(result, lane);
                            if (!same_bits(got, expected)) {
                                CAPTURE(F::text, sizeof(T), batches, x, y, neighbour, got, expected);
                                FAIL();
                            }
                        }
                    });
                }
            }
        });
    };
    of_type(double{});
    of_type(float{});
    SUCCEED();
}

TEST_CASE("random neighbours leave a lane's result alone") {
    // As above with lanes that differ, so that a path taken by the majority would show too.
    std::mt19937_64 random(5);
    const auto of_type = [&]<class T>(T) {
        using P = pack<T, 4>;
        for_unary_functions([&]<class F>(F) {
            for (int round = 0; round < 200; ++round) {
                P argument;
                for (int i = 0; i < P::lanes; ++i) {
                    const double exponent =
                        std::uniform_real_distribution<double>(-3, round % 2 == 0 ? 1.8 : 7)(random);
                    set_lane(argument, i, static_cast<T>((random() % 2 == 0 ? 1 : -1) * std::pow(10.0, exponent)));
                }
                P result;
                evaluate<F>(result, argument);
                for (int i = 0; i < P::lanes; ++i) {
                    using one = pack<T, 1>;
                    one alone;
                    evaluate<F>(alone, one(get_lane(argument, i)));
                    if (!same_bits(get_lane(result, i), get_lane(alone, 0))) {
                        CAPTURE(F::text, sizeof(T), i, get_lane(argument, i), get_lane(result, i), get_lane(alone, 0));
                        FAIL();
                    }
                }
            }
        });
    };
    of_type(double{});
    of_type(float{});
    SUCCEED();
}

namespace {

struct expression_function {
    // As in a model: products before and after the functions, which a compiler may fuse with operations inside them.
    template <class S>
    static S of(const S& x) {
        using namespace myriad;
        const S a = 0.37f * x;
        return 1.7f * cos(a) + sin(1.1f * a) * a + 2 * exp(-a * a) * x + 1 + log(1 + a * a) * pow(2 + cos(x), 1.4f) -
               tanh(a) * a;
    }
};

}  // namespace

TEST_CASE("an expression gives the same bits in every pack size and lane") {
    const auto of_type = []<class T>(T) {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> distribution(-9, 9);
        for (int k = 0; k < 200; ++k) {
            const T x = static_cast<T>(distribution(random));
            using one = pack<T, 1>;
            one alone;
            evaluate<expression_function>(alone, one(x));
            for_sizes([&]<int batches>() {
                using P = pack<T, batches>;
                P argument;
                for (int i = 0; i < P::lanes; ++i) set_lane(argument, i, static_cast<T>(distribution(random)));
                const int lane = k % P::lanes;
                set_lane(argument, lane, x);
                P result;
                evaluate<expression_function>(result, argument);
                CAPTURE(sizeof(T), batches, x);
                REQUIRE(same_bits(get_lane(result, lane), get_lane(alone, 0)));
            });
        }
    };
    of_type(double{});
    of_type(float{});
}

namespace {

enum class spacing { linear, logarithmic };

/// The largest error of packs over a range, in ulp.
template <class T, class F>
double worst_error(double low, double high, spacing kind) {
    using P = pack<T, 2>;
    std::mt19937_64 random(17);
    if (kind == spacing::logarithmic) low = std::log(low), high = std::log(high);
    std::uniform_real_distribution<double> distribution(low, high);
    double worst = 0;
    for (int k = 0; k < 20000; k += P::lanes) {
        P x;
        for (int i = 0; i < P::lanes; ++i) {
            const double value = distribution(random);
            set_lane(x, i, static_cast<T>(kind == spacing::logarithmic ? std::exp(value) : value));
        }
        P y;
        evaluate<F>(y, x);
        for (int i = 0; i < P::lanes; ++i) {
            worst = std::fmax(worst, error_in_ulp<T>(get_lane(y, i), F::wide(static_cast<wider<T>>(get_lane(x, i)))));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("packs are accurate to the documented ulps") {
    // The bounds are those of pack_math.hpp, obtained from a larger sample on three instruction sets.
    const auto of_type = []<class T>(T) {
        const double big = std::is_same_v<T, double> ? 1e300 : 1e37;
        const double exponent = std::is_same_v<T, double> ? 700 : 86;
        const auto check = [](auto f, double bound, double low, double high, spacing kind = spacing::linear) {
            using F = decltype(f);
            CAPTURE(F::text, sizeof(T), low, high);
            CHECK(worst_error<T, F>(low, high, kind) <= bound);
        };
        for (const double range : {0.8, 60.0, 1e4, 1e6}) {
            check(sin_function{}, 2.5, -range, range);
            check(cos_function{}, 2.5, -range, range);
            check(tan_function{}, 3.5, -range, range);
        }
        for (const double range : {0.5, 3.0, 1000.0}) {
            check(sinpi_function{}, 2, -range, range);
            check(cospi_function{}, 2, -range, range);
        }
        check(asin_function{}, 2.5, -1, 1);
        check(acos_function{}, 1.5, -1, 1);
        check(atan_function{}, 2.5, -4, 4);
        check(atan_function{}, 2.5, 1 / big, big, spacing::logarithmic);
        for (const double range : {1.0, exponent}) {
            check(sinh_function{}, 2.5, -range, range);
            check(cosh_function{}, 2.1, -range, range);
            check(tanh_function{}, 1.5, -range / 20, range / 20);
            check(exp_function{}, 1.1, -range, range);
            check(exp2_function{}, 1.2, -range, range);
        }
        check(log_function{}, 1, 0.5, 2);
        check(log_function{}, 1, 1 / big, big, spacing::logarithmic);
        check(log2_function{}, 2, 0.5, 2);
        check(log2_function{}, 2, 1 / big, big, spacing::logarithmic);
        check(log10_function{}, 2, 0.5, 2);
        check(log10_function{}, 2, 1 / big, big, spacing::logarithmic);
        check(sqrt_function{}, 0.5, 1 / big, big, spacing::logarithmic);
        check(cbrt_function{}, 1, 1 / big, big, spacing::logarithmic);
        check(abs_function{}, 0, -big, big);
        check(floor_function{}, 0, -100, 100);
        check(round_function{}, 0, -100, 100);
        check(rint_function{}, 0, -100, 100);
        for (const double range : {1e-3, 1.0, exponent}) check(expm1_function{}, 2, -range, range);
        for (const double range : {1e-3, 0.5}) check(log1p_function{}, 2, -range, range);
        check(log1p_function{}, 2, 1 / big, big, spacing::logarithmic);
    };
    of_type(double{});
    of_type(float{});
}

TEST_CASE("pow of packs keeps its accuracy where the result is huge or tiny") {
    const auto of_type = []<class T>(T) {
        using P = pack<T, 2>;
        std::mt19937_64 random(23);
        const double decades = std::is_same_v<T, double> ? 250 : 30;
        for (const double y : {0.5, 1.0 / 3, 1.4, -1.4, 2.0, 3.0, -7.0, 13.7, 30.0, 99.5}) {
            std::uniform_real_distribution<double> distribution(-decades / std::fabs(y), decades / std::fabs(y));
            double worst = 0;
            for (int k = 0; k < 4000; k += P::lanes) {
                P x;
                for (int i = 0; i < P::lanes; ++i) set_lane(x, i, static_cast<T>(std::pow(10.0, distribution(random))));
                P result;
                evaluate<pow_function>(result, x, P(static_cast<T>(y)));
                for (int i = 0; i < P::lanes; ++i) {
                    const auto wanted =
                        std::pow(static_cast<wider<T>>(get_lane(x, i)), static_cast<wider<T>>(static_cast<T>(y)));
                    worst = std::fmax(worst, error_in_ulp<T>(get_lane(result, i), wanted));
                }
            }
            CAPTURE(sizeof(T), y);
            CHECK(worst <= 1.5 + std::fabs(y) / 80);
        }
    };
    of_type(double{});
    of_type(float{});
}

TEST_CASE("sincos and sincospi are accurate to the documented ulps, in packs and plain numbers") {
    const auto of_type = []<class T>(T) {
        const auto check = [](auto f, double bound, double range) {
            using F = decltype(f);
            CAPTURE(F::text, sizeof(T), range);
            CHECK(worst_error<T, F>(-range, range, spacing::linear) <= bound);
            std::mt19937_64 random(31);
            std::uniform_real_distribution<double> distribution(-range, range);
            double worst = 0;
            for (int k = 0; k < 4000; ++k) {
                const T x = static_cast<T>(distribution(random));
                worst = std::fmax(worst, error_in_ulp<T>(F::of(x), F::wide(static_cast<wider<T>>(x))));
            }
            CHECK(worst <= bound);
        };
        for (const double range : {0.8, 60.0, 1e4, 1e6}) {
            if (range > myriad::detail::trigonometry_constants<T>::limit) continue;
            check(sine_of_both_function{}, 2.5, range);
            check(cosine_of_both_function{}, 2.5, range);
        }
        for (const double range : {0.5, 3.0, 1000.0}) {
            check(sine_of_both_pi_function{}, 2, range);
            check(cosine_of_both_pi_function{}, 2, range);
        }
    };
    of_type(double{});
    of_type(float{});
}

TEST_CASE("the sine and cosine of GPUs err by at most 2.1 ulps, near their zeros too, and keep the sign of zero") {
    using gpu = myriad::detail::half_wave<double>;
    double worst = 0;
    const auto compare = [&](double x) {
        worst = std::fmax(worst, error_in_ulp<double>(gpu::sin(x), std::sin(static_cast<long double>(x))));
        worst = std::fmax(worst, error_in_ulp<double>(gpu::cos(x), std::cos(static_cast<long double>(x))));
    };
    std::mt19937_64 random(43);
    for (const double range : {0.8, 3.0, 60.0, 1e4, 1e9, gpu::limit}) {
        CAPTURE(range);
        std::uniform_real_distribution<double> distribution(-range, range);
        worst = 0;
        for (int k = 0; k < 20000; ++k) compare(distribution(random));
        CHECK(worst <= 2.1);
    }
    worst = 0;
    for (double quarters = 1; quarters < gpu::limit / 2; quarters = std::floor(quarters * 1.01) + 1) {
        const auto root = static_cast<double>(quarters * (std::acos(-1.0L) / 2));
        for (const double x : {std::nextafter(root, 0), root, std::nextafter(root, 2 * root)}) compare(x);
    }
    CHECK(worst <= 2.1);
    CHECK(gpu::sin(0) == 0);
    CHECK(std::signbit(gpu::sin(-0.0)));
    CHECK(gpu::cos(0) == 1);
    CHECK(std::isnan(gpu::sin(std::numeric_limits<double>::quiet_NaN())));
    CHECK(std::isnan(gpu::cos(std::numeric_limits<double>::infinity())));
}

TEST_CASE("sincos and sincospi are NaN, and not wrong, beyond their range") {
    const auto of_type = []<class T>(T) {
        const T angle = std::is_same_v<T, double> ? T(0x1.0p31) : T(0x1.0p17);
        const T half_turns = std::is_same_v<T, double> ? T(0x1.8p50) : T(0x1.8p21);
        for (const T x : {angle, half_turns, -half_turns, std::numeric_limits<T>::infinity(),
                          std::numeric_limits<T>::quiet_NaN()}) {
            CHECK(std::isnan(myriad::sincos(x).sine));
            CHECK(std::isnan(get_lane(myriad::sincos(pack<T, 1>(x)).cosine, 0)));
            if (std::fabs(x) == angle) continue;
            CHECK(std::isnan(myriad::sincospi(x).cosine));
            CHECK(std::isnan(get_lane(myriad::sincospi(pack<T, 1>(x)).sine, 0)));
        }
    };
    of_type(double{});
    of_type(float{});
}

TEST_CASE("powr errs by at most 1.2 + |y| / 5 ulps, in packs and plain numbers, with the same bits") {
    const auto of_type = []<class T>(T) {
        using P = pack<T, 2>;
        std::mt19937_64 random(37);
        const double decades = std::is_same_v<T, double> ? 250 : 30;
        for (const double y : {0.5, 1.0 / 3, 1.4, -1.4, 2.0, 4.2, -4.2, -7.0, 13.7, 99.5}) {
            std::uniform_real_distribution<double> far(-1, 1), near(-0.3, 0.3);
            const double reach = decades / std::fmax(1, std::fabs(y));
            double worst = 0;
            for (int k = 0; k < 8000; k += P::lanes) {
                P x;
                for (int i = 0; i < P::lanes; ++i)
                    set_lane(x, i, static_cast<T>(std::pow(10.0, k % 3 == 0 ? near(random) : reach * far(random))));
                P result;
                evaluate<powr_function>(result, x, P(static_cast<T>(y)));
                for (int i = 0; i < P::lanes; ++i) {
                    const auto wanted =
                        std::pow(static_cast<wider<T>>(get_lane(x, i)), static_cast<wider<T>>(static_cast<T>(y)));
                    worst = std::fmax(worst, error_in_ulp<T>(get_lane(result, i), wanted));
                    CHECK(same_bits(get_lane(result, i), myriad::powr(get_lane(x, i), static_cast<T>(y))));
                }
            }
            CAPTURE(powr_function::text, sizeof(T), y);
            CHECK(worst <= (MYRIAD_FUSED ? 1.2 + std::fabs(y) / 5 : 1.5 + std::fabs(y) / 2));
        }
    };
    of_type(double{});
    of_type(float{});
}

TEST_CASE("powr of zero, infinity, negative numbers and beyond the range is that of IEEE 754") {
    const auto of_type = []<class T>(T) {
        using limits = std::numeric_limits<T>;
        const T inf = limits::infinity(), nan = limits::quiet_NaN(), big = limits::max() / 4, small = limits::min() * 4;
        struct {
            T x, y, wanted;
        } const cases[] = {{0, 2, 0},          {0, T(0.25), 0},    {0, -2, inf},
                           {0, T(-0.25), inf}, {inf, T(0.5), inf}, {inf, T(-0.5), 0},
                           {0, 0, nan},        {inf, 0, nan},      {-1, 2, nan},
                           {-inf, 2, nan},     {nan, 2, nan},      {2, nan, nan},
                           {3, 0, 1},          {1, 5000, 1},       {big, 2, inf},
                           {big, -2, 0},       {small, 2, 0},      {small, -2, inf},
                           {2, T(1e30), inf},  {2, T(-1e30), 0},   {limits::denorm_min(), T(0.5), 0},
                           {big, 1, big},      {small, 1, small}};
        for (const auto& c : cases) {
            CAPTURE(sizeof(T), c.x, c.y);
            CHECK(same_bits(myriad::powr(c.x, c.y), c.wanted));
            CHECK(same_bits(get_lane(myriad::powr(pack<T, 1>(c.x), pack<T, 1>(c.y)), 0), c.wanted));
        }
    };
    of_type(double{});
    of_type(float{});
}

TEST_CASE("atan2 and hypot of packs are accurate in every quadrant") {
    const auto of_type = []<class T>(T) {
        using P = pack<T, 2>;
        std::mt19937_64 random(29);
        std::uniform_real_distribution<double> distribution(-3, 3);
        double worst_angle = 0;
        double worst_length = 0;
        for (int k = 0; k < 20000; k += P::lanes) {
            P y;
            P x;
            for (int i = 0; i < P::lanes; ++i) {
                set_lane(y, i, static_cast<T>(distribution(random)));
                set_lane(x, i, static_cast<T>(distribution(random)));
            }
            P angle;
            P length;
            evaluate<atan2_function>(angle, y, x);
            evaluate<hypot_function>(length, y, x);
            for (int i = 0; i < P::lanes; ++i) {
                const wider<T> v = get_lane(y, i);
                const wider<T> u = get_lane(x, i);
                worst_angle = std::fmax(worst_angle, error_in_ulp<T>(get_lane(angle, i), std::atan2(v, u)));
                worst_length = std::fmax(worst_length, error_in_ulp<T>(get_lane(length, i), std::hypot(v, u)));
            }
        }
        CHECK(worst_angle <= 3);
        CHECK(worst_length <= 1.5);
    };
    of_type(double{});
    of_type(float{});
}

TEST_CASE("special values give what the standard library gives") {
    const auto of_type = []<class T>(T) {
        const auto agrees = [](T got, T wanted) {
            // exp and exp2 of packs give 0 instead of subnormal numbers.
            if (got == 0 && std::fabs(wanted) < 2 * std::numeric_limits<T>::min()) return true;
            if (got == 0 && wanted == 0) return same_bits(got, wanted);
            return error_in_ulp<T>(got, wanted) <= 4;
        };
        const std::vector<T> values = arguments<T>();
        for_unary_functions([&]<class F>(F) {
            for (const T x : values) {
                T plain;
                evaluate<F>(plain, x);
                pack<T, 1> result;
                evaluate<F>(result, pack<T, 1>(x));
                if (!agrees(get_lane(result, 0), plain)) {
                    CAPTURE(F::text, sizeof(T), x, get_lane(result, 0), plain);
                    FAIL_CHECK();
                }
            }
        });
        for_binary_functions([&]<class F>(F) {
            for (const T x : values) {
                for (const T y : values) {
                    T plain;
                    evaluate<F>(plain, x, y);
                    pack<T, 1> result;
                    evaluate<F>(result, pack<T, 1>(x), pack<T, 1>(y));
                    const T got = get_lane(result, 0);
                    // Beyond |y| = 100 the error of pow grows with y log x.
                    if (!agrees(got, plain) && !(std::fabs(y) > 100 && error_in_ulp<T>(got, plain) < 100)) {
                        CAPTURE(F::text, sizeof(T), x, y, got, plain);
                        FAIL_CHECK();
                    }
                }
            }
        });
    };
    of_type(double{});
    of_type(float{});
    SUCCEED();
}

TEST_CASE("min, max, rounding, remainders, signs, sqrt and fma agree bit for bit between packs and plain numbers") {
    const auto of_type = []<class T>(T) {
        const std::vector<T> values = arguments<T>();
        const auto check = [](auto f, auto... x) {
            using F = decltype(f);
            T plain;
            evaluate<F>(plain, x...);
            pack<T, 3> result;
            evaluate<F>(result, pack<T, 3>(x)...);
            if (!same_bits(get_lane(result, 5 % pack<T, 3>::lanes), plain)) {
                const std::vector<T> given{x...};
                CAPTURE(F::text, sizeof(T), given, get_lane(result, 0), plain);
                FAIL_CHECK();
            }
        };
        for (const T x : values) {
            for (const T y : values) {
                check(min_function{}, x, y);
                check(max_function{}, x, y);
                check(copysign_function{}, x, y);
                check(fmod_function{}, x, y);
                const T z = T(0.1) * x;
                const T plain = myriad::fma(x, y, z);
                const pack<T, 2> fused = myriad::fma(pack<T, 2>(x), pack<T, 2>(y), pack<T, 2>(z));
                CAPTURE(x, y, z);
                REQUIRE(same_bits(get_lane(fused, 1), plain));
            }
            for (const T y : {x + T(0.5), x + T(0.25), x}) {
                check(floor_function{}, y);
                check(round_function{}, y);
                check(rint_function{}, y);
                check(abs_function{}, y);
                check(sqrt_function{}, y);
            }
        }
        using limits = std::numeric_limits<T>;
        for (const T x : values) {
            REQUIRE(myriad::is_finite(x) == static_cast<bool>(std::isfinite(x)));
            REQUIRE(all(myriad::is_finite(pack<T, 2>(x))) == static_cast<bool>(std::isfinite(x)));
        }
        REQUIRE(myriad::max(limits::quiet_NaN(), T(1)) == T(1));
        REQUIRE(myriad::max(T(1), limits::quiet_NaN()) == T(1));
        REQUIRE(myriad::min(limits::quiet_NaN(), T(1)) == T(1));
        REQUIRE(myriad::min(T(1), limits::quiet_NaN()) == T(1));
        REQUIRE(std::isnan(myriad::min(limits::quiet_NaN(), limits::quiet_NaN())));
    };
    of_type(double{});
    of_type(float{});
}

TEST_CASE("fma rounds once where the target has the instruction") {
    const double x = 1 + 0x1p-30;
    const double exact_part = myriad::fma(x, x, -(1 + 0x1p-29));
    const auto packed = myriad::fma(pack<double, 2>(x), pack<double, 2>(x), pack<double, 2>(-(1 + 0x1p-29)));
#if MYRIAD_FUSED
    REQUIRE(exact_part == 0x1p-60);
#else
    REQUIRE(exact_part == 0);
#endif
    REQUIRE(get_lane(packed, 1) == exact_part);
}

TEST_CASE("whole exponents multiply, for any sign of the base") {
    REQUIRE(myriad::pow(-3.0, 2) == 9.0);
    REQUIRE(myriad::pow(-3.0, 3) == -27.0);
    REQUIRE(myriad::pow(2.0, -2) == 0.25);
    REQUIRE(myriad::pow(0.0, 0) == 1.0);
    REQUIRE(myriad::pow(2.0, 10) == 1024.0);
    const pack<double, 2> x(-3.0);
    REQUIRE(get_lane(myriad::pow(x, 3), 1) == -27.0);
    REQUIRE(get_lane(myriad::pow(x, -1), 0) == 1.0 / -3.0);
    REQUIRE(get_lane(myriad::pow(x, 2.0), 0) == Approx(9.0).epsilon(1e-15));
    REQUIRE(get_lane(myriad::pow(x, 3.0), 0) == Approx(-27.0).epsilon(1e-15));
}

TEST_CASE("literals and plain numbers mix with packs in functions of several arguments") {
    using namespace myriad;
    const pack<double, 2> x(-1.5);
    REQUIRE(get_lane(max(x, 0.0), 0) == 0.0);
    REQUIRE(get_lane(max(0.0, x), 0) == 0.0);
    REQUIRE(get_lane(min(x, 0), 0) == -1.5);
    REQUIRE(get_lane(myriad::hypot(x, 2.0), 1) == Approx(2.5));
    REQUIRE(get_lane(myriad::atan2(1.0, x), 1) == Approx(std::atan2(1.0, -1.5)));
    REQUIRE(get_lane(myriad::copysign(2.0, x), 1) == -2.0);
    REQUIRE(get_lane(myriad::fma(x, 2.0, 1), 1) == -2.0);
    REQUIRE(get_lane(myriad::pow(2.0, x), 1) == Approx(std::pow(2.0, -1.5)));
    STATIC_REQUIRE(std::is_same_v<decltype(myriad::max(1.0f, 0.0)), float>);  // a float model stays float
    STATIC_REQUIRE(std::is_same_v<decltype(myriad::pow(1.0f, 2.0)), float>);
    REQUIRE(myriad::max(3, 4) == 4);
    REQUIRE(myriad::abs(-3) == 3);
}

TEST_CASE("sinpi and cospi are exact at multiples of a half") {
    const auto of_type = []<class T>(T) {
        for (int n = -20; n <= 20; ++n) {
            const T x = T(0.5) * static_cast<T>(n);
            const T sine = n % 2 == 0 ? T(0) : (n % 4 == 1 || n % 4 == -3) ? T(1) : T(-1);
            const T cosine = n % 2 != 0 ? T(0) : n % 4 == 0 ? T(1) : T(-1);
            CAPTURE(sizeof(T), n);
            CHECK(myriad::sinpi(x) == sine);
            CHECK(myriad::cospi(x) == cosine);
            CHECK(get_lane(myriad::sinpi(pack<T, 1>(x)), 0) == sine);
            CHECK(get_lane(myriad::cospi(pack<T, 1>(x)), 0) == cosine);
        }
    };
    of_type(double{});
    of_type(float{});
}
