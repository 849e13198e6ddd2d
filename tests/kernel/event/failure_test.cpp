// SPDX-License-Identifier: MIT
// Event functions that return NaN end their instance as not_finite, with the last finite state, and no other instance.
#include <cmath>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/event/methods.hpp"
#include "tests/kernel/event/time_models.hpp"
#include "tests/support/device.hpp"

namespace {

constexpr double never = 1e300;

myriad::ensemble<gate> gates(std::int64_t size, int before, int at, int after) {
    myriad::ensemble<gate> e(size);
    for (std::int64_t i = 0; i < size; ++i)
        e.state(gate::x)[i] = 1 + static_cast<double>(i) / static_cast<double>(size);
    e.parameter(gate::c) = never;
    e.shared_integer(gate::before) = before;
    e.shared_integer(gate::at) = at;
    e.shared_integer(gate::after) = after;
    e.time_domain(0, 1);
    return e;
}

template <class Method>
auto run(myriad::ensemble<gate>& e) {
    myriad::options o;
    o.step = 0.03;
    return myriad::solve<Method>(tests::test_device(1), e, o);
}

}  // namespace

TEMPLATE_TEST_CASE("an event function that is always NaN ends the instance where it starts", "", ALL_METHODS) {
    auto e = gates(1, gate::no_number, gate::no_number, gate::no_number);
    const auto report = run<TestType>(e);
    CHECK(report.count(myriad::status::not_finite) == 1);
    CHECK(report.first_failed == 0);
    CHECK(e.t()[0] == 0);
    CHECK(e.state(gate::x)[0] == 1);
    CHECK(e.integer_accessory(gate::fired)[0] == 0);
}

TEMPLATE_TEST_CASE("an event function that becomes NaN ends the instance before that time", "", ALL_METHODS) {
    auto e = gates(1, 1, gate::no_number, gate::no_number);
    e.parameter(gate::c) = 0.4;
    const auto report = run<TestType>(e);
    CHECK(report.count(myriad::status::not_finite) == 1);
    CHECK(e.t()[0] < 0.4);
    CHECK(e.t()[0] >= 0.4 - 0.03);  // fixed steps end with the last one before it, adaptive ones shrink towards it
    CHECK(std::abs(e.state(gate::x)[0] - std::exp(-e.t()[0])) <= 1e-6);
    CHECK(e.integer_accessory(gate::fired)[0] == 0);
}

TEMPLATE_TEST_CASE("an event function that is NaN only at the start ends the instance there", "", ALL_METHODS) {
    auto e = gates(1, 1, gate::no_number, 1);
    e.parameter(gate::c) = 0;
    const auto report = run<TestType>(e);
    CHECK(report.count(myriad::status::not_finite) == 1);
    CHECK(e.t()[0] == 0);
    CHECK(e.state(gate::x)[0] == 1);
}

TEMPLATE_TEST_CASE("an instance whose event function is NaN leaves all others untouched, bit for bit", "",
                   ALL_METHODS) {
    constexpr std::int64_t size = 67;
    auto healthy = gates(size, 1, 0, gate::no_number);
    run<TestType>(healthy);
    for (const std::int64_t sick : {0, 5, 31, 66}) {
        for (const double since : {-1.0, 0.0, 0.5}) {
            auto e = gates(size, 1, 0, gate::no_number);
            e.parameter(gate::c)[sick] = since;
            const auto report = run<TestType>(e);
            CAPTURE(sick, since, myriad::name_of(report.first_status));
            CHECK(report.count(myriad::status::not_finite) == 1);
            CHECK(report.first_failed == sick);
            std::int64_t different = 0;
            for (std::int64_t i = 0; i < size; ++i)
                different += i != sick && !(e.state(gate::x)[i] == healthy.state(gate::x)[i] &&
                                            e.t()[i] == healthy.t()[i] && e.status(i) == healthy.status(i) &&
                                            e.accepted_steps()[i] == healthy.accepted_steps()[i] &&
                                            e.rhs_evaluations()[i] == healthy.rhs_evaluations()[i]);
            CHECK(different == 0);
        }
    }
}
