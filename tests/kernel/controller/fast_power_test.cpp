// SPDX-License-Identifier: MIT
// The power of the step-size control: its error, its edges, and that packs and plain reals agree. A model file.
#include "myriad/kernel/controller/fast_power.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

using myriad::detail::get_lane;

namespace {

template <class R>
std::vector<R> samples() {
    std::vector<R> x;
    // 97 is no multiple of the octaves or decades: mantissas everywhere
    for (int i = 0; i <= 97 * 60; ++i) x.push_back(static_cast<R>(std::pow(10.0, -30 + i / 97.0)));
    // both sides of powers of two, where the fit of the mantissa jumps
    for (int e = -90; e <= 90; e += 9) {
        x.push_back(std::ldexp(R(1), e));
        x.push_back(std::nextafter(std::ldexp(R(1), e), R(0)));
    }
    return x;
}

template <class R>
void check_accuracy(R exponent) {
    double worst = 0;
    for (const R x : samples<R>()) {
        const double exact = std::pow(static_cast<double>(x), static_cast<double>(exponent));
        const double error = std::abs(static_cast<double>(myriad::detail::fast_power(x, exponent)) / exact - 1);
        worst = std::isnan(error) ? error : std::max(worst, error);
    }
    CAPTURE(exponent, worst);
    CHECK(worst <= 2e-5);  // as documented
}

template <class R, int batches>
void check_packs() {
    using P = myriad::pack<R, batches>;
    const std::vector<R> x = samples<R>();
    int different = 0;
    for (std::size_t i = 0; i + P::lanes <= x.size(); i += P::lanes) {
        for (const R exponent : {R(-1.0 / 5), R(-1.0 / 4)}) {
            const P powers = myriad::detail::fast_power(P::load(x.data() + i), P(exponent));
            for (int lane = 0; lane < P::lanes; ++lane) {
                const R one = myriad::detail::fast_power(x[i + static_cast<std::size_t>(lane)], exponent);
#if defined(MYRIAD_STRICT)
                if (!(get_lane(powers, lane) == one)) ++different;
#else
                // contraction changes the exponent, at most 25 in size, by an ulp
                if (!(std::abs(get_lane(powers, lane) / one - 1) <= 32 * std::numeric_limits<R>::epsilon()))
                    ++different;
#endif
            }
        }
    }
    CHECK(different == 0);
}

}  // namespace

TEST_CASE("fast_power is accurate to 2e-5 for doubles from 1e-30 to 1e30") {
    for (const double exponent : {-1.0 / 5, -1.0 / 4, -1.0 / 3, -1.0 / 8, 1.0 / 5, 0.5, 1.0, -1.0})
        check_accuracy(exponent);
}
TEST_CASE("fast_power is accurate to 2e-5 for floats from 1e-30 to 1e30") {
    for (const float exponent : {-1.0f / 5, -1.0f / 4, -1.0f / 3, -1.0f / 8, 1.0f / 5, 0.5f}) check_accuracy(exponent);
}
TEST_CASE("fast_power of one is one within 2e-5, for any exponent") {
    for (const double exponent : {-1.0, -0.25, 0.0, 0.25, 1.0})
        CHECK(std::abs(myriad::detail::fast_power(1.0, exponent) - 1) <= 2e-5);
}
TEST_CASE("fast_power of an error of zero asks for a step far above any growth limit") {
    CHECK(myriad::detail::fast_power(0.0, -0.2) > 1e7);
    CHECK(myriad::detail::fast_power(0.0f, -0.2f) > 1e7f);
    CHECK(myriad::detail::fast_power(std::numeric_limits<double>::denorm_min(), -0.2) > 1e7);
    CHECK(myriad::detail::fast_power(std::numeric_limits<float>::denorm_min(), -0.2f) > 1e7f);
}
TEST_CASE("fast_power of the largest error asks for a step far below any shrink limit") {
    CHECK(myriad::detail::fast_power(std::numeric_limits<double>::max(), -0.25) < 1e-9);
    CHECK(myriad::detail::fast_power(std::numeric_limits<double>::max(), -0.25) > 0);
    CHECK(myriad::detail::fast_power(std::numeric_limits<float>::max(), -0.25f) < 1e-9f);
    CHECK(myriad::detail::fast_power(std::numeric_limits<float>::max(), -0.25f) > 0);
}
TEST_CASE("fast_power of a pack is that of its lanes") {
    check_packs<double, 1>();
    check_packs<double, 2>();
    check_packs<float, 1>();
    check_packs<float, 2>();
}
