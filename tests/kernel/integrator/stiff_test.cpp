// SPDX-License-Identifier: MIT
// Stiff methods in the loop: statuses, counts, events, hooks and dense output, large systems, and results that depend
// only on the instance.
#include "tests/support/stiff.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/properties/pack_sizes.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"
#include "tests/support/faulty.hpp"
#include "tests/support/prepared.hpp"
#include "tests/support/sparse.hpp"

namespace {

using myriad::ensemble;
using myriad::options;
using myriad::rodas_5p;
using myriad::rosenbrock_23;
using myriad::solve;
using myriad::status;
using stiff::growth;
using stiff::relay;
using stiff::van_der_pol;

constexpr double pi = 3.14159265358979323846;

/// The rate at which I / (h gamma) - J of `growth` has a zero pivot, as the method itself computes it: 1 / h times the
/// rounded 1 / gamma.
template <class Method, class R>
R singular_rate(R h) {
    return R(1) / h * static_cast<R>(1 / Method::tableau().gamma);
}

template <class Method, class R = double, class Model = growth>
void check_singular() {
    const R h = R(0.125);
    options o;
    o.step = static_cast<double>(h);
    o.relative_tolerance = o.absolute_tolerance = 1e-2;
    for (const bool may_shorten : {false, true}) {
        ensemble<Model, R> e(40);
        for (int c = 0; c < Model::n_state; ++c) e.state(c) = R(1);
        e.state(Model::x) = R(1e-3);
        for (std::int64_t i = 0; i < e.size(); ++i)
            e.parameter(Model::rate)[i] = i % 3 == 1 ? singular_rate<Method, R>(h) : R(-1);
        e.time_domain(R(0), R(1));
        o.minimum_step = may_shorten ? 0 : static_cast<double>(h);
        solve<Method>(tests::test_device(1), e, o);
        for (std::int64_t i = 0; i < e.size(); ++i) {
            CAPTURE(i, may_shorten);
            if (i % 3 != 1 || may_shorten) {
                CHECK(e.status(i) == status::success);
                // a step shorter by any factor has a regular matrix
                if (i % 3 == 1) CHECK(e.rejected_steps()[i] >= 1);
            } else {
                CHECK(e.status(i) == status::singular_jacobian);
                CHECK(e.t()[i] == 0);
                CHECK(e.state(Model::x)[i] == R(1e-3));
                CHECK(e.rejected_steps()[i] == 1);
            }
        }
    }
}

/// The relay with samples: its event times, its states between them, and that every hook was called.
template <class Method>
void check_relay(double tolerance, double slack) {
    ensemble<relay> e(5);
    e.state(relay::y0) = 0.0;  // which `initialise` replaces
    for (int c = 0; c < relay::n_accessory; ++c) e.accessory(c) = 0.0;
    e.time_domain(0, 4);
    options o;
    o.relative_tolerance = o.absolute_tolerance = tolerance;
    o.step = 1e-3;
    o.maximum_step = 0.2;  // the error of the interpolant is not controlled: 4e-4 h^4 here for rodas_5p (measured)
    o.events = {{myriad::direction::falling, 1e-9, 0}};
    o.samples = {.states = {relay::y0}, .capacity = 81, .evenly = 81};
    solve<myriad::dense<Method>>(tests::test_device(1), e, o);
    for (std::int64_t i = 0; i < e.size(); ++i) {
        REQUIRE(e.status(i) == status::success);
        CHECK(e.accessory(relay::raised)[i] == 2);
        // the slope at both events is -sin(pi/3)
        CHECK(std::abs(e.accessory(relay::last_event)[i] - 2 * pi / 3) <=
              (slack * tolerance + 1e-9) / std::sin(pi / 3));
        CHECK(std::abs(e.state(relay::y0)[i] - (std::cos(4.0) + 2)) <= slack * tolerance);
        // the largest state is the one at an event or at the start, before the action: hooks see steps, which end below
        // it
        CHECK(e.accessory(relay::largest)[i] >= 1);
        CHECK(e.accessory(relay::largest)[i] <= 1.5 + slack * tolerance);
        CHECK(e.integer_accessory(relay::begun)[i] == 1);
        CHECK(e.integer_accessory(relay::finished)[i] == 1);
        const auto t = e.samples().time();
        const auto y = e.samples().state(relay::y0);
        for (Eigen::Index k = 0; k < 81; ++k) {
            const double time = t(i, k), raised = (time > pi / 3) + (time > 2 * pi / 3);
            CAPTURE(time);
            CHECK(std::abs(y(i, k) - std::cos(time) - raised) <= slack * tolerance);
        }
    }
}

/// The slowest mode of the rod, exp(-lambda t) sin(j pi / (n + 1)) with lambda = 4 rate sin^2(pi / (2 (n + 1))), plus
/// the fastest one, which decays at once.
template <class Method, int n, class R = double>
void check_rod(double tolerance) {
    ensemble<stiff::rod<n>, R> e(19);
    const double rate = 100, end = 0.5;
    const double lambda = 4 * rate * std::pow(std::sin(pi / (2 * (n + 1))), 2);
    e.parameter(0) = static_cast<R>(rate);
    for (int j = 0; j < n; ++j) {
        const double slow = std::sin((j + 1) * pi / (n + 1)), fast = std::sin((j + 1) * n * pi / (n + 1));
        e.state(j) = static_cast<R>(slow + 0.1 * fast);
    }
    e.time_domain(R(0), static_cast<R>(end));
    options o;
    o.relative_tolerance = o.absolute_tolerance = tolerance;
    o.step = 1e-3;
    const auto report = solve<Method>(tests::test_device(1), e, o);
    REQUIRE(report.count(status::success) == e.size());
    const double steps = static_cast<double>(e.accepted_steps()[7]);
    for (int j = 0; j < n; ++j) {
        const double exact = std::exp(-lambda * end) * std::sin((j + 1) * pi / (n + 1));
        CAPTURE(n, j, steps);
        // The rod's matrix exponential shrinks errors in every norm, but the largest component may collect those of all
        // others: its rows sum to at most one. A step's error is below the tolerance, states are at most 1.1.
        CHECK(std::abs(static_cast<double>(e.state(j)[7]) - exact) <= 1.1 * steps * tolerance);
    }
}

ensemble<van_der_pol> oscillators(const std::vector<std::int64_t>& numbers) {
    ensemble<van_der_pol> e(static_cast<std::int64_t>(numbers.size()));
    for (std::size_t at = 0; at < numbers.size(); ++at) {
        const auto i = static_cast<std::int64_t>(at);
        e.parameter(van_der_pol::eps)[i] = std::pow(10.0, -3.0 * static_cast<double>(numbers[at] % 17) / 16);
        e.state(van_der_pol::x)[i] = 2;
        e.state(van_der_pol::v)[i] = 0.01 * static_cast<double>(numbers[at] % 5);
        e.accessory(van_der_pol::fastest)[i] = 0;
    }
    e.time_domain(0, 2);
    return e;
}

/// Balls with 99 restitutions, whose impacts accumulate. At the end, the remaining flights take 2 v / (g (1 - e)).
template <class Method, class R = double>
void check_accumulation(R event_tolerance, double resolution) {
    ensemble<stiff::ball, R> e(99);
    e.state(stiff::ball::x) = R(1);
    e.state(stiff::ball::v) = R(0);
    for (std::int64_t i = 0; i < e.size(); ++i) e.parameter(0)[i] = static_cast<R>(0.01 * static_cast<double>(i + 1));
    e.time_domain(R(0), R(100));
    options o = compare::with_tolerance(std::is_same_v<R, float> ? 1e-6 : 1e-10, 1e-2);
    o.events = {{.direction = myriad::direction::falling, .tolerance = static_cast<double>(event_tolerance)}};
    const auto report = solve<Method>(tests::test_device(1), e, o);
    CHECK(report.count(status::event_accumulation) == e.size());
    for (std::int64_t i = 0; i < e.size(); ++i) {
        const double kept = static_cast<double>(e.parameter(0)[i]);
        const double rest = std::sqrt(0.2) * (1 + kept) / (1 - kept);
        const double left = 2 * static_cast<double>(e.state(stiff::ball::v)[i]) / (10 * (1 - kept));
        CAPTURE(kept);
        CHECK(std::abs(static_cast<double>(e.t()[i]) + left - rest) <= resolution);
    }
}

/// Packs of every size against one lane at a time.
template <class Method>
void check_pack_sizes() {
    std::vector<std::int64_t> all(103);  // no multiple of any number of lanes
    std::iota(all.begin(), all.end(), 0);
    const auto run = [&](int batches) {
        auto e = oscillators(all);
        const options o = compare::with_tolerance(1e-4, 1e-3);
        properties::run_with_packs<van_der_pol, Method, double>(batches, tests::prepare<Method>(e, o).arguments(), {});
        return e;
    };
    const auto one_lane = run(0);
    for (int batches = 1; batches <= 4; ++batches) {
        INFO("pack of " << batches << " batches");
        CHECK(compare::difference(run(batches), one_lane).empty());
    }
}

template <class Method>
void check_order_of_instances() {
    std::vector<std::int64_t> order(103);
    std::iota(order.begin(), order.end(), 0);
    auto straight = oscillators(order);
    const options o = compare::with_tolerance(1e-5, 1e-3);
    solve<Method>(tests::test_device(2), straight, o);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    auto shuffled = oscillators(order);
    solve<Method>(tests::test_device(2), shuffled, o);
    for (std::size_t at = 0; at < order.size(); ++at)
        CHECK(compare::difference(shuffled, static_cast<std::int64_t>(at), straight, order[at]).empty());
}

/// Rings of oscillators at random, with damping from 50 to 150.
template <class Model, class R = double>
ensemble<Model, R> rings(std::int64_t size) {
    ensemble<Model, R> e(size);
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> draws(-2, 2);
    for (std::int64_t i = 0; i < size; ++i) {
        e.parameter(0)[i] = static_cast<R>(100 + 25 * draws(engine));
        for (int c = 0; c < Model::n_state; ++c) e.state(c)[i] = static_cast<R>(draws(engine));
    }
    e.time_domain(R(0), R(0.5));
    return e;
}

/// A ring with the pattern, declared or found, and without. The two Jacobians differ by rounding, which a tenth of the
/// tolerance bounds with room to spare; nothing in these rings amplifies it.
template <class Model, int size>
void check_pattern() {
    constexpr int n = Model::n_state;
    auto with = rings<Model>(size);
    auto without = rings<sparse::dense_ring<n>>(size);
    const auto o = compare::with_tolerance(1e-6, 1e-4);
    const auto sparse_report = solve<rodas_5p>(tests::test_device(1), with, o);
    const auto dense_report = solve<rodas_5p>(tests::test_device(1), without, o);
    CHECK(sparse_report.notes.empty());
    CHECK(sparse_report.matrix.states == n);
    CHECK(sparse_report.matrix.jacobian_entries == 5 * n / 2);
    CHECK(sparse_report.matrix.factor_entries < n * n);
    REQUIRE(dense_report.notes.size() == 1);
    CHECK(dense_report.notes[0].text().find("rhs looks at values") != std::string::npos);
    CHECK(dense_report.matrix.factor_entries == n * n);
    for (std::int64_t i = 0; i < size; ++i) {
        CAPTURE(i);
        CHECK(with.status(i) == status::success);
        CHECK(with.accepted_steps()[i] == without.accepted_steps()[i]);
        CHECK(with.rejected_steps()[i] == without.rejected_steps()[i]);
        for (int c = 0; c < n; ++c) CHECK(std::abs(with.state(c)[i] - without.state(c)[i]) <= 1e-7);
    }
}

}  // namespace

TEST_CASE("a step with a singular matrix is shortened, and ends as singular_jacobian where it may not be") {
    check_singular<rosenbrock_23>();
    check_singular<rodas_5p>();
    check_singular<rodas_5p, float>();
    check_singular<rosenbrock_23, double, sparse::growth_among_decays>();
    check_singular<rodas_5p, double, sparse::growth_among_decays>();
}

TEST_CASE("a network with its Jacobian's pattern takes the steps of the dense one, to the same states") {
    check_pattern<sparse::ring<8>, 40>();
    check_pattern<sparse::plain_ring<8>, 40>();
    check_pattern<sparse::ring<32>, 5>();
}

TEST_CASE("a pattern without an entry is refused, with the entry") {
    auto e = rings<sparse::ring_with_a_gap<8>>(20);
    refused([&] { solve<rodas_5p>(tests::test_device(1), e, compare::with_tolerance(1e-6, 1e-4)); },
            {"jacobian_pattern has no entry {7, 0}", "by state 0 at the start of instance 0 is 10",
             "add the entry, or leave out jacobian_pattern"});
}

TEST_CASE(
    "impacts that accumulate end a stiff method as event_accumulation, though its steps are shorter than 1 / 1e308") {
    for (const double tolerance : {1e-6, 1e-12}) {
        check_accumulation<rosenbrock_23>(tolerance, 1e-8);
        check_accumulation<rodas_5p>(tolerance, 1e-8);
    }
    check_accumulation<rodas_5p, float>(1e-5f, 0.1);
}

TEST_CASE("a stiff method does not stagnate before where rhs has no value beyond the state") {
    const auto check = []<class Method>(Method) {
        for (const double t_begin : {0.0, -1.0, 10.0}) {
            for (const double start : {0.0, 0.999}) {
                CAPTURE(t_begin, start);
                ensemble<faulty::cliff> e(1);
                e.state(0) = start;
                e.parameter(0) = e.parameter(1) = e.parameter(2) = 1.0;
                e.time_domain(t_begin, t_begin + 4);
                options o = compare::with_tolerance(1e-9, 1e-2);
                o.max_steps = 1'000'000;
                solve<Method>(tests::test_device(1), e, o);
                CHECK(e.status(0) == status::not_finite);
                CHECK(e.state(0)[0] <= 1);
                CHECK(e.state(0)[0] >= 1 - 1e-12);
            }
        }
    };
    check(rosenbrock_23{});
    check(rodas_5p{});
}

TEST_CASE("a Jacobian that is infinite while rhs is finite ends as singular_jacobian") {
    ensemble<stiff::draining> e(9);
    for (std::int64_t i = 0; i < e.size(); ++i) e.state(0)[i] = i % 2 == 0 ? 0.0 : 1.0;
    e.time_domain(0, 1);
    solve<rodas_5p>(tests::test_device(1), e, compare::with_tolerance(1e-6, 1e-2));
    for (std::int64_t i = 0; i < e.size(); ++i) {
        if (i % 2 == 0) {
            CHECK(e.status(i) == status::singular_jacobian);
            CHECK(e.state(0)[i] == 0);
        } else {
            CHECK(e.status(i) == status::success);
            // y = (1 - t/2)^2, and errors are not magnified, as y' falls with y
            CHECK(std::abs(e.state(0)[i] - 0.25) <= 1e-6 * static_cast<double>(e.accepted_steps()[i]));
        }
    }
}

TEST_CASE("a right-hand side that is not finite ends a stiff method as not_finite, at its last finite state") {
    using faulty::clock_fault;
    ensemble<clock_fault> e(9);
    e.state(clock_fault::y0) = 1.0;
    e.state(clock_fault::y1) = 0.0;
    e.parameter(clock_fault::rate) = 1.0;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        e.parameter(clock_fault::last_good)[i] = i % 2 == 0 ? 0.5 : 5.0;
        e.parameter(clock_fault::kind)[i] = static_cast<double>(i % 4 / 2);
    }
    e.time_domain(0, 1);
    solve<rosenbrock_23>(tests::test_device(1), e, compare::with_tolerance(1e-6, 1e-2));
    for (std::int64_t i = 0; i < e.size(); ++i) {
        CHECK(e.status(i) == (i % 2 == 0 ? status::not_finite : status::success));
        CHECK(e.t()[i] <= (i % 2 == 0 ? 0.5 : 1.0));
        // the problem is contracting: every step adds an error below the tolerance
        CHECK(std::abs(e.state(clock_fault::y0)[i] - std::exp(-e.t()[i])) <=
              1e-6 * static_cast<double>(e.accepted_steps()[i]));
    }
}

TEST_CASE("evaluations of rhs are counted, two a step of rosenbrock_23 and eight of rodas_5p") {
    const auto kinetics = [] {
        ensemble<stiff::robertson> r(3);
        r.state(0) = 1.0;
        r.state(1) = r.state(2) = 0.0;
        for (std::int64_t i = 0; i < r.size(); ++i) {
            r.t_begin()[i] = 0;
            r.t_end()[i] = std::pow(100.0, static_cast<double>(i));
        }
        return r;
    };
    auto e = kinetics();
    options o = compare::with_tolerance(1e-5, 1e-3);
    o.absolute_tolerance = 1e-10;
    solve<rosenbrock_23>(tests::test_device(1), e, o);
    for (std::int64_t i = 0; i < e.size(); ++i)  // plus the first slope, which a rejected step keeps
        CHECK(e.rhs_evaluations()[i] == 2 * (e.accepted_steps()[i] + e.rejected_steps()[i]) + 1);
    e = kinetics();
    solve<rodas_5p>(tests::test_device(1), e, o);
    for (std::int64_t i = 0; i < e.size(); ++i)
        CHECK(e.rhs_evaluations()[i] == 8 * (e.accepted_steps()[i] + e.rejected_steps()[i]));
}

// Errors of a stiff problem decay, so that the error at any time is that of a step or two and of the interpolant.
TEST_CASE("rosenbrock_23 locates events, samples and calls hooks on a stiff problem") {
    check_relay<rosenbrock_23>(1e-6, 10);
}
TEST_CASE("rodas_5p locates events, samples and calls hooks on a stiff problem") { check_relay<rodas_5p>(1e-6, 10); }

TEST_CASE("stiff methods take systems of seven and of thirty-two equations") {
    check_rod<rodas_5p, 7>(1e-8);
    check_rod<rodas_5p, 32>(1e-8);
    check_rod<rosenbrock_23, 32, float>(1e-4);
}

TEST_CASE("the order of the ensemble changes no bit of a stiff method's results") {
    check_order_of_instances<rosenbrock_23>();
    check_order_of_instances<rodas_5p>();
}

// With more instances blocks of a GPU are larger, and with them the part of its shared memory that has their steps.
TEST_CASE("the number of instances changes no bit of a large network's results") {
    const auto device = tests::test_device(1);
    const std::int64_t many = device.which() == myriad::device::kind::cuda ? 6000 : 40;
    const auto o = compare::with_tolerance(1e-5, 1e-3);
    auto all = rings<sparse::ring<32>>(many);
    const auto of_all = solve<rodas_5p>(device, all, o);
    for (const std::int64_t size : {std::int64_t{1}, many / 20}) {
        auto some = rings<sparse::ring<32>>(size);
        solve<rodas_5p>(device, some, o);
        for (std::int64_t i = 0; i < size; ++i) CHECK(compare::difference(some, i, all, i).empty());
    }
    auto blocks = rings<sparse::ring<32>>(many);
    auto of_one_warp = o;
    of_one_warp.block_size = 32;
    solve<rodas_5p>(device, blocks, of_one_warp);
    for (std::int64_t i = 0; i < many; ++i) CHECK(compare::difference(blocks, i, all, i).empty());
    if (device.which() == myriad::device::kind::cuda) CHECK(of_all.kernel.shared_bytes > 0);
}

// + - * / only, so that one lane has no other functions than packs
TEST_CASE("a stiff method gives the same bits in a scalar lane and in packs of every size") {
    check_pack_sizes<rodas_5p>();
}

TEST_CASE("the model's own Jacobian gives what the one by dual numbers gives") {
    const auto run = []<class Model>(ensemble<Model>&& e) {
        e.state(0) = 1.0;
        e.state(1) = e.state(2) = 0.0;
        e.time_domain(0, 40);
        options o = compare::with_tolerance(1e-8, 1e-6);
        o.absolute_tolerance = 1e-12;
        solve<rodas_5p>(tests::test_device(1), e, o);
        REQUIRE(e.status(0) == status::success);
        return std::vector<double>{e.state(0)[0], e.state(1)[0], e.state(2)[0],
                                   static_cast<double>(e.accepted_steps()[0])};
    };
    const auto dual = run(ensemble<stiff::robertson>(1)), own = run(ensemble<stiff::robertson_with_jacobian>(1));
    // The two differ by rounding: the steps are the same, the results agree within the roundings of a few hundred
    // steps.
    CHECK(dual[3] == own[3]);
    for (std::size_t c = 0; c < 3; ++c)
        CHECK(std::abs(dual[c] - own[c]) <= dual[3] * 10 * std::numeric_limits<double>::epsilon());
}

namespace {

/// The largest errors of samples and of ends of steps for sin t over [0, 10], the solution of Prothero and Robinson's
/// problem.
template <class Method>
std::pair<double, double> errors_of_samples(double rate, double maximum_step) {
    const auto error = [&](std::int64_t evenly, std::int64_t every, std::int64_t capacity) {
        myriad::ensemble<stiff::prothero_robinson> e(1);
        e.state(stiff::prothero_robinson::y0) = 0;
        e.parameter(stiff::prothero_robinson::rate) = rate;
        e.time_domain(0, 10);
        myriad::options o{
            .relative_tolerance = 1e-6, .absolute_tolerance = 1e-6, .step = 1e-2, .maximum_step = maximum_step};
        o.samples = {.states = {stiff::prothero_robinson::y0}, .capacity = capacity, .evenly = evenly, .every = every};
        myriad::solve<myriad::dense<Method>>(tests::test_device(), e, o);
        const auto stored = e.samples().stored()[0];
        const Eigen::ArrayXd y = e.samples().state(0).row(0).head(stored), t = e.samples().time().row(0).head(stored);
        return (y - t.sin()).abs().maxCoeff<Eigen::PropagateNaN>();
    };
    return {error(2001, 0, 2001), error(0, 1, 10'000)};
}

}  // namespace

TEST_CASE("samples of a very stiff solution err by the fourth power of the step, far above the tolerance of 1e-6") {
    const double free = std::numeric_limits<double>::infinity();
    // As in docs/numerics/stiff_methods.md. Ends of steps are accurate, so that steps grow with the rate, and with them
    // the error inside.
    const std::pair<double, double> expected[] = {{1e4, 6e-5}, {1e6, 2e-2}, {1e8, 2e-1}};
    for (const auto& [rate, inside] : expected) {
        INFO("rate " << rate);
        const auto [samples, ends] = errors_of_samples<myriad::rodas_5p>(rate, free);
        CHECK(samples > 0.5 * inside);
        CHECK(samples < 1.5 * inside);
        CHECK(ends < 1e-6);
        // Limited, steps of h leave 4e-4 h^4, whatever the rate.
        for (const double h : {0.1, 0.3}) {
            const double limited = errors_of_samples<myriad::rodas_5p>(rate, h).first;
            CHECK(limited < 4e-4 * std::pow(h, 4));
            CHECK(limited > 3e-4 * std::pow(h, 4));
        }
        CHECK(errors_of_samples<myriad::rosenbrock_23>(rate, free).first < 1e-6);
    }
}
