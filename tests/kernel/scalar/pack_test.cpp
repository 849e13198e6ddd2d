// SPDX-License-Identifier: MIT
// Packs and masks against plain numbers, lane by lane and bit by bit, for every type and number of batches in use.

#include "myriad/kernel/scalar/pack.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "tests/catch.hpp"

using myriad::detail::all;
using myriad::detail::any;
using myriad::detail::bits;
using myriad::detail::differs_in_bits;
using myriad::detail::get_lane;
using myriad::detail::set_lane;

namespace {

using myriad::pack;
using myriad::pack_mask;
using myriad::select;

template <class T>
bool same_bits(T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        if (std::isnan(a) && std::isnan(b)) return true;  // any NaN equals any other here
        using bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
        return std::bit_cast<bits>(a) == std::bit_cast<bits>(b);
    } else {
        return a == b;
    }
}

// Values that are paired in every lane: ordinary ones, and all that compare or round specially.
template <class T>
std::vector<T> samples() {
    std::vector<T> values{T(0), T(1), T(-1), T(2), T(3), T(-7), T(100)};
    if constexpr (std::is_floating_point_v<T>) {
        using limits = std::numeric_limits<T>;
        for (const T x : {T(-0.0), T(0.1), T(-2.5), limits::min(), limits::denorm_min(), limits::max(),
                          limits::lowest(), limits::infinity(), -limits::infinity(), limits::quiet_NaN()}) {
            values.push_back(x);
        }
    }
    return values;
}

/// Calls check(pack, lanes, pack, lanes) with every pair of samples in some lane.
template <class P, class Check>
void for_pairs(Check check) {
    using T = typename P::value_type;
    const std::vector<T> values = samples<T>();
    const std::size_t n = values.size();
    for (std::size_t shift = 0; shift < n; ++shift) {
        for (std::size_t start = 0; start < n; start += static_cast<std::size_t>(P::lanes)) {
            std::vector<T> a(P::lanes), b(P::lanes);
            for (std::size_t i = 0; i < a.size(); ++i) {
                a[i] = values[(start + i) % n];
                b[i] = values[(start + i + shift) % n];
            }
            check(P::load(a.data()), a, P::load(b.data()), b);
        }
    }
}

template <class P, class T>
bool lanes_are(const P& p, const std::vector<T>& expected) {
    for (int i = 0; i < P::lanes; ++i) {
        if (!same_bits<T>(get_lane(p, i), expected[static_cast<std::size_t>(i)])) return false;
    }
    return true;
}

template <class T, class F>
std::vector<T> mapped(const std::vector<T>& a, const std::vector<T>& b, F f) {
    std::vector<T> result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = static_cast<T>(f(a[i], b[i]));
    return result;
}

template <class P, class Mask, class F>
bool mask_is(const Mask& mask, const std::vector<typename P::value_type>& a,
             const std::vector<typename P::value_type>& b, F f) {
    static_assert(std::is_same_v<Mask, typename P::mask_type>);
    bool any_expected = false;
    bool all_expected = true;
    for (int i = 0; i < P::lanes; ++i) {
        const bool expected = f(a[static_cast<std::size_t>(i)], b[static_cast<std::size_t>(i)]);
        any_expected |= expected;
        all_expected &= expected;
        if (get_lane(mask, i) != expected || ((bits(mask) >> i & 1) != 0) != expected) return false;
    }
    return any(mask) == any_expected && all(mask) == all_expected;
}

template <class P>
void check_arithmetic() {
    using T = typename P::value_type;
    for_pairs<P>([](const P& a, const std::vector<T>& x, const P& b, const std::vector<T>& y) {
        REQUIRE(lanes_are(a + b, mapped(x, y, [](T u, T v) { return u + v; })));
        REQUIRE(lanes_are(a - b, mapped(x, y, [](T u, T v) { return u - v; })));
        REQUIRE(lanes_are(-a, mapped(x, y, [](T u, T) { return -u; })));
        REQUIRE(lanes_are(+a, x));
        P c = a;
        c += b;
        REQUIRE(lanes_are(c, mapped(x, y, [](T u, T v) { return u + v; })));
        if constexpr (P::is_real) {
            REQUIRE(lanes_are(a * b, mapped(x, y, [](T u, T v) { return u * v; })));
            REQUIRE(lanes_are(a / b, mapped(x, y, [](T u, T v) { return u / v; })));
            P d = a;
            d -= b;
            REQUIRE(lanes_are(d, mapped(x, y, [](T u, T v) { return u - v; })));
            d = a;
            d *= b;
            REQUIRE(lanes_are(d, mapped(x, y, [](T u, T v) { return u * v; })));
            d = a;
            d /= b;
            REQUIRE(lanes_are(d, mapped(x, y, [](T u, T v) { return u / v; })));
        }
    });
}

template <class P>
void check_comparisons() {
    using T = typename P::value_type;
    for_pairs<P>([](const P& a, const std::vector<T>& x, const P& b, const std::vector<T>& y) {
        REQUIRE(mask_is<P>(a < b, x, y, [](T u, T v) { return u < v; }));
        REQUIRE(mask_is<P>(a <= b, x, y, [](T u, T v) { return u <= v; }));
        REQUIRE(mask_is<P>(a > b, x, y, [](T u, T v) { return u > v; }));
        REQUIRE(mask_is<P>(a >= b, x, y, [](T u, T v) { return u >= v; }));
        REQUIRE(mask_is<P>(a == b, x, y, [](T u, T v) { return u == v; }));
        REQUIRE(mask_is<P>(a != b, x, y, [](T u, T v) { return u != v; }));
    });
}

template <class P>
void check_masks() {
    using Mask = typename P::mask_type;
    std::mt19937_64 random(11);
    const std::uint64_t every = P::lanes == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << P::lanes) - 1;
    const auto make = [](std::uint64_t pattern) {
        Mask mask(false);
        for (int i = 0; i < P::lanes; ++i) set_lane(mask, i, (pattern >> i & 1) != 0);
        return mask;
    };
    REQUIRE(bits(Mask(true)) == every);
    REQUIRE(bits(Mask(false)) == 0);
    for (int k = 0; k < 50; ++k) {
        // Mostly ones, mostly zeros, and single lanes, which decide any and all.
        std::uint64_t p = random() & every;
        if (k % 5 == 1) p = std::uint64_t{1} << (k % P::lanes);
        if (k % 5 == 2) p = every & ~(std::uint64_t{1} << (k % P::lanes));
        if (k % 5 == 3) p = k % 2 == 0 ? 0 : every;
        const std::uint64_t q = random() & every;
        const Mask a = make(p);
        const Mask b = make(q);
        REQUIRE(bits(a) == p);
        REQUIRE(any(a) == (p != 0));
        REQUIRE(all(a) == (p == every));
        REQUIRE(bits(a & b) == (p & q));
        REQUIRE(bits(a | b) == (p | q));
        REQUIRE(bits(a ^ b) == (p ^ q));
        REQUIRE(bits(a && b) == (p & q));
        REQUIRE(bits(a || b) == (p | q));
        REQUIRE(bits(!a) == (every & ~p));
        REQUIRE(bits(a == b) == (every & ~(p ^ q)));
        REQUIRE(bits(a != b) == (p ^ q));
        REQUIRE(bits(a && true) == p);
        REQUIRE(bits(false || a) == p);
        REQUIRE(bits(a & false) == 0);
        REQUIRE(bits(select(a, b, !b)) == ((p & q) | (every & ~p & ~q)));
        REQUIRE(bits(select(a, b, false)) == (p & q));
        REQUIRE(bits(select(a, true, b)) == (p | q));
        Mask c = a;
        c &= b;
        REQUIRE(bits(c) == (p & q));
        c |= a;
        REQUIRE(bits(c) == p);
        c ^= b;
        REQUIRE(bits(c) == (p ^ q));
        for (int i = 0; i < P::lanes; ++i) REQUIRE(get_lane(a, i) == ((p >> i & 1) != 0));
    }
}

template <class P>
void check_select_and_lanes() {
    using T = typename P::value_type;
    for_pairs<P>([](const P& a, const std::vector<T>& x, const P& b, const std::vector<T>& y) {
        const auto mask = a < b;
        REQUIRE(lanes_are(select(mask, a, b), mapped(x, y, [](T u, T v) { return u < v ? u : v; })));
        REQUIRE(lanes_are(select(mask, a, 0), mapped(x, y, [](T u, T v) { return u < v ? u : T(0); })));
        REQUIRE(lanes_are(select(mask, T(1), b), mapped(x, y, [](T u, T v) { return u < v ? T(1) : v; })));
        REQUIRE(lanes_are(select(true, a, b), x));
        REQUIRE(lanes_are(select(false, a, b), y));
        REQUIRE(lanes_are(myriad::select(mask, a, b), mapped(x, y, [](T u, T v) { return u < v ? u : v; })));
    });
    P p(T(5));
    REQUIRE(lanes_are(p, std::vector<T>(P::lanes, T(5))));
    std::vector<T> expected(P::lanes, T(5));
    for (int i = 0; i < P::lanes; ++i) {
        set_lane(p, i, static_cast<T>(i));
        expected[static_cast<std::size_t>(i)] = static_cast<T>(i);
        REQUIRE(lanes_are(p, expected));
    }
}

template <class P>
void check_memory() {
    using T = typename P::value_type;
    alignas(64) T memory[2 * P::lanes + 1];
    for (int i = 0; i < 2 * P::lanes + 1; ++i) memory[i] = static_cast<T>(i);
    const P aligned = P::load_aligned(memory);
    const P unaligned = P::load(memory + 1);
    for (int i = 0; i < P::lanes; ++i) {
        REQUIRE(get_lane(aligned, i) == static_cast<T>(i));
        REQUIRE(get_lane(unaligned, i) == static_cast<T>(i + 1));
    }
    unaligned.store_aligned(memory);
    for (int i = 0; i < P::lanes; ++i) REQUIRE(memory[i] == static_cast<T>(i + 1));
    aligned.store(memory + P::lanes + 1);
    REQUIRE(memory[P::lanes] == static_cast<T>(P::lanes));  // the value between the two stays
    for (int i = 0; i < P::lanes; ++i) REQUIRE(memory[P::lanes + 1 + i] == static_cast<T>(i));
}

template <class Check>
void for_all_packs(Check check) {
    const auto of_type = [&]<class T>(T) {
        check.template operator()<pack<T, 1>>();
        check.template operator()<pack<T, 2>>();
        check.template operator()<pack<T, 3>>();
        check.template operator()<pack<T, 4>>();
    };
    of_type(double{});
    of_type(float{});
    of_type(std::int64_t{});
    of_type(std::int32_t{});
}

}  // namespace

TEST_CASE("pack arithmetic gives in each lane the bits of plain arithmetic") {
    for_all_packs([]<class P>() { check_arithmetic<P>(); });
}

TEST_CASE("pack comparisons agree with plain comparisons in each lane, NaN and signed zeros included") {
    for_all_packs([]<class P>() { check_comparisons<P>(); });
}

TEST_CASE("mask operators agree with the bits of the mask") {
    for_all_packs([]<class P>() {
        if constexpr (P::is_real) check_masks<P>();
    });
}

TEST_CASE("select takes each lane from the side its mask names, and set_lane changes one lane only") {
    for_all_packs([]<class P>() { check_select_and_lanes<P>(); });
}

TEST_CASE("packs load and store contiguous lanes, aligned and unaligned") {
    for_all_packs([]<class P>() { check_memory<P>(); });
}

TEST_CASE("literals convert on either side of an operator") {
    pack<double, 2> x(3.0);
    REQUIRE(get_lane(2 * x, 1) == 6.0);
    REQUIRE(get_lane(x - 1.0, 0) == 2.0);
    REQUIRE(get_lane(1 / x, 0) == 1.0 / 3.0);
    REQUIRE(all(x > 2));
    REQUIRE(all(2.0 < x));
    x *= 2;
    REQUIRE(get_lane(x, 0) == 6.0);
    REQUIRE(get_lane(select(x > 0.0, 1.0, 0.0), 1) == 1.0);
    const pack<std::int64_t, 2> n(1);
    REQUIRE(get_lane(select(x > 0.0, n + 1, n), 1) == 2);
}

TEST_CASE("real packs and their integers have the same lanes, and the traits name them") {
    using D = pack<double, 3>;
    using F = pack<float, 3>;
    STATIC_REQUIRE(D::lanes == myriad::integer_of<D>::lanes);
    STATIC_REQUIRE(F::lanes == myriad::integer_of<F>::lanes);
    STATIC_REQUIRE(std::is_same_v<myriad::integer_of<D>, pack<std::int64_t, 3>>);
    STATIC_REQUIRE(std::is_same_v<myriad::integer_of<F>, pack<std::int32_t, 3>>);
    STATIC_REQUIRE(std::is_same_v<myriad::mask_of<D>, pack_mask<double, 3>>);
    STATIC_REQUIRE(std::is_same_v<myriad::real_of<F>, float>);
    STATIC_REQUIRE(myriad::lanes_of<D> == D::lanes);
    STATIC_REQUIRE(!std::is_convertible_v<pack_mask<double, 3>, bool>);
}

TEST_CASE("plain numbers answer to the same functions as packs") {
    double x = 2.0;
    REQUIRE(select(x > 1.0, x, 0) == 2.0);
    REQUIRE(select(x > 3.0, x, 0.5) == 0.5);
    REQUIRE(myriad::detail::any(x > 1.0));
    REQUIRE(!myriad::detail::all(x > 3.0));
    REQUIRE(myriad::detail::bits(true) == 1);
    REQUIRE(myriad::detail::bits(false) == 0);
    REQUIRE(myriad::detail::get_lane(x, 0) == 2.0);
    myriad::detail::set_lane(x, 0, 3.0);
    REQUIRE(x == 3.0);
    STATIC_REQUIRE(std::is_same_v<decltype(select(true, 1.0f, 0.0)), float>);  // no double leaks into float models
}

TEMPLATE_TEST_CASE("numbers that differ in a bit differ, a NaN from itself not", "", (pack<double, 2>),
                   (pack<float, 1>)) {
    using P = TestType;
    using T = typename P::value_type;
    const T nan = std::numeric_limits<T>::quiet_NaN();
    P a(nan), b(nan);
    CHECK_FALSE(any(differs_in_bits(a, b)));
    set_lane(b, P::lanes - 1, T(1));
    CHECK(bits(differs_in_bits(a, b)) == std::uint64_t{1} << (P::lanes - 1));
    set_lane(a, 0, T(0));
    set_lane(b, 0, T(-0.0));
    CHECK(get_lane(differs_in_bits(a, b), 0));
    CHECK_FALSE(myriad::detail::differs_in_bits(nan, nan));
    CHECK(myriad::detail::differs_in_bits(T(1), T(2)));
    CHECK(myriad::detail::differs_in_bits(1, 2));
}
