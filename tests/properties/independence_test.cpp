// SPDX-License-Identifier: MIT
// The result of an instance depends only on the instance: not on the pack size, the lane, the neighbours, the order and
// size of the ensemble, the threads, or the division of its phases into calls. All comparisons are of bits.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/properties/models.hpp"
#include "tests/properties/pack_sizes.hpp"
#include "tests/support/device.hpp"
#include "tests/support/prepared.hpp"

namespace {

using namespace properties;
using myriad::ensemble;
using myriad::options;

template <class Model, class R>
void fill(ensemble<Model, R>& e, const std::vector<std::int64_t>& instances);

template <class R>
R spread(std::int64_t i) {  // a scattered value in [0, 1) for every instance number
    return static_cast<R>((i * 7919) % 10007) / R(10007);
}

template <class R>
void fill_one(ensemble<bouncer, R>& e, std::int64_t at, std::int64_t i) {
    e.parameter(bouncer::k)(at) = R(1) + R(3) * spread<R>(i);
    e.parameter(bouncer::x0)(at) = R(0.2) + spread<R>(i + 1);
    e.state(bouncer::x)(at) = R(1) + spread<R>(i + 2);
    e.state(bouncer::v)(at) = spread<R>(i + 3) - R(0.5);
    e.accessory(bouncer::path)(at) = R(0);
    e.t_begin()(at) = R(0);
    e.t_end()(at) = R(2) + R(4) * spread<R>(i + 4);
}
template <class R>
void fill_one(ensemble<mixed, R>& e, std::int64_t at, std::int64_t i) {
    e.parameter(mixed::f)(at) = R(0.5) + spread<R>(i);
    e.state(mixed::q)(at) = R(0.9) * spread<R>(i + 2);
    e.state(mixed::w)(at) = spread<R>(i + 3) - R(0.5);
    e.t_begin()(at) = R(0);
    e.t_end()(at) = R(3) + R(9) * spread<R>(i + 4);
}
template <class R>
void fill_one(ensemble<lorenz, R>& e, std::int64_t at, std::int64_t i) {
    e.parameter(lorenz::rho)(at) = R(21) * spread<R>(i);
    e.state(lorenz::x)(at) = R(10);
    e.state(lorenz::y)(at) = R(10) * spread<R>(i + 1);
    e.state(lorenz::z)(at) = R(10);
    e.t_begin()(at) = R(0);
    e.t_end()(at) = R(0.1) + spread<R>(i + 4);
}

template <class Model, class R>
ensemble<Model, R> make(const std::vector<std::int64_t>& instances) {
    ensemble<Model, R> e(static_cast<std::int64_t>(instances.size()));
    if constexpr (myriad::detail::n_shared<Model> != 0) e.shared(0) = R(0.05);
    for (std::size_t at = 0; at < instances.size(); ++at) fill_one(e, static_cast<std::int64_t>(at), instances[at]);
    return e;
}

std::vector<std::int64_t> numbers(std::int64_t from, std::int64_t to) {
    std::vector<std::int64_t> v;
    for (std::int64_t i = from; i < to; ++i) v.push_back(i);
    return v;
}

options settings(std::int64_t phases) {
    options o;
    o.phases = phases;
    o.step = 0.01;
    o.relative_tolerance = 1e-6;
    o.absolute_tolerance = 1e-6;
    return o;
}

/// All bits of one instance's result.
template <class Model, class R>
std::vector<unsigned char> bits_of(const ensemble<Model, R>& e, std::int64_t i) {
    std::vector<unsigned char> bits;
    const auto add = [&bits](const auto& value) {
        const auto* p = reinterpret_cast<const unsigned char*>(&value);
        bits.insert(bits.end(), p, p + sizeof value);
    };
    for (int c = 0; c < myriad::detail::n_state<Model>; ++c) add(e.state(c).data()[i]);
    for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c) add(e.accessory(c).data()[i]);
    for (int c = 0; c < myriad::detail::n_integer_accessory<Model>; ++c) add(e.integer_accessory(c).data()[i]);
    add(e.t().data()[i]);
    add(e.statuses()[i]);
    add(e.phases_done().data()[i]);
    add(e.accepted_steps().data()[i]);
    add(e.rejected_steps().data()[i]);
    add(e.located_steps().data()[i]);
    add(e.rhs_evaluations().data()[i]);
    return bits;
}

template <class Model, class Method, class R>
void run(int batches, ensemble<Model, R>& e, const options& o, int threads = 2) {
    myriad::detail::run_options how;
    how.threads = threads;
    run_with_packs<Model, Method, R>(batches, tests::prepare<Method>(e, o).arguments(), how);
}

template <class Model, class Method, class R>
void check_pack_sizes(int first_batches) {
    const auto instances = numbers(0, 203);  // no multiple of any number of lanes
    auto expected = make<Model, R>(instances);
    run<Model, Method, R>(first_batches, expected, settings(3));
    for (int batches = first_batches + 1; batches <= (compiles_large_packs<Model> ? 4 : 2); ++batches) {
        auto e = make<Model, R>(instances);
        run<Model, Method, R>(batches, e, settings(3));
        std::int64_t different = 0;
        for (std::int64_t i = 0; i < e.size(); ++i) different += bits_of(e, i) != bits_of(expected, i);
        INFO("pack of " << batches << " batches");
        CHECK(different == 0);
    }
}

}  // namespace

// From 0 if the model has only + - * / and sqrt; a scalar lane takes elementary functions from the C library.
TEST_CASE("an impact model gives the same bits in a scalar lane and in packs of every size") {
    check_pack_sizes<bouncer, myriad::cash_karp, double>(0);
}
TEST_CASE("fixed steps give the same bits in a scalar lane and in packs of every size") {
    check_pack_sizes<lorenz, myriad::runge_kutta_4, double>(0);
}
TEST_CASE("single precision gives the same bits in a scalar lane and in packs of every size") {
    check_pack_sizes<lorenz, myriad::cash_karp, float>(0);
}
TEST_CASE("a model with elementary functions gives the same bits in packs of every size") {
    check_pack_sizes<mixed, myriad::tsitouras_5, double>(1);
}

TEST_CASE("an instance whose steps end at events has the same bits beside any others") {
    // cash_karp recomputes the first slope of every step, which a single lane may round differently from a pack.
    const auto together = numbers(0, 203);
    auto all = make<mixed, double>(together);
    myriad::solve<myriad::cash_karp>(tests::test_device(1), all, settings(3));
    for (const std::int64_t i : {0, 1, 7, 100, 202}) {
        auto alone = make<mixed, double>({i});
        myriad::solve<myriad::cash_karp>(tests::test_device(1), alone, settings(3));
        CAPTURE(i);
        CHECK(bits_of(alone, 0) == bits_of(all, i));
        CHECK(alone.located_steps()[0] > 0);
    }
}
TEST_CASE("the order of the ensemble changes no bit of any result") {
    auto order = numbers(0, 203);
    auto straight = make<mixed, double>(order);
    myriad::solve<myriad::tsitouras_5>(tests::test_device(2), straight, settings(3));
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    auto shuffled = make<mixed, double>(order);
    myriad::solve<myriad::tsitouras_5>(tests::test_device(2), shuffled, settings(3));
    for (std::size_t at = 0; at < order.size(); ++at)
        REQUIRE(bits_of(shuffled, static_cast<std::int64_t>(at)) == bits_of(straight, order[at]));
}

TEST_CASE("the size of the ensemble changes no bit of any result") {
    auto all = make<bouncer, double>(numbers(0, 203));
    myriad::solve<myriad::cash_karp>(tests::test_device(2), all, settings(3));
    for (const std::int64_t size : {1, 7, 64}) {
        auto some = make<bouncer, double>(numbers(100, 100 + size));
        myriad::solve<myriad::cash_karp>(tests::test_device(2), some, settings(3));
        for (std::int64_t i = 0; i < size; ++i) REQUIRE(bits_of(some, i) == bits_of(all, 100 + i));
    }
}

TEST_CASE("the number of threads changes no bit of any result") {
    auto one = make<mixed, double>(numbers(0, 203));
    myriad::solve<myriad::tsitouras_5>(myriad::device::cpu(1), one, settings(3));
    for (const int threads : {2, 7}) {
        auto e = make<mixed, double>(numbers(0, 203));
        const auto report = myriad::solve<myriad::tsitouras_5>(myriad::device::cpu(threads), e, settings(3));
        CHECK(report.threads == threads);
        for (std::int64_t i = 0; i < e.size(); ++i) REQUIRE(bits_of(e, i) == bits_of(one, i));
    }
}

TEST_CASE("splitting phases into calls changes no bit of any result") {
    for (const auto time : {myriad::phase_time::restart, myriad::phase_time::carry_on}) {
        for (const auto step : {myriad::phase_step::restart, myriad::phase_step::carry_on}) {
            options o = settings(6);
            o.phase_time = time;
            o.phase_step = step;
            // A section ends each phase, so that part of a carried-on domain remains.
            o.events = {{myriad::direction::falling, 1e-8, 2}, {}};
            auto whole = make<bouncer, double>(numbers(0, 100));
            myriad::solve<myriad::cash_karp>(tests::test_device(2), whole, o);
            for (const std::vector<std::int64_t>& split :
                 {std::vector<std::int64_t>{1, 1, 1, 1, 1, 1}, {2, 4}, {5, 1}}) {
                auto e = make<bouncer, double>(numbers(0, 100));
                for (const std::int64_t phases : split) {
                    o.phases = phases;
                    myriad::solve<myriad::cash_karp>(tests::test_device(2), e, o);
                }
                for (std::int64_t i = 0; i < e.size(); ++i) REQUIRE(bits_of(e, i) == bits_of(whole, i));
            }
        }
    }
}

TEST_CASE("neighbours that are not finite or huge change no bit of any result") {
    auto clean = make<mixed, double>(numbers(0, 96));
    myriad::solve<myriad::tsitouras_5>(tests::test_device(1), clean, settings(3));
    auto mixed_in = make<mixed, double>(numbers(0, 96));
    constexpr double inf = std::numeric_limits<double>::infinity();
    const double bad[] = {std::nan(""), inf, -inf, 1e300, -1e300, 1e7, 5e-324};
    for (std::int64_t i = 1; i < 96; i += 3) mixed_in.state(i % 2)(i) = bad[i % 7];
    options o = settings(3);
    o.max_steps = 2000;
    o.invalid_instances = myriad::invalid_instances::mark;
    options unmarked = o;
    myriad::solve<myriad::tsitouras_5>(tests::test_device(1), mixed_in, o);
    for (std::int64_t i = 0; i < 96; ++i) {
        if (i % 3 != 1) REQUIRE(bits_of(mixed_in, i) == bits_of(clean, i));
        for (int c = 0; c < 2; ++c) {
            // non-finite inputs stay as they were; nothing else may become non-finite
            if (mixed_in.status(i) != myriad::status::invalid_input) REQUIRE(std::isfinite(mixed_in.state(c)(i)));
        }
    }
    CHECK(mixed_in.status(1) == myriad::status::invalid_input);
}

TEST_CASE("fixed steps take a neighbour that overflows without a change of any bit") {
    auto clean = make<lorenz, double>(numbers(0, 96));
    myriad::solve<myriad::runge_kutta_4>(tests::test_device(1), clean, settings(1));
    auto e = make<lorenz, double>(numbers(0, 96));
    for (std::int64_t i = 1; i < 96; i += 3) e.state(lorenz::x)(i) = 1e200;
    const auto report = myriad::solve<myriad::runge_kutta_4>(tests::test_device(1), e, settings(1));
    CHECK(report.count(myriad::status::not_finite) == 32);
    for (std::int64_t i = 0; i < 96; ++i) {
        if (i % 3 != 1) {
            REQUIRE(bits_of(e, i) == bits_of(clean, i));
        } else {
            REQUIRE(e.state(lorenz::x)(i) == 1e200);  // its last finite state
            REQUIRE(e.t()(i) == 0);
        }
    }
}
