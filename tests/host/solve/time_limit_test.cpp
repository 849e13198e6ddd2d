// SPDX-License-Identifier: MIT
// Calls that are to end: by options::time_limit, or by an exception of the progress function, on every device, with
// instances that would take days.
#include <chrono>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/host/solve/fill.hpp"

using namespace solving;
using myriad::cash_karp;
using myriad::options;
using myriad::runge_kutta_4;
using myriad::schedule;
using myriad::status;
using tests::test_device;
using drifts = myriad::ensemble<drift>;

namespace {

/// Every `endless`-th instance takes for ever, the others a step of 1/4 or a few.
drifts filled(std::int64_t size, std::int64_t endless) {
    drifts e(size);
    e.state(drift::x) = 0.0;
    e.parameter(drift::speed) = 1e-3;
    e.accessory(drift::limit) = 1e300;
    e.integer_accessory(drift::phases) = 0;
    e.t_begin() = 0.0;
    e.t_end() = 1.0;
    for (std::int64_t i = endless - 1; i < size; i += endless) e.t_end()[i] = 1e9;
    return e;
}
options short_steps() {
    options o;
    o.step = o.maximum_step = 0.25;
    o.max_steps = 2'000'000'000;
    return o;
}
using clock_type = std::chrono::steady_clock;
double seconds_since(clock_type::time_point begin) {
    return std::chrono::duration<double>(clock_type::now() - begin).count();
}
/// An instance was done, or ended on its way, or stayed as it was.
void check_each(const drifts& e, std::int64_t endless, std::int32_t phases) {
    std::int64_t wrong = 0;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        const bool is_endless = i % endless == endless - 1, begun = e.integer_accessory(drift::phases)[i] > 0;
        const bool done = e.status(i) == status::success && e.phases_done()[i] == phases && !is_endless;
        const bool left = e.status(i) == status::interrupted && e.ended(i) && (begun || e.state(drift::x)[i] == 0);
        const bool finite = e.t()[i] >= 0 && e.t()[i] < 1e9 && e.state(drift::x)[i] < 1e9;
        if (!(done || left) || !finite) ++wrong;
    }
    CHECK(wrong == 0);
}

template <class Method>
void check_limit(std::int64_t size, std::int64_t endless, const options& o) {
    auto e = filled(size, endless);
    const auto begin = clock_type::now();
    const auto report = myriad::solve<Method>(test_device(2), e, o);
    INFO(report);
    CHECK(seconds_since(begin) < o.time_limit + 30);  // on a busy machine
    CHECK(report.count(status::interrupted) >= size / endless);
    CHECK(report.count(status::interrupted) + report.count(status::success) == size);
    CHECK(report.instances == size);
    CHECK(e.status(endless - 1) == status::interrupted);
    CHECK(report.notes.back().text().find("interrupted: time_limit = ") == 0);
    check_each(e, endless, static_cast<std::int32_t>(o.phases));
}

}  // namespace

TEST_CASE("time_limit ends a call with instances that take for ever, with any schedule, phases and chunks") {
    auto o = short_steps();
    o.time_limit = 0.2;
    for (const auto how : {schedule::automatic, schedule::in_order, schedule::dynamic, schedule::by_cost}) {
        for (const std::int64_t phases : {1, 3}) {
            CAPTURE(static_cast<int>(how), phases);
            o.schedule = how;
            o.phases = phases;
            check_limit<cash_karp>(500, 50, o);
        }
    }
    o.chunk_size = 100;
    check_limit<cash_karp>(1000, 40, o);
    check_limit<runge_kutta_4>(1000, 40, o);
}

TEST_CASE("an endless phase of fixed steps ends by time_limit") {
    auto o = short_steps();
    o.time_limit = 0.2;
    check_limit<runge_kutta_4>(20, 20, o);
}

TEST_CASE("many short phases end by time_limit") {
    auto o = short_steps();
    o.time_limit = 0.2;
    o.phases = 1'000'000'000;
    auto e = filled(40, 100);
    const auto begin = clock_type::now();
    const auto report = myriad::solve<cash_karp>(test_device(2), e, o);
    CHECK(seconds_since(begin) < 5);
    CHECK(report.count(status::interrupted) == 40);
    CHECK(e.phases_done().maxCoeff() > 0);
}

TEST_CASE("a time_limit of a nanosecond leaves instances as they were, or done, and says so of each") {
    auto o = short_steps();
    o.time_limit = 1e-9;
    o.chunk_size = 1000;
    auto e = filled(200'000, 300'000);
    const auto report = myriad::solve<cash_karp>(test_device(2), e, o);
    CHECK(report.count(status::interrupted) > 0);
    CHECK(report.count(status::interrupted) + report.count(status::success) == e.size());
    check_each(e, 300'000, 1);
    std::int64_t untouched = 0;
    for (std::int64_t i = 0; i < e.size(); ++i)
        if (e.status(i) == status::interrupted && e.integer_accessory(drift::phases)[i] == 0) ++untouched;
    CHECK(untouched > 0);
}

TEST_CASE("a time_limit that is not reached changes no bit") {
    auto o = short_steps();
    o.phases = 3;
    auto e = filled(3000, 4000);
    myriad::solve<cash_karp>(test_device(2), e, o);
    for (const double seconds : {600.0, 1e300, std::numeric_limits<double>::infinity()}) {
        o.time_limit = seconds;
        auto again = filled(3000, 4000);
        CHECK(myriad::solve<cash_karp>(test_device(2), again, o).count(status::success) == e.size());
        CHECK(same_results(e, again));
    }
}

TEST_CASE("time_limit is refused if it is negative or no number, and by solvers, which are asynchronous") {
    auto e = filled(3, 10);
    auto o = short_steps();
    for (const double wrong : {-1.0, -1e-300, std::numeric_limits<double>::quiet_NaN()}) {
        o.time_limit = wrong;
        refused([&] { myriad::solve<cash_karp>(test_device(), e, o); }, {"time_limit is ", "must not be negative"});
    }
    o.time_limit = 1;
    refused([&] { myriad::solver<drift, cash_karp>(test_device(), 3, o); },
            {"time_limit is given, but a solver is asynchronous", "max_steps"});
}

TEST_CASE("progress that throws ends instances that take for ever within a second, on a GPU too") {
    for (const std::int64_t chunk : {0, 50}) {
        auto o = short_steps();
        o.chunk_size = chunk;
        auto e = filled(400, 100);
        const auto begin = clock_type::now();
        auto thrown = begin;
        o.progress = [&](std::int64_t, std::int64_t) {
            if (seconds_since(begin) < 0.2) return;
            thrown = clock_type::now();
            throw std::runtime_error("enough");
        };
        CHECK_THROWS_WITH(myriad::solve<cash_karp>(test_device(2), e, o), "enough");
        CHECK(thrown > begin);
        CHECK(seconds_since(thrown) < 5);  // half a second and little more; the machine may be busy
        CHECK(e.status(99) == status::interrupted);
        for (std::int64_t i = 0; i < e.size(); ++i)
            CHECK((e.status(i) == status::success || e.status(i) == status::not_started || i % 100 == 99));
    }
}

TEST_CASE("no instance that progress stopped between its phases says success, with any schedule, chunks and records") {
    constexpr std::int64_t size = 3000;
    constexpr std::int32_t phases = 3;
    const auto check = [](schedule how, std::int64_t chunk, std::int32_t earlier, double after) {
        CAPTURE(static_cast<int>(how), chunk, earlier, after);
        auto o = short_steps();
        o.schedule = how;
        o.chunk_size = chunk;
        o.phases = earlier;
        auto e = filled(size, size + 1);
        if (earlier > 0) myriad::solve<cash_karp>(test_device(2), e, o);
        if (after > 0) e.t_end()[size / 2] = 1e9;  // so that the first phase is the last one
        o.phases = phases;
        if (earlier > 0) o.record.states = {drift::x};
        const auto begin = clock_type::now();
        o.progress = [&](std::int64_t, std::int64_t) {
            if (seconds_since(begin) >= after) throw std::runtime_error("enough");
        };
        CHECK_THROWS_WITH(myriad::solve<cash_karp>(test_device(2), e, o), "enough");
        const status before = earlier > 0 ? status::success : status::not_started;
        std::int64_t wrong = 0;
        for (std::int64_t i = 0; i < size; ++i) {
            const std::int32_t done = e.phases_done()[i] - earlier;
            const bool all = done == phases && e.status(i) == status::success && !e.ended(i);
            const bool left = done < phases && e.status(i) == status::interrupted && e.ended(i);
            const bool same = done == 0 && e.status(i) == before && !e.ended(i);
            if (!(all || left || same)) ++wrong;
        }
        CHECK(wrong == 0);
    };
    for (const auto how : {schedule::automatic, schedule::in_order, schedule::dynamic, schedule::by_cost}) {
        for (const std::int32_t earlier : {0, 2}) {
            for (const std::int64_t chunk : {0, 400}) check(how, chunk, earlier, 0);
            check(how, 0, earlier, 0.1);
        }
    }
}
