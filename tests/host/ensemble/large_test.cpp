// SPDX-License-Identifier: MIT
// Ensembles so large that the host checks, counts and clears them with several threads: the same answers wherever in
// the ensemble the relevant instance is.
#include <cstdint>
#include <limits>

#include "tests/host/ensemble/refusal.hpp"
#include "tests/support/device.hpp"

namespace {

using ensemble_models::bare;
using myriad::status;

constexpr std::int64_t size = 300'001;  // not a multiple of any part
constexpr std::int64_t places[] = {0, 1, size / 2, size - 2, size - 1};

/// Result of the quick check of inputs, and of the full check.
template <class R>
bool passes(myriad::ensemble<bare, R>& e, const myriad::options& o = {}) {
    myriad::host::data_check<R> check(myriad::host::ensemble_access::data(e), o, e.size(), false);
    const bool passed = check.passes(0, e.size());
    bool refused = false;
    try {
        check.run();
    } catch (const myriad::error&) {
        refused = true;
    }
    CHECK(refused != passed);
    return passed;
}

template <class R>
void checks_at_a_glance() {
    using limits = std::numeric_limits<R>;
    auto e = good_decays<R>(size);
    CHECK(passes(e));
    for (const R fine :
         {limits::max(), limits::lowest(), limits::denorm_min(), limits::min(), R(-0.0), limits::epsilon()})
        for (const std::int64_t i : places) {
            e.state(bare::w)[i] = fine;
            CHECK(passes(e));
        }
    e.state(bare::w) = R(0);
    for (const R bad :
         {limits::infinity(), -limits::infinity(), limits::quiet_NaN(), -limits::quiet_NaN(), limits::signaling_NaN()})
        for (const std::int64_t i : places)
            for (R* const values :
                 {e.state(bare::x).data(), e.parameter(bare::rate).data(), e.t_begin().data(), e.t_end().data()}) {
                const R before = values[i];
                values[i] = bad;
                CHECK_FALSE(passes(e));
                values[i] = before;
            }
    CHECK(passes(e));
}

TEST_CASE("a glance at the inputs sees what the full check sees, in doubles", "[large]") {
    checks_at_a_glance<double>();
}
TEST_CASE("a glance at the inputs sees what the full check sees, in floats", "[large]") { checks_at_a_glance<float>(); }

TEST_CASE("infinite ends pass at a glance where an event may end the phase, and NaN does not", "[large]") {
    using ensemble_models::watched;
    auto e = good_travellers(70'000);
    myriad::options o;
    o.events.resize(1);
    o.events[0].stop_after = 1;
    e.t_end() = std::numeric_limits<double>::infinity();
    const myriad::host::data_check<double> check(myriad::host::ensemble_access::data(e), o, e.size(),
                                                 myriad::host::events_may_stop(o));
    CHECK(check.passes(0, e.size()));
    e.t_end()[69'999] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(check.passes(0, e.size()));
    CHECK(check.passes(0, 69'999));
    CHECK_FALSE(check.passes(69'999, 1));
}

TEST_CASE("the only bad value of a large ensemble is named", "[large]") {
    for (const std::int64_t i : places) {
        auto e = good_decays(size);
        e.parameter(bare::rate)[i] = std::numeric_limits<double>::quiet_NaN();
        refused([&] { myriad::solve<myriad::cash_karp>(tests::test_device(2), e); },
                {"parameter 0 (rate) is not finite in 1 of 300001 instances",
                 myriad::message("instance ", i, ' ').c_str()});
    }
}

template <class E>
void check_times(const E& e, const myriad::options& o) {
    myriad::host::check_sample_times(myriad::host::ensemble_access::data(e), o, e.size());
}

TEST_CASE("sample times outside of a single domain of many are refused", "[large]") {
    myriad::options o;
    o.samples = {.states = {bare::x}, .capacity = 2, .times = {0.25, 0.5}};
    auto e = good_decays(100'000);
    CHECK_NOTHROW(check_times(e, o));
    for (const std::int64_t i : {std::int64_t{0}, std::int64_t{77'777}, std::int64_t{99'999}}) {
        e.t_end()[i] = 0.375;
        refused([&] { check_times(e, o); },
                {myriad::message("instance ", i, " is integrated from 0 to 0.375").c_str()});
        e.t_end()[i] = 1;
    }
    e.t_begin() = 1.0;
    e.t_end() = 0.0;
    refused([&] { check_times(e, o); }, {"instance 0 is integrated from 1 to 0"});
    o.samples.times = {0.5, 0.25};
    CHECK_NOTHROW(check_times(e, o));
}

TEST_CASE("statuses of a large ensemble are counted, and its first failure is found", "[large]") {
    myriad::options o;
    o.invalid_instances = myriad::invalid_instances::mark;
    o.max_steps = 1000;
    auto e = good_decays(size);
    for (const std::int64_t i : {std::int64_t{123'456}, std::int64_t{250'000}, size - 1})
        e.state(bare::x)[i] = std::numeric_limits<double>::infinity();
    const auto report = myriad::solve<myriad::cash_karp>(tests::test_device(2), e, o);
    CHECK(report.instances == size);
    CHECK(report.count(status::success) == size - 3);
    CHECK(report.count(status::invalid_input) == 3);
    CHECK(report.first_failed == 123'456);
    CHECK(report.accepted_steps == e.accepted_steps().sum());
    CHECK(report.rhs_evaluations == e.rhs_evaluations().sum());
    CHECK(report.accepted_steps >= size - 3);
}

TEST_CASE("restart makes a large ensemble as good as new", "[large]") {
    auto e = good_decays(size);
    CHECK(myriad::host::ensemble_access::data(e).untouched);
    myriad::solve<myriad::cash_karp>(tests::test_device(2), e);
    CHECK_FALSE(myriad::host::ensemble_access::data(e).untouched);
    const auto steps = e.accepted_steps().sum();
    e.restart();
    CHECK(myriad::host::ensemble_access::data(e).untouched);
    CHECK(e.accepted_steps().maxCoeff() == 0);
    CHECK(e.phases_done().maxCoeff() == 0);
    CHECK(e.next_step().abs().maxCoeff() == 0);
    CHECK(e.status(size - 1) == status::not_started);
    e.state(bare::x) = 1.0;
    e.state(bare::w) = 0.0;
    CHECK(myriad::solve<myriad::cash_karp>(tests::test_device(2), e).accepted_steps == steps);
}

}  // namespace
