// SPDX-License-Identifier: MIT
// The backend under test against itself (block sizes, chunks and order change no bit) and against the CPU backend, and
// its messages when a GPU cannot meet a request.
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/host/solve/fill.hpp"
#include "tests/support/prepared.hpp"

using namespace solving;
using myriad::cash_karp;
using tests::test_device;
using tests::tests_cpu;

namespace {

myriad::ensemble<swing> solved(std::int64_t size, const myriad::options& o) {
    myriad::ensemble<swing> e(size);
    fill(e);
    myriad::solve<cash_karp>(test_device(), e, o);
    return e;
}

myriad::ensemble<heat> rods(std::int64_t size) {
    myriad::ensemble<heat> e(size);
    for (int i = 0; i < heat::points; ++i) {
        for (std::int64_t k = 0; k < size; ++k) e.state(i)(k) = std::sin(0.1 * i + 0.01 * static_cast<double>(k));
        for (int j = 0; j < heat::points; ++j)
            e.shared(i * heat::points + j) = i == j ? -2.0 : std::abs(i - j) == 1 ? 1.0 : 0.0;
    }
    e.parameter(heat::rate) = Eigen::ArrayXd::LinSpaced(size, 0.5, 1.5);
    e.time_domain(0, 1);
    return e;
}

}  // namespace

TEST_CASE("chunks change no bit, and hooks see the instance's number in the ensemble", "[small]") {
    const auto whole = solved(500, usual());
    for (const std::int64_t chunk : {1, 32, 77, 499, 500, 600}) {
        if (chunk == 1 && !tests_cpu()) continue;
        myriad::options o = usual();
        o.chunk_size = chunk;
        const auto parts = solved(500, o);
        INFO(chunk << " instances at a time");
        CHECK(same_results(parts, whole));
        CHECK((parts.accessory(swing::my_number) == Eigen::ArrayXd::LinSpaced(500, 0, 499)).all());
    }
}

TEST_CASE("block sizes change no bit") {
    const auto whole = solved(700, usual());
    for (const std::int64_t block : {32, 64, 96, 128}) {
        myriad::options o = usual();
        o.block_size = block;
        INFO("block size " << block);
        CHECK(same_results(solved(700, o), whole));
    }
}

TEST_CASE("turning the ensemble's order around changes no bit") {
    const std::int64_t size = 300;
    const auto forward = solved(size, usual());
    myriad::ensemble<swing> backward(size);
    fill(backward);
    for (std::int64_t i = 0; i < size; ++i) set_swing(backward, i, size - 1 - i);
    myriad::solve<cash_karp>(test_device(), backward, usual());
    std::int64_t different = 0;
    for (std::int64_t i = 0; i < size; ++i)
        different += backward.state(swing::x)(i) != forward.state(swing::x)(size - 1 - i) ||
                     backward.accepted_steps()(i) != forward.accepted_steps()(size - 1 - i);
    CHECK(different == 0);
}

// Rounding grows over the 200 steps of an instance, and an impact is located only to 1e-8, so that the backends may
// stop at different points of that interval: the difference is multiplied by the speed over the slope, a few units, and
// damped afterwards.
TEST_CASE("both backends agree to what the event tolerance implies") {
    const auto here = solved(1000, usual());
    myriad::ensemble<swing> there(1000);
    fill(there);
    myriad::solve<cash_karp>(myriad::device::cpu(), there, usual());
    std::int64_t other_impacts = 0, compared = 0;
    double largest = 0;
    for (std::int64_t i = 0; i < 1000; ++i) {
        const bool same = here.integer_accessory(swing::impacts)(i) == there.integer_accessory(swing::impacts)(i);
        other_impacts += !same;
        if (!same) continue;  // it grazed the wall
        ++compared;
        largest = std::max(largest, std::abs(here.state(swing::x)(i) - there.state(swing::x)(i)));
    }
    INFO("largest difference " << largest << ", instances that grazed " << other_impacts);
    CHECK(other_impacts <= 5);
    CHECK(compared >= 995);
    CHECK(largest < 1e-5);
    const double steps =
        static_cast<double>(here.accepted_steps().sum()) / static_cast<double>(there.accepted_steps().sum());
    CHECK(steps == Approx(1).epsilon(0.02));
}

TEST_CASE("steps that a GPU keeps in shared memory find the events and samples of the CPU, in blocks of any size") {
    const auto chains = [](const myriad::device& where, std::int64_t block) {
        myriad::ensemble<long_chain> e(200);
        for (int c = 0; c < long_chain::n_state; ++c) e.state(c) = c == long_chain::first ? 1 : 0;
        e.parameter(long_chain::rate) = Eigen::ArrayXd::LinSpaced(200, 0.5, 2);
        e.time_domain(0, 40);
        myriad::options o;
        o.samples.times = {1, 10, 40};
        o.samples.capacity = 3;
        o.samples.states = {long_chain::first, long_chain::last};
        o.block_size = block;
        REQUIRE(myriad::solve<myriad::dense<myriad::dormand_prince_5>>(where, e, o).failed() == 0);
        return e;
    };
    const auto here = chains(test_device(), 0), there = chains(myriad::device::cpu(), 0);
    const auto other = chains(test_device(), 32);
    double apart = 0;
    std::int64_t other_counts = 0, other_bits = 0;
    for (std::int64_t i = 0; i < 200; ++i) {
        other_counts +=
            here.integer_accessory(long_chain::crossings)(i) != there.integer_accessory(long_chain::crossings)(i);
        for (int c = 0; c < long_chain::n_state; ++c) {
            apart = std::max(apart, std::abs(here.state(c)(i) - there.state(c)(i)));
            other_bits += here.state(c)(i) != other.state(c)(i);
        }
        for (const int c : {long_chain::first, long_chain::last})
            apart = std::max(apart, (here.samples().state(c) - there.samples().state(c)).row(i).abs().maxCoeff());
    }
    CHECK(there.integer_accessory(long_chain::crossings).minCoeff() >= 1);
    CHECK(other_counts == 0);
    CHECK(apart < 1e-8);
    CHECK(other_bits == 0);
}

TEST_CASE("both backends agree in single precision") {
    myriad::ensemble<swing, float> here(300), there(300);
    fill(here);
    fill(there);
    const auto report = myriad::solve<cash_karp>(test_device(), here, usual_float());
    myriad::solve<cash_karp>(myriad::device::cpu(), there, usual_float());
    CHECK(report.failed() == 0);
    std::int64_t apart = 0;
    for (std::int64_t i = 0; i < 300; ++i)
        apart += !(std::abs(here.state(swing::x)(i) - there.state(swing::x)(i)) < 5e-2f);
    INFO("instances apart: " << apart);
    CHECK(apart <= 6);  // those that graze the wall
}

TEST_CASE("a matrix of 77 x 77 shared parameters gives the same wherever it is kept") {
    auto here = rods(40), there = rods(40);
    myriad::options o;
    o.step = 0.01;
    const auto report = myriad::solve<myriad::runge_kutta_4>(test_device(), here, o);
    myriad::solve<myriad::runge_kutta_4>(myriad::device::cpu(), there, o);
    double largest = 0;
    for (int i = 0; i < heat::points; ++i)
        largest = std::max(largest, (here.state(i) - there.state(i)).abs().maxCoeff());
    // 100 steps of sums of 77 terms of at most 2; none of the errors grows
    CHECK(largest < 100 * 77 * 2 * std::numeric_limits<double>::epsilon());
    if (tests_cpu()) return;
    CHECK(report.kernel.shared_placement == myriad::shared_placement::shared_memory);
    CHECK(report.kernel.shared_bytes == 77 * 77 * 8);
    auto cached = rods(40);
    o.shared_placement = myriad::shared_placement::cache;
    CHECK(myriad::solve<myriad::runge_kutta_4>(test_device(), cached, o).kernel.shared_placement ==
          myriad::shared_placement::cache);
    for (int i = 0; i < heat::points; ++i) CHECK(same_bits(cached.state(i), here.state(i)));
    o.shared_placement = myriad::shared_placement::constant_bank;
    refused([&] { myriad::solve<myriad::runge_kutta_4>(test_device(), cached, o); },
            {"constant_bank", "47432 bytes", "1024"});
}

TEST_CASE("a GPU that lacks memory or room for a block says so, and the next solver works", "[small]") {
    if (tests_cpu()) return;
    myriad::options o = usual();
    o.block_size = 1024;
    refused([&] { solved(10, o); }, {"block_size is 1024", "registers", "smaller block_size"});

    auto engine = myriad::cuda::make_engine<swing, cash_karp, double>({test_device().number(), 0, {}});
    myriad::ensemble<swing> e(10);
    fill(e);
    auto prepared = tests::prepare<cash_karp>(e, usual());
    refused([&] { engine->reserve(prepared.arguments(), std::int64_t{1} << 40); },
            {"out of device memory", "GB are wanted", "are free", "chunk_size"});
    engine->upload(prepared.arguments(), 0, 10);
    engine->integrate(prepared.arguments());
    engine->download(prepared.arguments());
    engine->wait();
    CHECK(same_results(e, solved(10, usual())));
}

TEST_CASE("every GPU of the machine gives the same bits") {
    const auto here = solved(200, usual());
    if (tests_cpu()) return;
    for (const auto& where : myriad::devices()) {
        if (where.which() == myriad::device::kind::cpu) continue;
        myriad::ensemble<swing> there(200);
        fill(there);
        CHECK(myriad::solve<cash_karp>(where, there, usual()).device == where.name());
        CHECK(same_results(there, here));
    }
}
