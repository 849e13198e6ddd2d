// SPDX-License-Identifier: MIT
// Teams of threads on a GPU find what one thread and the CPU find; on the CPU, their size means nothing. How their
// threads work together is tested, without a GPU, in team_test.cpp.
#include <cmath>
#include <cstdint>
#include <limits>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/teams.hpp"
#include "tests/support/device.hpp"

namespace {

constexpr std::int64_t instances = 37;  // the last teams of a warp have none

template <class Model>
myriad::ensemble<Model> start_of() {
    myriad::ensemble<Model> e(instances);
    for (std::int64_t i = 0; i < instances; ++i) {
        for (int c = 0; c < Model::n_state; ++c) e.state(c)[i] = 1 + 0.1 * static_cast<double>((7 * c + 3 * i) % 11);
        for (int c = 0; c < Model::n_parameter; ++c)
            e.parameter(c)[i] = 2 + 0.2 * static_cast<double>((5 * c + 2 * i) % 13);
    }
    for (int c = 0; c < Model::n_shared; ++c) e.shared(c) = 0.05 * (c % 7) - 0.1;
    e.time_domain(0, 1.5);
    return e;
}
/// Tolerances of each component, so that a wrong one shows.
template <class Model>
myriad::options options_for() {
    myriad::options options;
    std::vector<double> relative, absolute;
    for (int c = 0; c < Model::n_state; ++c) {
        relative.push_back(1e-6 / (1 + c % 3));
        absolute.push_back(1e-7 * (1 + c % 5));
    }
    options.relative_tolerance = relative;
    options.absolute_tolerance = absolute;
    options.advice = myriad::advice::off;
    return options;
}
template <class Method, class Model>
myriad::ensemble<Model> solved_on(const myriad::device& where, myriad::options options = options_for<Model>()) {
    auto e = start_of<Model>();
    myriad::solve<Method>(where, e, options);
    return e;
}

/// States within `allowed`, and the same statuses; the same steps if the states are the same to the bit.
template <class A, class B>
void check_same(const myriad::ensemble<A>& a, const myriad::ensemble<B>& b, double allowed) {
    CHECK(a.accepted_steps().minCoeff() > 3);
    if (allowed == 0) {
        CHECK((a.accepted_steps() == b.accepted_steps()).all());
        CHECK((a.rhs_evaluations() == b.rhs_evaluations()).all());
    }
    for (std::int64_t i = 0; i < instances; ++i) CHECK(a.status(i) == b.status(i));
    for (int c = 0; c < A::n_state; ++c) CHECK(((a.state(c) - b.state(c)).abs() <= allowed).all());
}

/// A GPU's error norm leaves out digits (1e-6 of a step), and its compiler fuses other operations: far below the
/// tolerances.
constexpr double rounding = 1e-7;

}  // namespace

TEST_CASE("teams whose threads have one state each take the same steps as those with four, and as one thread") {
    using method = myriad::tsitouras_5;
    const auto by_1 = solved_on<method, teams::places<1>>(tests::test_device());
    const auto by_8 = solved_on<method, teams::places<8>>(tests::test_device());
    const auto by_32 = solved_on<method, teams::places<32>>(tests::test_device());
    check_same(by_1, by_8, 0);
    check_same(by_1, by_32, 0);
    check_same(by_1, solved_on<method, teams::places<64>>(tests::test_device()), 0);
    check_same(by_8, solved_on<method, teams::places<8>>(myriad::device::cpu(1)), rounding);
}

TEST_CASE("teams sum couplings as the CPU does") {
    const auto here = solved_on<myriad::cash_karp, teams::phases<16>>(tests::test_device());
    check_same(here, solved_on<myriad::cash_karp, teams::phases<16>>(myriad::device::cpu(1)), rounding);
}

TEST_CASE("teams average errors as the CPU does") {
    const auto here = solved_on<teams::averaged, teams::places<8>>(tests::test_device());
    check_same(here, solved_on<teams::averaged, teams::places<8>>(myriad::device::cpu(1)), rounding);
}

TEMPLATE_TEST_CASE("teams locate events, call hooks and sample as the CPU does", "", teams::hoppers<8>,
                   teams::hoppers<128>) {
    using model = TestType;
    auto options = options_for<model>();
    for (int unit = 0; unit < model::n_unit; ++unit) {
        options.events.push_back({.direction = myriad::direction::falling, .tolerance = 1e-9});
        options.events.push_back({.tolerance = 1e-9});
    }
    options.samples = {.states = {0, 27}, .capacity = 20, .evenly = 11};
    const auto here = solved_on<teams::sampled, model>(tests::test_device(), options);
    const auto there = solved_on<teams::sampled, model>(myriad::device::cpu(1), options);
    constexpr double after_landings = 1e-5;  // at which differences grow
    check_same(here, there, after_landings);
    CHECK((here.integer_accessory(0) == there.integer_accessory(0)).all());
    CHECK(here.integer_accessory(0).minCoeff() > 0);
    for (int c = 0; c < model::n_accessory; ++c)
        CHECK(((here.accessory(c) - there.accessory(c)).abs() <= after_landings).all());
    CHECK((here.samples().stored() == there.samples().stored()).all());
    for (const int c : {0, 27})
        for (std::int64_t i = 0; i < instances; ++i)
            for (int k = 0; k < here.samples().stored()[i]; ++k)
                CHECK(std::abs(here.samples().state(c)(i, k) - there.samples().state(c)(i, k)) <= after_landings);
}

TEST_CASE("a report says how many threads integrate an instance together") {
    const auto team_of = [](auto e) {
        return myriad::solve<myriad::tsitouras_5>(tests::test_device(), e, options_for<typename decltype(e)::model>())
            .kernel.threads_per_instance;
    };
    CHECK(team_of(start_of<teams::places<1>>()) == 1);
    CHECK(team_of(start_of<teams::places<8>>()) == (tests::tests_cpu() ? 1 : 8));
    CHECK(team_of(start_of<teams::places<32>>()) == (tests::tests_cpu() ? 1 : 32));
}
