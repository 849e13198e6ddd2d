// SPDX-License-Identifier: MIT
// Ensembles that a GPU takes in several chunks, three at a time: no bit depends on the chunks, and a refusal applies to
// the whole ensemble. On the CPU the same holds for one loop over all.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/host/solve/fill.hpp"

using namespace solving;
using myriad::runge_kutta_4;
using myriad::status;
using tests::test_device;
using drifts = myriad::ensemble<drift>;

namespace {

constexpr std::int64_t size = 400'003;  // more than are checked at once, and not a multiple of a chunk

/// Every thousandth instance ends itself in its second phase.
void fill(drifts& e) {
    for (std::int64_t i = 0; i < e.size(); ++i) {
        e.parameter(drift::speed)(i) = static_cast<double>(i % 1000);
        e.t_begin()(i) = 0;
        e.t_end()(i) = 1 + 0.25 * static_cast<double>(i % 3);
    }
    e.state(drift::x) = Eigen::ArrayXd::LinSpaced(e.size(), 0, 1);
    e.accessory(drift::limit) = 1500;
    e.integer_accessory(drift::phases) = 0;
}

drifts filled(std::int64_t count = size) {
    drifts e(count);
    fill(e);
    return e;
}

myriad::options quarter_steps(std::int64_t chunk) {
    myriad::options o;
    o.step = 0.25;
    o.phases = 2;
    o.chunk_size = chunk;
    return o;
}

bool same(const drifts& a, const drifts& b) {
    bool all = same_bits(a.state(0), b.state(0)) && same_bits(a.t(), b.t()) &&
               same_bits(a.next_step(), b.next_step()) && same_bits(a.phases_done(), b.phases_done()) &&
               same_bits(a.accepted_steps(), b.accepted_steps()) &&
               same_bits(a.integer_accessory(0), b.integer_accessory(0)) && same_bits(a.accessory(0), b.accessory(0)) &&
               same_bits(a.rhs_evaluations(), b.rhs_evaluations());
    for (std::int64_t i = 0; i < a.size(); ++i) all = all && a.status(i) == b.status(i) && a.ended(i) == b.ended(i);
    return all;
}

}  // namespace

TEST_CASE("chunks of a large ensemble, chosen or not, change no bit and no figure of the report") {
    auto whole = filled();
    auto o = quarter_steps(size);
    o.record = {.from_phase = 1, .states = {drift::x}, .integer_accessories = {drift::phases}, .time = true};
    const auto expected = myriad::solve<runge_kutta_4>(test_device(), whole, o);
    CHECK(expected.instances == size);
    CHECK(expected.count(status::stopped_by_user) > 0);
    for (const std::int64_t chunk : {std::int64_t{0}, std::int64_t{33'333}, std::int64_t{150'000}, size - 1}) {
        auto parts = filled();
        o.chunk_size = chunk;
        const auto report = myriad::solve<runge_kutta_4>(test_device(), parts, o);
        INFO("chunk_size " << chunk);
        CHECK(same(parts, whole));
        CHECK(report.instances == size);
        CHECK(report.by_status == expected.by_status);
        CHECK(report.accepted_steps == expected.accepted_steps);
        CHECK(report.rhs_evaluations == expected.rhs_evaluations);
        CHECK(same_bits(report.records.state(drift::x), expected.records.state(drift::x)));
        CHECK(same_bits(report.records.time(), expected.records.time()));
        CHECK(same_bits(report.records.integer_accessory(drift::phases),
                        expected.records.integer_accessory(drift::phases)));
    }
}

TEST_CASE(
    "an ensemble whose memory is pinned gives the same bits in chunks, whatever was allocated after it was pinned") {
    auto o = quarter_steps(33'333);
    o.record = {.from_phase = 1, .states = {drift::x}, .time = true};
    auto ordinary = filled();
    const auto expected = myriad::solve<runge_kutta_4>(test_device(), ordinary, o);
    for (const bool fill_first : {true, false}) {
        drifts made(size);
        if (fill_first) fill(made);
        made.pin(test_device());
        made.pin(test_device());
        if (!fill_first) fill(made);  // now with time domains of its own
        drifts pinned = std::move(made);
        const auto report = myriad::solve<runge_kutta_4>(test_device(), pinned, o);
        CHECK(same(pinned, ordinary));
        CHECK(report.by_status == expected.by_status);
        CHECK(report.accepted_steps == expected.accepted_steps);
        CHECK(same_bits(report.records.state(drift::x), expected.records.state(drift::x)));
        pinned.restart();
        fill(pinned);
        myriad::solve<runge_kutta_4>(test_device(), pinned, o);
        CHECK(same(pinned, ordinary));
        drifts other = filled(100'000);
        other.pin(test_device());
        other = std::move(pinned);  // releases the memory pinned there
        CHECK(same(other, ordinary));
    }
}

TEST_CASE("a pinned ensemble of many chunks, of which more are begun while the last are checked, gives the same bits") {
    constexpr std::int64_t many = 1'300'003;
    auto o = quarter_steps(0);
    o.phases = 1;
    auto ordinary = filled(many), pinned = filled(many), bad = filled(many);
    myriad::solve<runge_kutta_4>(test_device(), ordinary, o);
    pinned.pin(test_device());
    myriad::solve<runge_kutta_4>(test_device(), pinned, o);
    CHECK(same(pinned, ordinary));
    bad.pin(test_device());
    bad.state(drift::x)(many - 1) = std::numeric_limits<double>::infinity();
    refused([&] { myriad::solve<runge_kutta_4>(test_device(), bad, o); }, {"state 0", "instance 1300002"});
    CHECK((bad.phases_done() == 0).all());
    CHECK(myriad::host::ensemble_access::data(bad).untouched);
}
TEST_CASE("a small ensemble whose memory is pinned gives the same bits") {
    auto ordinary = filled(10), pinned = filled(10);
    pinned.pin(test_device());
    myriad::solve<runge_kutta_4>(test_device(), ordinary, quarter_steps(3));
    myriad::solve<runge_kutta_4>(test_device(), pinned, quarter_steps(0));
    CHECK(same(pinned, ordinary));
}

TEST_CASE("chunks go on from an earlier call, with the work of this call in the report") {
    auto at_once = filled(), twice = filled();
    auto o = quarter_steps(60'000);
    o.phases = 4;
    const auto expected = myriad::solve<runge_kutta_4>(test_device(), at_once, o);
    o.phases = 2;
    const auto first = myriad::solve<runge_kutta_4>(test_device(), twice, o);
    const auto second = myriad::solve<runge_kutta_4>(test_device(), twice, o);
    CHECK(same(twice, at_once));
    CHECK(first.accepted_steps + second.accepted_steps == expected.accepted_steps);
    CHECK(second.accepted_steps > 0);
    CHECK(second.accepted_steps < first.accepted_steps);  // some instances have ended
}

TEST_CASE("bad input in the last chunk is refused, and leaves all chunks as they were, of pinned memory too") {
    for (const std::int64_t bad : {std::int64_t{0}, std::int64_t{200'000}, size - 1, size - 2}) {
        auto e = filled();
        if (bad >= size - 2) e.pin(test_device());
        const auto before = filled();
        e.parameter(drift::speed)(bad) = std::numeric_limits<double>::quiet_NaN();
        refused([&] { myriad::solve<runge_kutta_4>(test_device(), e, quarter_steps(20'000)); },
                {"parameter 0 (speed) is not finite in 1 of 400003 instances",
                 myriad::message("instance ", bad, ' ').c_str()});
        CHECK((e.state(drift::x) == before.state(drift::x)).all());
        CHECK(e.phases_done().maxCoeff() == 0);
        CHECK(e.status(0) == status::not_started);
        CHECK(myriad::host::ensemble_access::data(e).untouched);
        e.parameter(drift::speed)(bad) = 1;
        CHECK(myriad::solve<runge_kutta_4>(test_device(), e, quarter_steps(20'000)).failed() == 0);
    }
}

TEST_CASE("bad input in the last chunk is marked, and all others run as if it were not there") {
    auto o = quarter_steps(20'000);
    auto clean = filled();
    myriad::solve<runge_kutta_4>(test_device(), clean, o);
    o.invalid_instances = myriad::invalid_instances::mark;
    auto e = filled();
    const std::int64_t bad[] = {5, 210'000, size - 1};
    for (const std::int64_t i : bad) e.state(drift::x)(i) = std::numeric_limits<double>::infinity();
    const auto report = myriad::solve<runge_kutta_4>(test_device(), e, o);
    CHECK(report.count(status::invalid_input) == 3);
    CHECK(report.first_failed == 5);
    for (const std::int64_t i : bad) {
        CHECK(e.status(i) == status::invalid_input);
        CHECK(e.phases_done()(i) == 0);
        CHECK(e.accepted_steps()(i) == 0);
    }
    std::int64_t different = 0;
    for (std::int64_t i = 0; i < size; ++i)
        different += e.state(drift::x)(i) != clean.state(drift::x)(i) || e.status(i) != clean.status(i) ||
                     e.t()(i) != clean.t()(i);
    CHECK(different == 3);
}

TEST_CASE("instances that fail or are marked in later chunks of a pinned ensemble are told from all others") {
    auto o = quarter_steps(20'000);
    o.invalid_instances = myriad::invalid_instances::mark;
    auto clean = filled(), ordinary = filled(), pinned = filled();
    myriad::solve<runge_kutta_4>(test_device(), clean, o);
    const std::int64_t bad[] = {30'001, size - 2}, fails[] = {210'000, size - 1};
    myriad::report<drift, double> reports[2];
    pinned.pin(test_device());
    for (drifts* const e : {&ordinary, &pinned}) {
        for (const std::int64_t i : bad) e->parameter(drift::speed)(i) = std::numeric_limits<double>::quiet_NaN();
        // Finite at first, infinite after a step.
        for (const std::int64_t i : fails) e->parameter(drift::speed)(i) = std::numeric_limits<double>::max();
        reports[e == &pinned] = myriad::solve<runge_kutta_4>(test_device(), *e, o);
    }
    CHECK(same(pinned, ordinary));
    CHECK(reports[1].by_status == reports[0].by_status);
    CHECK(reports[1].count(status::invalid_input) == 2);
    CHECK(reports[1].count(status::not_finite) == 2);
    CHECK(reports[1].first_failed == 30'001);
    CHECK(reports[1].accepted_steps == reports[0].accepted_steps);
    for (const std::int64_t i : bad) CHECK(pinned.status(i) == status::invalid_input);
    const auto before = filled();
    for (const std::int64_t i : fails) {
        CHECK(pinned.status(i) == status::not_finite);
        CHECK(pinned.state(drift::x)(i) == before.state(drift::x)(i));  // the last finite one
    }
    std::int64_t different = 0;
    for (std::int64_t i = 0; i < size; ++i)
        different += pinned.state(drift::x)(i) != clean.state(drift::x)(i) || pinned.status(i) != clean.status(i);
    CHECK(different == 4);
}

TEST_CASE(
    "samples and scales of tolerances that a pinned ensemble is asked for later come in chunks as in an ordinary one") {
    using dense = myriad::dense<myriad::tsitouras_5>;
    auto o = usual();
    o.samples = {.states = {swing::x, swing::v}, .capacity = 40, .evenly = 10};
    myriad::ensemble<swing> ordinary(1000), pinned(1000);
    fill(ordinary);
    fill(pinned);
    pinned.pin(test_device());
    for (const std::int64_t chunk : {170, 0, 999}) {  // the last samples do not fit
        o.chunk_size = chunk;
        o.phases = chunk == 0 ? 2 : 1;
        myriad::solve<dense>(test_device(), pinned, o);
        myriad::solve<dense>(test_device(), ordinary, o);
        CHECK(same_results(pinned, ordinary));
        CHECK(same_bits(pinned.samples().stored(), ordinary.samples().stored()));
        CHECK(same_bits(pinned.samples().time(), ordinary.samples().time()));
        for (const int c : {swing::x, swing::v})
            CHECK(same_bits(pinned.samples().state(c), ordinary.samples().state(c)));
    }
    CHECK(pinned.samples().stored().minCoeff() == 40);
    CHECK(pinned.samples().state(swing::v).isFinite().all());
}

TEST_CASE("a restarted ensemble gives the bits of a new one, on engines that were used before") {
    auto fresh = filled(), used = filled();
    myriad::options o = quarter_steps(0);
    o.chunk_size = 100'000;
    myriad::solve<runge_kutta_4>(test_device(), fresh, o);
    myriad::solve<myriad::cash_karp>(test_device(), used, o);  // leaves next step sizes behind
    used.restart();
    fill(used);
    myriad::solve<runge_kutta_4>(test_device(), used, o);
    CHECK(same(used, fresh));
    auto small = filled(10);
    auto small_after = filled(10);
    myriad::solve<runge_kutta_4>(test_device(), small, quarter_steps(10));
    myriad::solve<runge_kutta_4>(test_device(), small_after, quarter_steps(3));
    CHECK(same(small, small_after));
}

TEST_CASE("next steps are zero with fixed steps, kept from an adaptive method over these, and zero after a restart") {
    for (const bool pinned : {false, true}) {
        auto e = filled(40'000);
        if (pinned) e.pin(test_device());
        const auto o = quarter_steps(15'000);
        myriad::solve<runge_kutta_4>(test_device(), e, o);
        CHECK((e.next_step() == 0).all());
        myriad::solve<myriad::cash_karp>(test_device(), e, o);
        const Eigen::ArrayXd kept = e.next_step();
        CHECK((kept > 0).count() > 0);  // zero for those that ended before
        myriad::solve<runge_kutta_4>(test_device(), e, o);
        CHECK((e.next_step() == kept).all());
        e.restart();
        CHECK((e.next_step() == 0).all());
        CHECK((e.phases_done() == 0).all());
    }
}

TEST_CASE("rejected steps that an adaptive method counted stay while a fixed-step one goes on, in chunks too") {
    auto o = usual();
    o.phases = 1;
    o.chunk_size = 300;
    for (const bool pin : {false, true}) {
        myriad::ensemble<swing> e(1000);
        fill(e);
        if (pin) e.pin(test_device());
        o.step = 0.01;
        CHECK(myriad::solve<runge_kutta_4>(test_device(), e, o).rejected_steps == 0);
        CHECK(myriad::host::ensemble_access::data(e).counters()[1] == nullptr);
        o.step = 1;  // too long for the tolerances
        const auto report = myriad::solve<myriad::cash_karp>(test_device(), e, o);
        const Eigen::ArrayX<std::int64_t> rejected = e.rejected_steps(), accepted = e.accepted_steps();
        CHECK(rejected.minCoeff() > 0);
        CHECK(report.rejected_steps == rejected.sum());
        o.step = 0.01;
        const auto after = myriad::solve<runge_kutta_4>(test_device(), e, o);
        CHECK(after.rejected_steps == 0);
        CHECK((e.rejected_steps() == rejected).all());
        CHECK(e.accepted_steps().sum() == accepted.sum() + after.accepted_steps);
    }
}

TEST_CASE("progress of chunks rises to the total, and an exception of it ends the work after what is under way") {
    if (tests::tests_cpu()) return;  // where this is reported differently
    auto o = quarter_steps(50'000);
    std::vector<std::int64_t> told;
    o.progress = [&](std::int64_t now, std::int64_t all) {
        CHECK(all == size);
        told.push_back(now);
    };
    auto e = filled();
    myriad::solve<runge_kutta_4>(test_device(), e, o);
    CHECK(std::is_sorted(told.begin(), told.end()));
    told.erase(std::unique(told.begin(), told.end()), told.end());  // a slow chunk is told of more than once
    if (told.front() == 0) told.erase(told.begin());
    CHECK(told.size() == 9);
    CHECK(told.front() == 50'000);
    CHECK(told.back() == size);
    o.progress = [](std::int64_t, std::int64_t) { throw std::runtime_error("enough"); };
    auto part = filled();
    CHECK_THROWS_AS(myriad::solve<runge_kutta_4>(test_device(), part, o), std::runtime_error);
    CHECK(part.status(0) == status::success);
    CHECK(part.status(49'000) == status::success);
    CHECK(part.status(size - 1) == status::not_started);
    o.progress = nullptr;
    myriad::solve<runge_kutta_4>(test_device(), part = filled(), o);
    CHECK(same(part, e));
}

TEST_CASE("a large solver's arrays come and go row by row where it holds more than it is asked for") {
    const auto expected = [] {
        auto e = filled(30'000);
        myriad::solve<runge_kutta_4>(test_device(), e, quarter_steps(0));
        return e;
    }();
    myriad::solver<drift, runge_kutta_4> s(test_device(), 70'000, quarter_steps(0));
    fill(s.instances());
    s.instances().state(drift::x).head(30'000) = Eigen::ArrayXd::LinSpaced(30'000, 0, 1);
    s.upload(30'000);
    s.integrate();
    s.download();
    CHECK(same_bits(Eigen::ArrayXd(s.instances().state(drift::x).head(30'000)),
                    Eigen::ArrayXd(expected.state(drift::x))));
    CHECK(s.instances().phases_done()(29'999) == expected.phases_done()(29'999));
    CHECK(s.instances().phases_done()(30'000) == 0);
    CHECK(s.instances().integer_accessory(drift::phases)(29'999) == expected.integer_accessory(drift::phases)(29'999));
    CHECK(s.instances().integer_accessory(drift::phases)(30'000) == 0);
    CHECK(s.report().accepted_steps == expected.accepted_steps().sum());
}
