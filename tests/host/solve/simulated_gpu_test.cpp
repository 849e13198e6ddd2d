// SPDX-License-Identifier: MIT
// `solve` and `solver` on a simulated GPU, which is randomly delayed and fails on request: its results are those of the
// CPU bit for bit, and after an error nothing is lost, left running or waited for.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "myriad/host/chunks/chunk_plan.hpp"
#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/host/solve/fill.hpp"
#include "tests/host/solve/simulated_engine.hpp"
#include "tests/support/prepared.hpp"

using namespace solving;
using myriad::runge_kutta_4, myriad::cash_karp, myriad::status;
using simulated::call, simulated::the_gpu;
using drifts = myriad::ensemble<drift>;
using swings = myriad::ensemble<swing>;

namespace {

const myriad::device gpu = myriad::device::cuda(), cpu = myriad::device::cpu(1);
const std::vector<myriad::device> one_gpu{gpu}, gpus{myriad::device::cuda(2), gpu, myriad::device::cuda(1)};

/// Every hundredth instance ends itself in its second phase.
void fill(drifts& e) {
    e.state(drift::x) = Eigen::ArrayXd::LinSpaced(e.size(), 0, 1);
    for (std::int64_t i = 0; i < e.size(); ++i) e.parameter(drift::speed)(i) = static_cast<double>(i % 100);
    e.accessory(drift::limit) = 150;
    e.integer_accessory(drift::phases) = 0;
    e.time_domain(0, 1);
}
template <class Ensemble>
Ensemble filled(std::int64_t size) {
    Ensemble e(size);
    fill(e);
    return e;
}

myriad::options two_phases(std::int64_t chunk) {
    myriad::options o;
    o.step = 0.5;
    o.phases = 2;
    o.chunk_size = chunk;
    o.record = {.states = {0}, .time = true};
    return o;
}

/// NaN of any bit pattern marks values that were not recorded.
template <class Table>
bool same_values(const Table& a, const Table& b) {
    return ((a == b) || (a.isNaN() && b.isNaN())).all();
}

template <class Report>
void check_same(const Report& a, const Report& b) {
    CHECK(a.instances == b.instances);
    CHECK(a.by_status == b.by_status);
    CHECK(a.first_failed == b.first_failed);
    CHECK(a.accepted_steps == b.accepted_steps);
    CHECK(a.rejected_steps == b.rejected_steps);
    CHECK(a.located_steps == b.located_steps);
    CHECK(a.rhs_evaluations == b.rhs_evaluations);
    CHECK(same_values(a.records.state(0), b.records.state(0)));
    CHECK(same_values(a.records.time(), b.records.time()));
}

/// Two calls on simulated GPUs, randomly delayed, and two on the CPU; the first ones mark instance `bad`.
template <class Method, class Ensemble>
void check_against_cpu(std::int64_t size, const myriad::options& o, std::int64_t bad, bool pinned,
                       const std::vector<myriad::device>& on = one_gpu) {
    auto here = filled<Ensemble>(size), there = filled<Ensemble>(size);
    if (pinned) here.pin(gpu);
    for (auto* const e : {&here, &there}) e->parameter(0)(bad) = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < 2; ++i) {
        const auto report = myriad::solve<Method>(on, here, o);
        check_same(report, myriad::solve<Method>(cpu, there, o));
        CHECK(report.kernel_seconds > 0);
        CHECK(report.kernel_seconds < report.seconds);
        CHECK(the_gpu.under_way == 0);
    }
    if (o.counting == myriad::counting::on) CHECK(same_results(here, there));
    CHECK(same_bits(here.state(0), there.state(0)));
    CHECK(same_bits(here.phases_done(), there.phases_done()));
    if (o.samples.empty()) return;
    CHECK(same_bits(here.samples().stored(), there.samples().stored()));
    CHECK(same_values(here.samples().state(0), there.samples().state(0)));
}

/// The error's message, or "".
std::string error_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const myriad::error& e) {
        return e.what();
    }
    return "";
}

bool is_as_filled(const drifts& e) {
    const auto before = filled<drifts>(e.size());
    return same_bits(e.state(drift::x), before.state(drift::x)) && e.t().isNaN().all() &&
           (e.phases_done() == 0).all() && (e.integer_accessory(drift::phases) == 0).all() &&
           e.status(0) == status::not_started;
}

}  // namespace

TEST_CASE("whatever the sizes, chunks, methods and delays, a simulated GPU gives the bits and reports of the CPU") {
    std::mt19937 random(1);
    const auto up_to = [&](std::int64_t most) { return std::uniform_int_distribution<std::int64_t>(1, most)(random); };
    for (int turn = 0; turn < 40; ++turn) {
        the_gpu.seed = static_cast<std::uint64_t>(turn);
        the_gpu.longest_delay = turn % 4 == 0 ? 0 : 200;
        const bool many = turn % 16 == 7, pinned = up_to(2) == 1;
        const auto& on = turn % 5 == 2 ? gpus : one_gpu;
        const std::int64_t size = many ? 131'072 + up_to(100'000) : up_to(500), bad = up_to(size) - 1;
        auto o = usual();
        o.invalid_instances = myriad::invalid_instances::mark;
        o.chunk_size = 1 + size / up_to(10);
        o.counting = up_to(3) == 1 ? myriad::counting::off : myriad::counting::on;
        o.record = {.states = {0}, .time = true};
        CAPTURE(turn, size, o.chunk_size, bad, pinned, on.size());
        if (many) {
            o.events = {};
            o.step = 1;
            check_against_cpu<runge_kutta_4, drifts>(size, o, bad, pinned, on);
        } else if (turn % 2 == 0) {
            check_against_cpu<cash_karp, swings>(size, o, bad, pinned, on);
        } else {
            o.samples = {.states = {swing::x}, .capacity = 60, .evenly = 10};
            check_against_cpu<myriad::dense<myriad::tsitouras_5>, swings>(size, o, bad, pinned, on);
        }
    }
    the_gpu.longest_delay = 0;
}

TEST_CASE("no chunk is begun before its data are checked, however late the thread is that does it") {
    using threads = myriad::host::object_pool<std::monostate, myriad::host::worker_thread>;  // idle ones
    const bool pinned = GENERATE(false, true);
    while (threads::all().take({}) != nullptr) continue;
    auto late = std::make_unique<myriad::host::worker_thread>();
    late->ask([] { std::this_thread::sleep_for(std::chrono::milliseconds(50)); });
    threads::all().give({}, std::move(late));
    auto o = two_phases(20'000);
    o.invalid_instances = myriad::invalid_instances::mark;
    check_against_cpu<runge_kutta_4, drifts>(140'003, o, 30'000, pinned);  // in the second chunk
}

TEST_CASE("an error at any call is that of solve, nothing stays at work, and what was not written is as it was") {
    const auto [size, pinned] = GENERATE(table<std::int64_t, bool>({{700, false}, {700, true}, {140'003, true}}));
    auto o = two_phases(size / 5 + 1);  // beyond 131'072 instances chunks are checked while others are integrated
    auto expected = filled<drifts>(size);
    myriad::solve<runge_kutta_4>(cpu, expected, o);
    static std::int64_t new_block_size = 0;
    constexpr std::pair<call, int> calls[] = {{call::make_engine, 3}, {call::reserve, 3}, {call::upload, 5},
                                              {call::integrate, 5},   {call::kernel, 5},  {call::download, 5},
                                              {call::wait, 5}};
    for (const auto& [kind, count] : calls) {
        for (int at = 0; at <= count; at += size > 1000 ? 2 : 1) {
            CAPTURE(size, pinned, static_cast<int>(kind), at);
            auto e = filled<drifts>(size);
            if (pinned) e.pin(gpu);
            if (kind == call::make_engine) o.block_size = new_block_size += 32;  // for which no engine is cached
            the_gpu.wrote = false;
            the_gpu.fail(kind, at);
            const std::string said = error_of([&] { myriad::solve<runge_kutta_4>(gpu, e, o); });
            CHECK(the_gpu.under_way == 0);
            CHECK(the_gpu.has_failed() == (at < count));
            the_gpu.fail(call::none, 0);
            CHECK(said == (at < count ? "the simulated GPU failed" : ""));
            if (!the_gpu.wrote) CHECK(is_as_filled(e));
            if (at < count && size > 1000) continue;  // shown often enough
            e.restart();
            fill(e);
            myriad::solve<runge_kutta_4>(gpu, e, o);
            CHECK(same_results(e, expected));
        }
    }
}

TEST_CASE(
    "a call on several GPUs ends with the error of one of them, or of the progress function, and begins no more") {
    auto o = two_phases(10);
    for (const call kind : {call::upload, call::integrate, call::kernel, call::download, call::wait}) {
        CAPTURE(static_cast<int>(kind));
        auto e = filled<drifts>(700);
        the_gpu.fail(kind, 4);
        CHECK(error_of([&] { myriad::solve<runge_kutta_4>(gpus, e, o); }) == "the simulated GPU failed");
        CHECK(the_gpu.under_way == 0);
        the_gpu.fail(call::none, 0);
    }
    the_gpu.longest_delay = 2000;
    auto e = filled<drifts>(2000), expected = filled<drifts>(2000);
    o.progress = [](std::int64_t done, std::int64_t) {
        if (done > 0) throw std::runtime_error("enough");
    };
    CHECK_THROWS_WITH(myriad::solve<runge_kutta_4>(gpus, e, o), "enough");
    the_gpu.longest_delay = 0;
    const std::int64_t done = (e.phases_done() == 2).count();
    CHECK((done > 0 && done < 2000));
    o.progress = nullptr;
    e.restart();
    fill(e);
    const auto report = myriad::solve<runge_kutta_4>(gpus, e, o);
    CHECK(report.device == "cuda:2, cuda:0, cuda:1");
    myriad::solve<runge_kutta_4>(cpu, expected, o);
    CHECK(same_results(e, expected));
}

TEST_CASE("several GPUs work while inputs are checked: bad ones in the last chunk leave all instances as they were") {
    constexpr std::int64_t size = 800'003;
    const bool pinned = GENERATE(false, true);
    auto o = two_phases(0);
    auto e = filled<drifts>(size), expected = filled<drifts>(size);
    if (pinned) e.pin(gpu);
    e.state(drift::x)(size - 1) = std::numeric_limits<double>::infinity();
    the_gpu.longest_delay = 500;
    refused([&] { myriad::solve<runge_kutta_4>(gpus, e, o); }, {"state 0 (x) is not finite in 1 of 800003"});
    CHECK(the_gpu.under_way == 0);
    e.state(drift::x)(size - 1) = expected.state(drift::x)(size - 1);
    CHECK((is_as_filled(e) && myriad::host::ensemble_access::data(e).untouched));
    const auto report = myriad::solve<runge_kutta_4>(gpus, e, o);
    the_gpu.longest_delay = 0;
    check_same(report, myriad::solve<runge_kutta_4>(cpu, expected, o));
    CHECK(same_results(e, expected));
}

TEST_CASE("a time limit on several GPUs ends some instances and leaves the others done, and says so of each") {
    constexpr std::int64_t size = 6000;
    auto o = two_phases(10);
    o.time_limit = 0.05;
    the_gpu.longest_delay = 2000;  // of each of the three tasks of a chunk, so that all take longer
    auto e = filled<drifts>(size), expected = filled<drifts>(size);
    const auto report = myriad::solve<runge_kutta_4>(gpus, e, o);
    the_gpu.longest_delay = 0;
    myriad::solve<runge_kutta_4>(cpu, expected, two_phases(10));
    CHECK(the_gpu.under_way == 0);
    const std::int64_t left = report.count(status::interrupted);
    CHECK((left > 0 && left < size));
    CHECK(report.failed() == left);
    std::int64_t seen = 0;
    for (std::int64_t i = 0; i < size; ++i) {
        if (e.status(i) == status::interrupted) {
            seen += e.ended(i);
        } else {
            CHECK((e.status(i) == expected.status(i) && e.state(drift::x)(i) == expected.state(drift::x)(i)));
        }
    }
    CHECK(seen == left);
}

TEST_CASE("several devices of a call are GPUs, and at least one is given") {
    auto e = filled<drifts>(2);
    const auto said = [&](const std::vector<myriad::device>& on) {
        return error_of([&] { myriad::solve<runge_kutta_4>(on, e, two_phases(1)); });
    };
    CHECK(said({gpu, cpu}) == "the devices are cuda:0, cpu:1, and several devices of a call must be GPUs");
    CHECK(said({cpu, cpu}) == "the devices are cpu:1, cpu:1, and several devices of a call must be GPUs");
    CHECK(said({}) == "no device is given");
    CHECK(is_as_filled(e));
}

TEST_CASE("too little memory for one of three chunks is an error that leaves the ensemble as it was") {
    const std::int64_t size = 140'000, unlimited = the_gpu.memory;
    auto enough = filled<drifts>(size);
    std::int64_t of_three = 0;
    auto o = two_phases(20'000);
    o.progress = [&](std::int64_t, std::int64_t) { of_three = the_gpu.used; };
    myriad::solve<runge_kutta_4>(gpu, enough, o);
    for (const int chunks : {0, 1, 2}) {
        the_gpu.memory = of_three * (2 * chunks + 1) / 6;  // half a chunk more
        auto e = filled<drifts>(size);
        refused([&] { myriad::solve<runge_kutta_4>(gpu, e, o); }, {"out of device memory"});
        CHECK(is_as_filled(e));
        CHECK(myriad::host::ensemble_access::data(e).untouched);
        CHECK(the_gpu.used == 0);
    }
    the_gpu.memory = unlimited;
    CHECK(of_three > 0);
}

TEST_CASE(
    "chunks cover the ensemble; where none is chosen the first and last are smaller, down to a "
    "quarter, and none is more so") {
    drifts e(1);
    simulated::engine<drift, runge_kutta_4, double> worker;
    const auto plan_for = [&](std::int64_t size, std::int64_t chosen) {
        const auto o = two_phases(chosen);
        auto call = tests::prepare<runge_kutta_4>(e, o);
        call.arguments().size = size;
        return myriad::host::chunk_plan(o, call.arguments(), worker);
    };
    std::mt19937_64 random(1);
    for (int turn = 0; turn < 2000; ++turn) {
        const std::int64_t size =
            1 + static_cast<std::int64_t>(std::exp2(24 * std::uniform_real_distribution<>()(random)));
        const std::int64_t chosen =
            turn % 2 == 0 ? 0 : 1 + size / std::uniform_int_distribution<std::int64_t>(1, 50)(random);
        const auto plan = plan_for(size, chosen);
        std::vector<std::int64_t> counts;
        for (std::int64_t first = 0; first < size; first += counts.back()) {
            counts.push_back(plan.count_from(first));
            REQUIRE(counts.back() > 0);
        }
        CAPTURE(size, chosen, counts);
        CHECK(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}) == size);
        CHECK(plan.has_one_chunk() == (counts.size() == 1));
        CHECK(plan.at_a_time() == std::min<std::int64_t>(3, static_cast<std::int64_t>(counts.size())));
        CHECK(*std::max_element(counts.begin(), counts.end()) <= plan.largest());
        if (chosen > 0) {
            CHECK(std::all_of(counts.begin(), counts.end() - 1, [&](std::int64_t c) { return c == chosen; }));
        } else if (counts.size() > 1) {
            CHECK(counts.size() >= 6);
            CHECK(counts.size() <= 36);
            CHECK(counts.front() == plan.largest() / 4);
            CHECK(*std::min_element(counts.begin(), counts.end()) == plan.largest() / 4);
            CHECK(counts.back() < plan.largest() / 2);
        }
    }
}

TEST_CASE("chunks are as large as the memory allows where none is asked for") {
    const std::int64_t size = 300'000, unlimited = the_gpu.memory;
    auto o = two_phases(0);
    o.phases = 20;
    auto here = filled<drifts>(size), there = filled<drifts>(size), refused_one = filled<drifts>(size);
    for (auto* const e : {&here, &there}) e->accessory(drift::limit) = -1;  // ends all soon
    the_gpu.memory = 30'000'000;                                            // of 119 MB
    myriad::solve<runge_kutta_4>(gpu, here, o);
    myriad::solve<runge_kutta_4>(cpu, there, o);
    CHECK(same_results(here, there));
    o.chunk_size = size / 2;
    refused([&] { myriad::solve<runge_kutta_4>(gpu, refused_one, o); }, {"out of device memory"});
    the_gpu.memory = unlimited;
}

TEST_CASE(
    "many chunks are begun while the last are checked: all wait for the check, and are fewer where memory is short") {
    constexpr std::int64_t size = 1'500'003;
    const auto filled_and_pinned = [] {
        auto e = filled<drifts>(size);
        e.t_begin() = 0;
        e.t_end() = 1;
        e.pin(gpu);  // so that no thread waits for uploads
        return e;
    };
    myriad::options o;
    o.step = 1;
    auto expected = filled_and_pinned();
    myriad::solve<runge_kutta_4>(cpu, expected, o);
    the_gpu.seems_idle = true;
    the_gpu.longest_delay = 5000;
    for (const bool bad : {true, false}) {
        bool begun = false;  // more than three were begun before the check was over: nearly always, depending on the
                             // threads
        for (int attempt = 0; attempt < 100 && !begun; ++attempt) {
            auto e = filled_and_pinned();
            if (bad) e.state(drift::x)(size - 1) = std::numeric_limits<double>::infinity();
            the_gpu.fail(call::reserve, bad ? 100 : 3);
            const std::string said = error_of([&] { myriad::solve<runge_kutta_4>(gpu, e, o); });
            begun = bad ? the_gpu.calls_before < 97 : the_gpu.has_failed();
            the_gpu.fail(call::none, 0);
            CHECK(the_gpu.under_way == 0);
            CHECK((said.find("state 0 (x) is not finite in 1 of 1500003") != std::string::npos) == bad);
            if (bad) e.state(drift::x)(size - 1) = 1;
            CHECK((bad ? is_as_filled(e) && myriad::host::ensemble_access::data(e).untouched
                       : same_results(e, expected)));
        }
        CHECK(begun);
    }
    the_gpu.seems_idle = false;
    the_gpu.longest_delay = 0;
}

TEST_CASE("progress that throws at any chunk ends the work with those under way, each whole") {
    constexpr std::int64_t size = 140'003, chunk = 20'000;
    auto o = two_phases(chunk);
    for (std::int64_t enough = 1; enough <= 8; ++enough) {
        CAPTURE(enough);
        the_gpu.seed = static_cast<std::uint64_t>(enough);
        the_gpu.longest_delay = 1000;
        o.progress = [&](std::int64_t done, std::int64_t) {
            if (done >= std::min(enough * chunk, size)) throw std::runtime_error("enough");
        };
        auto e = filled<drifts>(size);
        CHECK_THROWS_WITH(myriad::solve<runge_kutta_4>(gpu, e, o), "enough");
        the_gpu.longest_delay = 0;
        CHECK(the_gpu.under_way == 0);
        const std::int64_t done = (e.phases_done() > 0).count();
        CHECK(done >= std::min(enough * chunk, size));
        CHECK(done <= (enough + 2) * chunk);
        CHECK((done % chunk == 0 || done == size));
        CHECK((e.phases_done().head(done) > 0).all());
    }
}

TEST_CASE("ensembles solved at the same time by several threads have the bits of one after the other") {
    constexpr std::int64_t size = 140'003;
    auto expected = filled<drifts>(size);
    myriad::solve<runge_kutta_4>(cpu, expected, two_phases(0));
    the_gpu.longest_delay = 500;
    std::vector<drifts> all;
    for (int i = 0; i < 3; ++i) all.push_back(filled<drifts>(size));
    std::vector<std::thread> threads;
    for (auto& e : all) threads.emplace_back([&e] { myriad::solve<runge_kutta_4>(gpu, e, two_phases(30'000)); });
    for (auto& t : threads) t.join();
    the_gpu.longest_delay = 0;
    for (const auto& e : all) CHECK(same_results(e, expected));
}

TEST_CASE("an error of one solver is thrown by the call that meets it, and another goes on") {
    for (const call kind :
         {call::make_engine, call::reserve, call::upload, call::integrate, call::kernel, call::download, call::wait}) {
        CAPTURE(static_cast<int>(kind));
        myriad::solver<swing, cash_karp> other(gpu, 50, usual());
        fill(other.instances());
        other.upload();
        std::string last_begun = "nothing";
        the_gpu.fail(kind, kind == call::wait ? 2 : 0);  // the calls in instances() and upload() come first
        const std::string said = error_of([&] {
            myriad::solver<swing, cash_karp> s(gpu, 50, usual());
            fill(s.instances());
            last_begun = "upload";
            s.upload();
            last_begun = "integrate";
            s.integrate();
            last_begun = "download";
            s.download();
            last_begun = "results";
            s.results();
        });
        CHECK(said == "the simulated GPU failed");
        CHECK(the_gpu.has_failed());
        const std::array met{"none", "nothing", "nothing", "upload", "integrate", "results", "download", "results"};
        CHECK(last_begun == met[static_cast<std::size_t>(kind)]);
        other.integrate();
        other.download();
        CHECK(other.report().count(status::success) == 50);
        CHECK(the_gpu.under_way == 0);
    }
}

#if defined(__has_feature)  // clang++'s thread sanitizer ends a forked process that starts threads
#if __has_feature(thread_sanitizer) || __has_feature(address_sanitizer)
#define SANITIZED
#endif
#endif
#if !defined(SANITIZED) && !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
TEST_CASE("a child process of one that has used a GPU is refused it, and may use the CPU") {
    auto e = filled<drifts>(1000);
    myriad::solve<runge_kutta_4>(gpu, e, two_phases(0));
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        alarm(60);
        auto mine = filled<drifts>(1000);
        const auto said = error_of([&] { myriad::solve<runge_kutta_4>(gpu, mine, two_phases(0)); });
        const auto said_by_solver = error_of([] { myriad::solver<swing, cash_karp>(gpu, 10, usual()); });
        const auto forked = [](const std::string& text) {
            return text.find("forked from one that has used a GPU") != text.npos;
        };
        const bool solved = myriad::solve<runge_kutta_4>(myriad::device::cpu(2), mine, two_phases(0)).failed() == 0;
        _exit(!forked(said) ? 1 : !forked(said_by_solver) ? 2 : !solved ? 3 : 0);
    }
    int ended = 0;
    REQUIRE(waitpid(child, &ended, 0) == child);
    CHECK(WIFEXITED(ended));
    CHECK(WEXITSTATUS(ended) == 0);
}
#endif

TEST_CASE("pinning that fails in the middle names the ensemble as a whole, which goes on without") {
    auto e = filled<drifts>(1'000'000);
    the_gpu.fail(call::pin, 2);
    const std::string said = error_of([&] { e.pin(gpu); });
    CHECK(said == "an ensemble that takes 42 MB or more was not pinned: the simulated GPU failed");
    CHECK_FALSE(e.pinned());
    CHECK(myriad::solve<runge_kutta_4>(gpu, e, two_phases(0)).failed() == 0);
    e.pin(gpu);  // pinned memory is not pinned again
    CHECK(e.pinned());
}

TEST_CASE("a solver's values are on the device, where they are set without an upload and used without a download") {
    const auto where = GENERATE(gpu, cpu);
    myriad::solver<swing, cash_karp> s(where, 70, usual()), set_there(where, 70, usual());
    refused([&] { s.on_device(); }, {"on_device has no instances", "call upload first"});
    myriad::ensemble<swing> other(50);
    fill(s.instances());
    fill(set_there.instances());
    fill(other, 100);
    s.instances().state(swing::x).head(50) = other.state(swing::x);
    s.instances().parameter(swing::drive).head(50) = other.parameter(swing::drive);
    for (auto* const each : {&s, &set_there}) each->upload(50);
    const auto there = set_there.on_device();
    CHECK(there.size() == 50);
    CHECK((there.stream() == nullptr) == (where.which() == myriad::device::kind::cpu));
    set_there.wait();
    for (std::int64_t i = 0; i < 50; ++i) {  // a simulated GPU's memory is the host's
        there.state(swing::x)[i] = other.state(swing::x)(i);
        there.parameter(swing::drive)[i] = other.parameter(swing::drive)(i);
    }
    for (auto* const each : {&s, &set_there}) each->integrate();
    set_there.wait();
    s.download();
    const auto& expected = s.results();
    std::int64_t same = 0;
    for (std::int64_t i = 0; i < 50; ++i)
        same += there.state(swing::v)[i] == expected.state(swing::v)(i) && there.t()[i] == expected.t()(i) &&
                there.accessory(swing::highest)[i] == expected.accessory(swing::highest)(i) &&
                there.integer_accessory(swing::impacts)[i] == expected.integer_accessory(swing::impacts)(i) &&
                there.statuses()[i] == expected.status(i);
    CHECK(same == 50);
    CHECK(expected.integer_accessory(swing::impacts).head(50).maxCoeff() > 0);
    refused([&] { there.state(2); }, {"state", "2"});
    set_there.download();
    CHECK(set_there.report().count(status::success) == 50);
}

TEST_CASE("a solver's bad instances are marked before they are copied") {
    auto o = usual();
    o.invalid_instances = myriad::invalid_instances::mark;
    myriad::solver<swing, cash_karp> s(gpu, 50, o);
    fill(s.instances());
    s.instances().state(swing::x)(7) = std::numeric_limits<double>::infinity();
    s.upload();
    s.integrate();
    s.download();
    CHECK(s.report().count(status::success) == 49);
    CHECK(s.results().status(7) == status::invalid_input);
}
