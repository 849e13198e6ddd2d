// SPDX-License-Identifier: MIT
// Schedules change only the order of the work, on either device; sorting by cost sorts.
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "myriad/host/backend/cost_order.hpp"
#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/host/solve/fill.hpp"

using namespace solving;
using myriad::cash_karp;
using myriad::schedule;
using tests::test_device;
using tests::tests_cpu;

namespace {

constexpr schedule all_schedules[] = {schedule::automatic, schedule::in_order, schedule::dynamic, schedule::by_cost};

/// More than run at once, so that lanes and threads take further instances.
std::int64_t many() { return tests_cpu() ? 2000 : 300'000; }

myriad::options phases_of(std::int64_t phases, schedule how) {
    myriad::options o = usual();
    o.phases = phases;
    o.schedule = how;
    return o;
}

/// Costs spread over three decades, some zero.
std::vector<std::uint32_t> some_costs(std::size_t count) {
    std::vector<std::uint32_t> cost(count);
    for (std::size_t i = 0; i < count; ++i)
        cost[i] = i % 97 == 0 ? 0 : static_cast<std::uint32_t>((i * 7919) % 10007 + 1);
    return cost;
}

}  // namespace

TEST_CASE("instances are sorted by cost, the most expensive first, each once") {
    const auto cost = some_costs(5000);
    const auto order = myriad::detail::order_by_cost(cost.data(), 5000);
    std::vector<std::uint32_t> sorted(order);
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t i = 0; i < 5000; ++i) REQUIRE(sorted[i] == i);
    for (std::size_t k = 1; k < order.size(); ++k) {
        // costs of one bucket differ by one in 32 at most
        CHECK(cost[order[k]] <= cost[order[k - 1]] * (1 + 1.0 / 32));
        if (cost[order[k - 1]] == 0) CHECK(cost[order[k]] == 0);
    }
}

TEST_CASE("every cost has a bucket, and more cost no later one") {
    int last = myriad::detail::cost_buckets;
    for (const std::uint32_t cost : {0u, 1u, 2u, 3u, 100u, 1'000'000u, 2'000'000'000u, 4'294'967'295u}) {
        CAPTURE(cost);
        const int bucket = myriad::detail::cost_bucket(cost);
        CHECK(bucket >= 0);
        CHECK(bucket < last);
        last = bucket;
    }
}

TEST_CASE("schedules change no bit of any result, records included", "[small]") {
    const auto integrated = [](std::int64_t size, schedule how, std::int64_t from_phase) {
        myriad::options o = phases_of(5, how);
        o.record = {.from_phase = from_phase, .states = {swing::x}, .integer_accessories = {swing::my_phase}};
        o.max_steps = 70;  // exceeded by the longest phases
        struct {
            myriad::ensemble<swing> e;
            myriad::report<swing, double> report;
        } done{myriad::ensemble<swing>(size), {}};
        fill(done.e);
        done.report = myriad::solve<cash_karp>(test_device(2), done.e, o);
        return done;
    };
    for (const std::int64_t size : {std::int64_t{100}, many()}) {
        for (const std::int64_t from_phase : {0, 2}) {
            const auto plain = integrated(size, schedule::in_order, from_phase);
            CHECK(plain.report.failed() > 0);
            CHECK(plain.report.failed() < size / 2);
            for (const schedule how : {schedule::automatic, schedule::dynamic, schedule::by_cost}) {
                INFO(name_of(how) << ", " << size << " instances");
                const auto other = integrated(size, how, from_phase);
                CHECK(same_results(other.e, plain.e));
                CHECK(((other.report.records.state(swing::x) == plain.report.records.state(swing::x)) ||
                       (other.report.records.state(swing::x).isNaN() && plain.report.records.state(swing::x).isNaN()))
                          .all());
                CHECK((other.report.records.integer_accessory(swing::my_phase) ==
                       plain.report.records.integer_accessory(swing::my_phase))
                          .all());
            }
        }
    }
}

TEST_CASE("a solver sorts by the costs of its last call, and gives the same bits") {
    const std::int64_t size = tests_cpu() ? 200 : 50'000;
    const auto integrated = [size](schedule how) {
        myriad::solver<swing, cash_karp> s(test_device(), size, phases_of(2, how));
        fill(s.instances());
        s.upload();
        for (const std::int64_t phases : {2, 1, 3}) s.integrate(phases);
        s.download();
        std::vector<double> x(s.results().state(swing::x).begin(), s.results().state(swing::x).end());
        return x;
    };
    const auto plain = integrated(schedule::in_order);
    for (const schedule how : all_schedules) {
        INFO(name_of(how));
        CHECK(integrated(how) == plain);
    }
}

TEST_CASE("the report says how a GPU was scheduled, which automatic chooses by phases and size") {
    const auto used = [](std::int64_t size, std::int64_t phases, schedule how) {
        myriad::ensemble<swing> e(size);
        fill(e);
        return myriad::solve<cash_karp>(test_device(), e, phases_of(phases, how)).kernel.schedule;
    };
    if (tests_cpu()) {
        CHECK(used(100, 4, schedule::by_cost) == schedule::in_order);  // the value reported without a kernel
        return;
    }
    CHECK(used(100'000, 4, schedule::automatic) == schedule::by_cost);
    CHECK(used(100'000, 3, schedule::automatic) == schedule::in_order);
    CHECK(used(1000, 4, schedule::automatic) == schedule::in_order);
    CHECK(used(1000, 3, schedule::by_cost) == schedule::by_cost);
    CHECK(used(1000, 4, schedule::dynamic) == schedule::dynamic);
}

TEST_CASE("a schedule that is none is refused", "[small]") {
    myriad::options o = phases_of(1, static_cast<schedule>(9));
    refused(
        [&] {
            myriad::ensemble<swing> e(3);
            fill(e);
            myriad::solve<cash_karp>(test_device(), e, o);
        },
        {"schedule is 9", "choose automatic"});
}

TEST_CASE("schedules change no bit of phases that carry time and step on, nor of instances that have ended before") {
    const auto integrated = [](schedule how) {
        myriad::options o = phases_of(4, how);
        o.phase_length = 0.75;
        o.phase_step = myriad::phase_step::carry_on;
        o.max_steps = 70;
        myriad::ensemble<swing> e(500);
        fill(e);
        e.state(swing::x)(17) = std::numeric_limits<double>::quiet_NaN();
        o.invalid_instances = myriad::invalid_instances::mark;
        for (int call = 0; call < 2; ++call) {
            e.t_end() += 3;
            myriad::solve<cash_karp>(test_device(2), e, o);
        }
        return e;
    };
    const auto plain = integrated(schedule::in_order);
    for (const schedule how : {schedule::automatic, schedule::dynamic, schedule::by_cost}) {
        INFO(name_of(how));
        CHECK(same_results(integrated(how), plain));
    }
}

TEST_CASE(
    "a solver may get domains of the instances' own after a common one, and fewer instances, with the same bits") {
    // everything except the domains, which would become the instances' own when accessed
    const auto set = [](myriad::ensemble<swing>& e) {
        myriad::ensemble<swing> from(e.size());
        fill(from);
        for (const auto c : {swing::x, swing::v}) e.state(c) = from.state(c);
        for (const auto c : {swing::damping, swing::drive}) e.parameter(c) = from.parameter(c);
        for (const auto c : {swing::highest, swing::my_number}) e.accessory(c) = from.accessory(c);
        e.shared(swing::stiffness) = from.shared(swing::stiffness);
        e.shared(swing::bounce) = from.shared(swing::bounce);
        e.shared_integer(swing::weight) = from.shared_integer(swing::weight);
        e.time_domain(0, 4);
    };
    const auto integrated = [&](bool own_at_once) {
        myriad::solver<swing, cash_karp> s(test_device(), 200, phases_of(2, schedule::by_cost));
        set(s.instances());
        CHECK(s.instances().has_common_domain());
        if (own_at_once) s.instances().t_end()(3) = 4;
        s.upload();
        s.integrate();
        s.download();
        s.instances().restart();
        set(s.instances());
        s.instances().t_end()(3) = 5;
        s.upload(100);
        s.integrate();
        s.download();
        std::vector<double> x(s.results().state(swing::x).begin(), s.results().state(swing::x).end());
        x.insert(x.end(), s.results().t().begin(), s.results().t().end());
        return x;
    };
    const auto late = integrated(false);
    CHECK(late == integrated(true));
    CHECK(late[200 + 3] == 5);
    CHECK(late[200 + 4] == 4);
}
