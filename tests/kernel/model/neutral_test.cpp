// SPDX-License-Identifier: MIT
// Neutral equations: the slope that a state had, against closed solutions.
#include <cmath>
#include <cstdint>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/neutral_models.hpp"
#include "tests/support/device.hpp"

namespace {

using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;
using neutral::fading;
using neutral::logarithm;
using neutral::sawtooth;

options tolerance(double size) {
    options o;
    o.relative_tolerance = o.absolute_tolerance = size;
    return o;
}
/// The solution of `fading`.
double fading_at(double t, double c) {
    double y = 1, power = 1, begin = 0;
    for (; begin < t; begin += 1) {
        power *= c;
        y = power + (y - power) * std::exp(-std::min(1.0, t - begin));
    }
    return y;
}
ensemble<fading> fadings(double t_end) {
    ensemble<fading> e(9);
    for (int i = 0; i < 9; ++i) e.parameter(fading::c)[i] = -0.8 + 0.2 * i;
    e.state(fading::y) = 1;
    e.time_domain(0, t_end);
    return e;
}
template <class Method>
void check_fading(const options& o, double error) {
    auto e = fadings(4.5);
    solve<Method>(tests::test_device(), e, o);
    for (int i = 0; i < 9; ++i) {
        REQUIRE(e.status(i) == status::success);
        CHECK(std::abs(e.state(fading::y)[i] - fading_at(4.5, e.parameter(fading::c)[i])) <= error);
    }
}

}  // namespace

TEST_CASE("the slope that a state had is that of the method's interpolant") {
    check_fading<myriad::dormand_prince_5>(tolerance(1e-9), 1e-8);
    check_fading<myriad::verner_7>(tolerance(1e-9), 1e-8);
}
TEST_CASE("neutral equations by fixed steps have order 4, as jumps of the slope are ends of steps") {
    double error[2];
    for (const int k : {0, 1}) {
        auto e = fadings(4.5);
        options o;
        o.step = k == 0 ? 1.0 / 16 : 1.0 / 32;
        solve<myriad::runge_kutta_4>(tests::test_device(), e, o);
        error[k] = 0;
        for (int i = 0; i < 9; ++i)
            error[k] = std::max(error[k], std::abs(e.state(fading::y)[i] - fading_at(4.5, e.parameter(fading::c)[i])));
    }
    CHECK(std::log2(error[0] / error[1]) > 2.9);
}
TEST_CASE("events see the slope that a state had, and its jumps are no crossings") {
    ensemble<sawtooth> e(3);
    e.state(sawtooth::y) = 0;
    e.accessory(sawtooth::last) = 0;
    e.accessory(sawtooth::found) = 0;
    e.accessory(sawtooth::sum_of_lateness) = 0;
    e.t_begin() = 0;
    for (int i = 0; i < 3; ++i) e.t_end()[i] = 3.75 + 4 * i;
    const auto check = [&] {
        for (int i = 0; i < 3; ++i) {
            REQUIRE(e.status(i) == status::success);
            CHECK(e.accessory(sawtooth::found)[i] == 4 + 4 * i);
            CHECK(std::abs(e.accessory(sawtooth::last)[i] - (3.5 + 4 * i)) < 1e-9);
            CHECK(e.accessory(sawtooth::sum_of_lateness)[i] < 1e-9);
            CHECK(std::abs(e.state(sawtooth::y)[i] - (-3.0 - 4 * i - 0.9375)) < 1e-9);
        }
    };
    solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-10));
    check();
}
TEST_CASE("a neutral equation whose delay vanishes again and again") {
    ensemble<logarithm> e(3);
    for (int i = 0; i < 3; ++i) e.parameter(logarithm::l)[i] = 0.2 * (i + 1);
    e.state(logarithm::y) = std::log(3.0);
    e.time_domain(0, 10);
    solve<myriad::dormand_prince_5>(tests::test_device(), e, tolerance(1e-9));
    for (int i = 0; i < 3; ++i) {
        REQUIRE(e.status(i) == status::success);
        CHECK(std::abs(e.state(logarithm::y)[i] - std::log(13.0)) < 2e-7);
    }
}
