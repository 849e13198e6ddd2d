// SPDX-License-Identifier: MIT
// What a call reports: instances by status, the first failing one with its inputs, work, idle lanes, progress.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <omp.h>

#include "tests/host/ensemble/refusal.hpp"
#include "tests/support/device.hpp"

namespace {

using ensemble_models::bare;
using ensemble_models::complete;
using ensemble_models::watched;
using myriad::cash_karp;
using myriad::counting;
using myriad::device;
using myriad::options;
using myriad::runge_kutta_4;
using myriad::solve;
using myriad::status;

const device one_thread = tests::test_device(1);

/// Decays; numbers 6 and 8 become non-finite at once.
myriad::ensemble<bare> two_failures() {
    auto e = good_decays(10);
    for (const std::int64_t i : {6, 8}) {
        e.parameter(bare::rate)[i] = 1e308;
        e.state(bare::x)[i] = 1e10;
        e.state(bare::w)[i] = 0.5;
    }
    return e;
}

template <class Report>
std::string printed(const Report& report) {
    std::ostringstream out;
    out << report;
    return out.str();
}

bool has(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

TEST_CASE("the report counts the instances by status", "[report]") {
    auto e = good_travellers(8);  // speeds 1 to 8 to x = 1
    options o;
    o.events.resize(1);
    o.events[0].stop_after = 1;
    e.t_end() = 0.3;  // those with speeds from 4 on arrive
    const auto report = solve<cash_karp>(one_thread, e, o);
    CHECK(report.instances == 8);
    CHECK(report.count(status::success) == 3);
    CHECK(report.count(status::stopped_by_event) == 5);
    CHECK(report.failed() == 0);
    CHECK(report.first_failed == -1);
    std::int64_t sum = 0;
    for (const auto n : report.by_status) sum += n;
    CHECK(sum == 8);
    if (tests::tests_cpu()) {
        CHECK(report.threads == 1);
        CHECK(report.lanes >= 1);
    }
    CHECK(report.seconds >= 0);
}

TEST_CASE("every status has a name, and no two the same", "[report]") {
    for (int a = 0; a < myriad::status_count; ++a) {
        const std::string name = myriad::name_of(static_cast<status>(a));
        CHECK_FALSE(name.empty());
        for (int b = 0; b < a; ++b) CHECK(name != myriad::name_of(static_cast<status>(b)));
    }
    CHECK(std::string(myriad::name_of(status::invalid_input)) == "invalid_input");
    CHECK(std::string(myriad::name_of(status::step_underflow)) == "step_underflow");
}

TEST_CASE("the report names the first failing instance with its inputs", "[report]") {
    auto e = two_failures();
    const auto report = solve<cash_karp>(tests::test_device(2), e);
    CHECK(report.count(status::not_finite) == 2);
    CHECK(report.count(status::success) == 8);
    CHECK(report.failed() == 2);
    CHECK(report.first_failed == 6);
    CHECK(report.first_status == status::not_finite);
    CHECK(report.first_t == 0);
    CHECK(report.first_t_begin == 0);
    CHECK(report.first_t_end == 1);
    CHECK(report.first_state == std::vector<double>{1e10, 0.5});
    CHECK(report.first_parameter == std::vector<double>{1e308});
}

TEST_CASE("a printed report has all a person asks for", "[report]") {
    auto e = two_failures();
    const auto report = solve<cash_karp>(one_thread, e);
    const std::string text = printed(report);
    INFO(text);
    CHECK(has(text, "10 instances: 8 success, 2 not_finite"));
    CHECK(has(text, tests::tests_cpu() ? " s on 1 thread of " : " s on cuda:0, of them "));
    CHECK(has(text, (std::to_string(report.accepted_steps) + " steps accepted").c_str()));
    CHECK(has(text, (std::to_string(report.rhs_evaluations) + " evaluations of the right-hand side").c_str()));
    CHECK(has(text, "first failure: instance 6 ended as not_finite at t = 0 of [0, 1]"));
    CHECK(has(text, "state 1e+10 0.5; parameters 1e+308"));
    CHECK(text.back() == '\n');
}

/// As in Germany: 1.234.567,5.
struct german : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST_CASE("messages, reports and names of devices are the same whatever locale the program has chosen", "[report]") {
    auto e = good_decays(1000), bad = good_decays(1500);
    bad.state(bare::x)[1234] = std::numeric_limits<double>::infinity();
    options o;
    o.relative_tolerance = 1e-17;
    const auto report = solve<cash_karp>(one_thread, e, o);
    std::ostringstream expected;
    expected << report;
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new german));
    std::ostringstream printed;
    printed << report;
    const std::string name = device::cpu(2000).name(), note = solve<cash_karp>(one_thread, e, o).notes.at(0);
    const int threads = device::parse(name).threads();
    refused([&] { solve<cash_karp>(one_thread, bad); }, {"1 of 1500 instances, first in instance 1234 "});
    refused([] { device::parse("cpu:5000"); }, {"5000 threads"});
    std::locale::global(before);
    CHECK(name == "cpu:2000");
    CHECK(threads == 2000);
    CHECK(printed.str() == expected.str());
    CHECK(note == report.notes.at(0).text());
}

TEST_CASE("a printed report without failures or counts has no line about them", "[report]") {
    auto e = good_decays();
    options o;
    o.counting = counting::off;
    const std::string text = printed(solve<cash_karp>(tests::test_device(2), e, o));
    INFO(text);
    CHECK(has(text, "5 instances: 5 success; "));
    CHECK(has(text, tests::tests_cpu() ? "on 2 threads of " : " s on cuda:0, of them "));
    CHECK_FALSE(has(text, "failure"));
    CHECK_FALSE(has(text, "accepted"));
}

TEST_CASE("the report's work is the sum over the instances, of this call alone", "[report]") {
    auto e = good_oscillators(30);
    const auto first = solve<cash_karp>(one_thread, e);
    CHECK(first.accepted_steps == e.accepted_steps().sum());
    CHECK(first.rejected_steps == e.rejected_steps().sum());
    CHECK(first.located_steps == e.located_steps().sum());
    CHECK(first.rhs_evaluations == e.rhs_evaluations().sum());
    CHECK(first.accepted_steps > 0);
    CHECK(first.located_steps > 0);
    for (std::int64_t i = 0; i < 30; ++i) CHECK(e.accepted_steps()[i] == e.integer_accessory(complete::steps)[i]);
    const auto second = solve<cash_karp>(one_thread, e);
    CHECK(first.accepted_steps + second.accepted_steps == e.accepted_steps().sum());
    CHECK(first.rhs_evaluations + second.rhs_evaluations == e.rhs_evaluations().sum());
}

TEST_CASE("fixed steps are counted exactly", "[report]") {
    auto e = good_decays(7);
    options o;
    o.step = 0.125;
    const auto report = solve<runge_kutta_4>(one_thread, e, o);
    CHECK((e.accepted_steps() == 8).all());
    CHECK((e.rejected_steps() == 0).all());
    CHECK(report.accepted_steps == 7 * 8);
    CHECK(report.rhs_evaluations == 7 * 8 * 4);
}

TEST_CASE("counters that nothing can add to take no memory until they are asked for, and then are zero", "[report]") {
    auto e = good_decays(7);
    options o;
    o.step = 0.125;
    solve<runge_kutta_4>(one_thread, e, o);
    CHECK(myriad::host::ensemble_access::data(e).counters()[0] != nullptr);
    CHECK(myriad::host::ensemble_access::data(e).counters()[1] == nullptr);  // fixed steps
    CHECK(myriad::host::ensemble_access::data(e).counters()[2] == nullptr);  // no events
    CHECK((e.located_steps() == 0).all());
    solve<cash_karp>(one_thread, e, o);
    CHECK(myriad::host::ensemble_access::data(e).counters()[1] != nullptr);
    const auto rejected = e.rejected_steps().sum();
    const auto accepted = e.accepted_steps().sum();
    const auto report = solve<runge_kutta_4>(one_thread, e, o);
    CHECK(e.rejected_steps().sum() == rejected);  // those of the earlier method
    CHECK(e.accepted_steps().sum() == accepted + report.accepted_steps);
}

TEST_CASE("without counting there are no counters, and reading them is refused", "[report]") {
    auto e = good_decays(), counted = good_decays();
    options o;
    o.counting = counting::off;
    const auto report = solve<cash_karp>(one_thread, e, o);
    CHECK_FALSE(e.counted());
    refused([&] { e.accepted_steps(); }, {"no work was counted", "counting::on"});
    refused([&] { e.rejected_steps(); }, {"no work was counted"});
    refused([&] { e.located_steps(); }, {"no work was counted"});
    refused([&] { e.rhs_evaluations(); }, {"no work was counted"});
    CHECK(report.accepted_steps == 0);
    CHECK(report.rhs_evaluations == 0);
    CHECK(report.idle_share() == 0);
    CHECK(report.count(status::success) == 5);
    solve<cash_karp>(one_thread, counted);
    CHECK((e.state(bare::x) == counted.state(bare::x)).all());

    // Counting begins with the first call that counts.
    const auto second = solve<cash_karp>(one_thread, e);
    CHECK(e.counted());
    CHECK(second.accepted_steps == e.accepted_steps().sum());
    CHECK(second.accepted_steps > 0);
}

TEST_CASE("the idle share is the part of the lanes that had nothing to do", "[report]") {
    if (!tests::tests_cpu()) return;  // threads of a GPU are not counted
    options o;
    o.step = 1.0 / 1024;
    auto one = good_decays(1);
    const auto alone = solve<runge_kutta_4>(one_thread, one, o);
    // One instance in a pack: all other lanes idle, except for an iteration or two at the end.
    const double expected = 1 - 1.0 / alone.lanes;
    CHECK(alone.idle_share() >= expected - 1e-12);
    CHECK(alone.idle_share() <= 1 - 1.0 / alone.lanes * 1024 / 1026);

    auto full = good_decays(alone.lanes * 4);
    const auto busy = solve<runge_kutta_4>(one_thread, full, o);
    CHECK(busy.lane_turns >= busy.accepted_steps);
    CHECK(busy.idle_share() >= 0);
    CHECK(busy.idle_share() <= 0.01);  // all of the same length: at most an iteration or two of 4096
}

TEST_CASE("a finished ensemble reports no work and no idle lanes", "[report]") {
    auto e = two_failures();
    solve<cash_karp>(one_thread, e);
    for (std::int64_t i = 0; i < e.size(); ++i) myriad::host::ensemble_access::data(e).mark_invalid(i);
    const auto report = solve<cash_karp>(one_thread, e);
    CHECK(report.accepted_steps == 0);
    CHECK(report.idle_share() == 0);
    CHECK(report.count(status::invalid_input) == 10);
    CHECK(report.first_failed == 0);
}

TEST_CASE("progress counts the instances that are done, and all of them once, at the end", "[report]") {
    using myriad::schedule;
    for (const schedule how : {schedule::automatic, schedule::in_order, schedule::dynamic, schedule::by_cost}) {
        CAPTURE(myriad::name_of(how));
        auto e = good_decays(5000);
        std::vector<std::int64_t> told, done;
        options o;
        o.phases = 2;
        o.schedule = how;
        o.chunk_size = 1000;  // a GPU reports after each
        o.progress = [&](std::int64_t now, std::int64_t) {
            told.push_back(now);
            done.push_back((std::as_const(e).phases_done() == 2).count());
        };
        const auto report = solve<cash_karp>(one_thread, e, o);
        for (std::size_t k = 0; k < told.size(); ++k) {
            CHECK(told[k] <= done[k]);
            // Those of a pack are counted one by one. On a GPU, the next chunk may have been downloaded by then.
            if (tests::tests_cpu()) CHECK(done[k] - told[k] < report.lanes);
        }
        CHECK(told.size() >= 5);
        CHECK(told.back() == 5000);
        CHECK(std::count(told.begin(), told.end(), 5000) == 1);
    }
}

TEST_CASE("the progress function is called from the calling thread, with counts that never fall", "[report]") {
    for (const auto how : {myriad::schedule::automatic, myriad::schedule::in_order}) {
        for (const int threads : {1, 2}) {
            CAPTURE(myriad::name_of(how), threads);
            auto e = good_decays(5000);
            std::vector<std::int64_t> told;
            bool elsewhere = false;
            std::int64_t total = 0;
            options o;
            o.schedule = how;
            o.chunk_size = 1000;  // a GPU reports after each
            const auto caller = std::this_thread::get_id();
            o.progress = [&](std::int64_t done, std::int64_t all) {
                told.push_back(done);
                total = all;
                elsewhere = elsewhere || std::this_thread::get_id() != caller;
            };
            solve<cash_karp>(tests::test_device(threads), e, o);
            // the second thread may have taken all instances before the first looks
            REQUIRE(told.size() >= (threads == 1 ? 2u : 1u));
            CHECK(total == 5000);
            CHECK_FALSE(elsewhere);
            CHECK(told.back() == 5000);
            CHECK(std::is_sorted(told.begin(), told.end()));  // a count is told again where none has ended for a while
        }
    }
}

TEST_CASE("progress of few instances, each of them long, is told one by one", "[report]") {
    auto e = good_decays(6);
    std::vector<std::int64_t> told;
    options o;
    o.chunk_size = 1;
    o.progress = [&](std::int64_t done, std::int64_t) { told.push_back(done); };
    solve<cash_karp>(one_thread, e, o);
    told.erase(std::unique(told.begin(), told.end()), told.end());  // told again where none has ended for a while
    CHECK(told == std::vector<std::int64_t>{1, 2, 3, 4, 5, 6});
}

TEST_CASE("the progress function changes no result", "[report]") {
    auto e = good_decays(300), silent = good_decays(300);
    options o;
    o.progress = [](std::int64_t, std::int64_t) {};
    solve<cash_karp>(tests::test_device(2), e, o);
    solve<cash_karp>(tests::test_device(2), silent);
    CHECK((e.state(bare::x) == silent.state(bare::x)).all());
    CHECK((e.accepted_steps() == silent.accepted_steps()).all());
}

TEST_CASE("an exception of the progress function reaches the caller of solve, once and whole", "[report]") {
    struct cancelled : std::runtime_error {
        using std::runtime_error::runtime_error;
    };
    for (const int threads : {1, 2}) {
        CAPTURE(threads);
        auto e = good_decays(2000);
        int calls = 0;
        options o;
        o.chunk_size = 500;
        o.progress = [&](std::int64_t, std::int64_t) {
            ++calls;
            throw cancelled("enough");
        };
        std::string said;
        try {
            solve<cash_karp>(tests::test_device(threads), e, o);
        } catch (const cancelled& c) {
            said = c.what();
        }
        CHECK(said == "enough");
        CHECK(calls == 1);
        if (threads == 1) CHECK(e.phases_done().sum() < 2000);  // no further instances were begun
        // The ensemble is intact: after a restart it gives the results that it would have given.
        auto fresh = good_decays(2000);
        e.state(bare::x) = fresh.state(bare::x);
        e.state(bare::w) = fresh.state(bare::w);
        e.restart();
        solve<cash_karp>(tests::test_device(threads), e);
        solve<cash_karp>(tests::test_device(threads), fresh);
        CHECK((e.state(bare::x) == fresh.state(bare::x)).all());
    }
}

TEST_CASE("the number of threads is the device's, or that of OpenMP", "[report]") {
    auto e = good_decays(1000);
    CHECK(solve<cash_karp>(device::parse("cpu:3"), e).threads == 3);
    CHECK(solve<cash_karp>(device::cpu(), e).threads == omp_get_max_threads());
}

}  // namespace
