// SPDX-License-Identifier: MIT
// The solver object, on the CPU and on a GPU alike: the data it copies, several of them in parallel, and its refusals.
#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/host/solve/fill.hpp"

using namespace solving;
using myriad::cash_karp;
using solver = myriad::solver<swing, cash_karp>;
using tests::test_device;

TEST_CASE("a solver gives the bits that solve gives", "[small]") {
    myriad::ensemble<swing> e(333);
    fill(e);
    myriad::options o = usual();
    o.record = {.from_phase = 1,
                .states = {swing::x},
                .accessories = {swing::highest},
                .integer_accessories = {swing::impacts}};
    const auto report = myriad::solve<cash_karp>(test_device(), e, o);

    solver s(test_device(), 333, o);
    fill(s.instances());
    s.upload();
    s.integrate();
    s.download();
    CHECK(same_results(s.instances(), e));
    CHECK(s.report().count(myriad::status::success) == 333);
    CHECK(s.report().accepted_steps == report.accepted_steps);
    CHECK(s.report().rhs_evaluations == report.rhs_evaluations);
    CHECK(s.records().phases() == 2);
    CHECK(same_bits(s.records().state(swing::x), report.records.state(swing::x)));
    CHECK(same_bits(s.records().accessory(swing::highest), report.records.accessory(swing::highest)));
    CHECK(same_bits(s.records().integer_accessory(swing::impacts), report.records.integer_accessory(swing::impacts)));
    CHECK(e.integer_accessory(swing::impacts).maxCoeff() > 0);
    CHECK(e.integer_accessory(swing::my_phase).minCoeff() == 2);
}

TEST_CASE("phases asked for one by one are those asked for at once") {
    solver at_once(test_device(), 100, usual()), one_by_one(test_device(), 100, usual());
    for (solver* s : {&at_once, &one_by_one}) {
        fill(s->instances());
        s->upload();
    }
    at_once.integrate();
    for (int phase = 0; phase < 3; ++phase) one_by_one.integrate(1);
    at_once.download();
    one_by_one.download();
    CHECK(same_results(at_once.instances(), one_by_one.instances()));
}

TEST_CASE("a solver that comes back to the host between calls goes on with the same bits") {
    solver straight(test_device(), 100, usual()), back(test_device(), 100, usual());
    for (solver* s : {&straight, &back}) {
        fill(s->instances());
        s->upload();
    }
    straight.integrate();
    straight.download();
    for (int phase = 0; phase < 3; ++phase) {
        back.integrate(1);
        back.download();
        back.upload();
    }
    CHECK(same_results(straight.instances(), back.instances()));
}

TEST_CASE("refilling one solver while another runs gives the bits of doing it serially", "[small]") {
    constexpr std::int64_t size = 200;
    constexpr int batches = 6;
    std::vector<myriad::ensemble<swing>> serial;
    for (int batch = 0; batch < batches; ++batch) {
        serial.emplace_back(size);
        fill(serial.back(), size * batch);
        myriad::solve<cash_karp>(test_device(), serial.back(), usual());
    }
    solver first(test_device(), size, usual()), second(test_device(), size, usual());
    solver* turns[] = {&first, &second};
    const auto begin = [&](int batch) {
        solver& s = *turns[batch % 2];
        s.instances().restart();
        fill(s.instances(), size * batch);
        s.upload();
        s.integrate();
        s.download();
    };
    begin(0);
    for (int batch = 0; batch < batches; ++batch) {
        if (batch + 1 < batches) begin(batch + 1);
        INFO("batch " << batch);
        CHECK(same_results(turns[batch % 2]->instances(), serial[static_cast<std::size_t>(batch)]));
    }
}

TEST_CASE("fewer instances than the capacity leave the others alone") {
    solver s(test_device(), 100, usual());
    fill(s.instances());
    s.upload(60);
    s.integrate();
    s.download();
    CHECK(s.report().instances == 60);
    CHECK(s.report().count(myriad::status::success) == 60);
    CHECK(s.instances().phases_done()(59) == 3);
    CHECK(s.instances().phases_done()(60) == 0);
    CHECK(s.instances().status(60) == myriad::status::not_started);
    CHECK(s.instances().accessory(swing::my_number)(59) == 59);
    CHECK(s.instances().accessory(swing::my_number)(60) == -1);
}

TEST_CASE("download of chosen components leaves the others on the host as they were") {
    solver s(test_device(), 50, usual());
    fill(s.instances());
    const Eigen::ArrayXd before = s.instances().state(swing::v);
    s.upload();
    s.integrate();
    s.download({.states = {swing::x}, .integer_accessories = {swing::impacts}});
    CHECK(s.instances().phases_done().minCoeff() == 3);
    if (!tests::tests_cpu()) CHECK((s.instances().state(swing::v) == before).all());
    refused([&] { s.upload(); }, {"mix old and new values", "restart()"});
    myriad::ensemble<swing> e(50);
    fill(e);
    myriad::solve<cash_karp>(test_device(), e, usual());
    CHECK(same_bits(s.instances().state(swing::x), e.state(swing::x)));
    s.download();
    CHECK(same_results(s.instances(), e));
}

TEST_CASE("results that were not downloaded cannot be read or overwritten by mistake") {
    myriad::options o = usual();
    o.record = {.from_phase = 2, .states = {swing::x}};
    solver s(test_device(), 50, o);
    refused([&] { s.download(); }, {"download has no instances", "call upload first"});
    fill(s.instances());
    s.upload();
    CHECK(s.results().size() == 50);  // as they were sent
    s.integrate();
    refused([&] { s.instances(); }, {"instances needs the results", "call download"});
    refused([&] { s.results(); }, {"results needs the results", "call download"});
    refused([&] { s.report(); }, {"report needs the results", "call download"});
    refused([&] { s.records(); }, {"records needs the results", "call download"});
    refused([&] { s.upload(); }, {"upload needs the results", "call download"});
    s.download({});
    CHECK(s.report().count(myriad::status::success) == 50);
    CHECK(s.records().phases() == 1);
    s.instances().restart();  // to be refilled
    fill(s.instances());
    s.upload();
    s.integrate();
    s.download();
    CHECK(s.report().count(myriad::status::success) == 50);
}

TEST_CASE("instances that may have been changed are uploaded again before they are integrated") {
    solver s(test_device(), 20, usual());
    fill(s.instances());
    s.upload();
    s.instances().shared(0) = 17;
    refused([&] { s.integrate(); }, {"instances() may have changed them", "call upload", "results()"});
    s.upload();
    s.integrate(1);
    s.download();
    CHECK(s.results().phases_done().minCoeff() == 1);
    s.integrate(1);  // reading changes nothing
    s.download();
    s.instances().state(swing::v) += 0.1;
    refused([&] { s.integrate(1); }, {"instances() may have changed them"});
    s.upload();
    s.integrate(1);
    s.download();
    CHECK(s.results().phases_done().minCoeff() == 3);
}

TEST_CASE("a solver's failed instances that are given new inputs do not stay failed in silence", "[small]") {
    myriad::options o = usual();
    o.max_steps = 5;  // too few for all
    solver s(test_device(), 40, o);
    fill(s.instances());
    s.upload();
    s.integrate();
    s.download();
    REQUIRE(s.report().count(myriad::status::max_steps) == 40);
    const double damping = s.results().parameter(swing::damping)[0];
    s.upload();  // nothing was set
    s.integrate();
    s.download();
    s.instances().parameter(swing::damping)[0] = 17;
    CHECK(s.report().first_state.empty());  // damping is not the failed instance's
    refused([&] { s.upload(); }, {"instance 0 ended in an earlier call (max_steps)", "restart()"});
    s.instances().parameter(swing::damping)[0] = damping;
    CHECK(s.report().first_parameter.size() == 2);
    CHECK_NOTHROW(s.upload());
    fill(s.instances());
    refused([&] { s.upload(); }, {"ended in an earlier call", "as were those of 39 others", "restart()"});
    s.instances().restart();
    CHECK_NOTHROW(s.upload());
}

TEST_CASE("phases of a length, asked of a solver one by one, are those that the CPU has in one call of solve",
          "[small]") {
    myriad::options o = usual();
    o.phase_length = 0.75;
    o.phases = 3;
    o.step = 0.01;
    myriad::ensemble<swing> e(100);
    solver s(test_device(), 100, o), at_once(test_device(), 100, o);
    for (auto* instances : {&e, &s.instances(), &at_once.instances()}) fill(*instances);
    myriad::solve<cash_karp>(test_device(), e, o);
    s.upload();
    for (int phase = 0; phase < 3; ++phase) s.integrate(1);
    at_once.upload();
    at_once.integrate();
    s.download();
    at_once.download();
    CHECK(same_results(s.instances(), e));
    CHECK(same_results(at_once.instances(), e));
    CHECK((e.t() == 2.25).all());
}

TEST_CASE("a solver refuses phases without length however many calls they are asked in", "[small]") {
    myriad::options o = usual();
    o.phases = 1;
    o.phase_time = myriad::phase_time::carry_on;
    solver s(test_device(), 10, o);
    fill(s.instances());
    s.upload();
    s.integrate();
    refused([&] { s.integrate(); }, {"the call has 1 phase after 1 since the upload", "no length", "phase_length"});
    s.download();
    s.instances();
    s.upload();
    refused([&] { s.integrate(); }, {"t has reached t_end", "in all instances that take part"});
    s.instances().t_end() += 1;
    s.upload();
    CHECK_NOTHROW(s.integrate());
}

TEST_CASE("a solver that is given a progress function, which it would not call, is refused", "[small]") {
    myriad::options o = usual();
    o.progress = [](std::int64_t, std::int64_t) {};
    refused([&] { solver s(test_device(), 10, o); }, {"progress is given", "is asynchronous", "idle()"});
}

TEST_CASE("a solver's ensemble cannot be replaced") {
    solver s(test_device(), 20, usual());
    fill(s.instances());
    myriad::ensemble<swing> mine(20);
    fill(mine);
    const auto theirs = std::move(s.instances());
    s.instances() = std::move(mine);
    refused([&] { s.upload(); }, {"was replaced", "set the values of instances()"});
}

TEST_CASE("a solver whose ensemble was replaced after the upload does not read memory that is gone") {
    solver s(test_device(), 20, usual());
    auto& kept = s.instances();
    fill(kept);
    s.upload();
    s.wait();
    kept = myriad::ensemble<swing>(5);
    const char* const said = "was replaced by another";
    refused([&] { s.integrate(); }, {said});
    refused([&] { s.download(); }, {said});
    refused([&] { s.download({.states = {swing::x}}); }, {said});
    refused([&] { s.report(); }, {said});
    kept = myriad::ensemble<swing>(20);  // perhaps in the memory of the first
    fill(kept);
    refused([&] { s.integrate(); }, {said});
    refused([&] { s.upload(); }, {said});
}

TEST_CASE("two threads that use one solver at the same time are refused, and it goes on") {
    solver s(test_device(), 64, usual()), alone(test_device(), 64, usual());
    for (solver* const one : {&s, &alone}) {
        fill(one->instances());
        one->upload();
        one->integrate();
        one->download();
    }
    std::atomic<int> met{0};
    const auto begin = std::chrono::steady_clock::now();
    const auto use = [&] {
        while (met < 1 && std::chrono::steady_clock::now() - begin < std::chrono::seconds(20)) {
            try {
                s.report();
            } catch (const myriad::error& e) {
                CHECK(std::string(e.what()).find("two threads use one solver") != std::string::npos);
                ++met;
            }
        }
    };
    std::thread other(use);
    use();
    other.join();
    CHECK(met >= 1);
    CHECK(same_results(s.results(), alone.results()));
}

TEST_CASE("records of an earlier call do not stay behind") {
    myriad::options o = usual();
    o.phases = 1;
    o.record = {.from_phase = 0, .states = {swing::x}};
    solver s(test_device(), 10, o);
    fill(s.instances());
    s.upload();
    s.integrate();
    s.download();
    CHECK(s.records().state(swing::x).isFinite().all());
    s.instances().restart();
    fill(s.instances());
    s.upload();
    CHECK(s.records().state(swing::x).isNaN().all());
    s.download();
    CHECK(s.records().state(swing::x).isNaN().all());
    s.integrate();
    s.download();
    CHECK(s.records().state(swing::x).isFinite().all());
    s.instances().restart();
    fill(s.instances());
    s.upload(5);
    s.integrate();
    s.download();
    CHECK(s.records().state(swing::x).col(0).head(5).isFinite().all());
    CHECK(s.records().state(swing::x).col(0).tail(5).isNaN().all());
}

TEST_CASE("a solver that waits for another begins when it is done") {
    solver first(test_device(), 64, usual()), second(test_device(), 64, usual());
    fill(first.instances());
    fill(second.instances());
    first.upload();
    second.upload();
    first.integrate();
    second.wait_for(first);
    second.integrate();
    second.wait();
    CHECK(first.idle());
    CHECK(second.idle());
}

TEST_CASE("samples of a solver are those of solve, in one call and in two") {
    using dense = myriad::dense<myriad::tsitouras_5>;
    myriad::options o = usual();
    o.phases = 2;
    o.samples = {.states = {swing::x}, .capacity = 40, .evenly = 10};
    myriad::ensemble<swing> e(70);
    fill(e);
    myriad::solve<dense>(test_device(), e, o);
    myriad::solver<swing, dense> s(test_device(), 70, o);
    fill(s.instances());
    s.upload();
    s.integrate();
    s.download();
    CHECK(same_bits(s.instances().samples().state(swing::x), e.samples().state(swing::x)));
    CHECK(e.samples().stored().minCoeff() == 20);
    myriad::solve<dense>(test_device(), e, o);
    s.upload();
    s.integrate();
    s.download();
    CHECK(same_bits(s.instances().samples().state(swing::x), e.samples().state(swing::x)));
    CHECK(e.samples().stored().minCoeff() == 40);
}

TEST_CASE("what a solver cannot do is refused before any work", "[small]") {
    refused([] { solver s(test_device(), 0); }, {"capacity is 0", "must be positive"});
    refused([] { solver s(test_device(), -3); }, {"capacity is -3", "must be positive"});
    solver s(test_device(), 10, usual());
    refused([&] { s.integrate(); }, {"no instances to work on", "call upload first"});
    refused([&] { s.upload(11); }, {"11 instances", "capacity", "10"});
    refused([&] { s.upload(); }, {"shared parameter 0", "never set"});
    fill(s.instances());
    s.instances().state(swing::v) = std::nan("");
    refused([&] { s.upload(); }, {"state 1", "never set"});
    refused([&] { s.integrate(); }, {"no instances to work on", "call upload first"});
    fill(s.instances());
    s.upload();
    refused([&] { s.integrate(-1); }, {"phases is -1"});
    refused([&] { s.download({.states = {7}}); }, {"names component 7", "has 2"});
    myriad::options o = usual();
    o.block_size = 33;
    refused([&] { solver t(test_device(), 10, o); }, {"block_size is 33", "multiple of 32"});
    o = usual();
    o.record.states = {swing::x};
    solver recording(test_device(), 10, o);
    fill(recording.instances());
    recording.upload();
    refused([&] { recording.integrate(5); }, {"5 phases", "laid out for 3"});
}
