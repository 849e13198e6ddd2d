// SPDX-License-Identifier: MIT
// What a path depends on, and what it does not; samples of it; and what calls refuse.
#include "myriad/kernel/model/noise.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/support/device.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/noisy.hpp"

namespace {

using Catch::Matchers::Contains;
using noisy::sharing;
using noisy::solvable;

template <class R = double>
myriad::ensemble<solvable, R> start(std::int64_t paths, R t_begin = 0, R t_end = 1) {
    myriad::ensemble<solvable, R> e(paths);
    e.state(solvable::growth) = R(1);
    e.state(solvable::wide) = R(0.5);
    e.state(solvable::decay) = R(1);
    e.parameter(solvable::ito) = R(1);
    e.parameter(solvable::bare) = R(0);
    e.time_domain(t_begin, t_end);
    return e;
}
/// States that are their Wiener processes.
template <class R = double>
myriad::ensemble<solvable, R> bare(std::int64_t paths, R t_begin = 0, R t_end = 1) {
    auto e = start<R>(paths, t_begin, t_end);
    for (int c = 0; c < solvable::n_state; ++c) e.state(c) = R(0);
    e.parameter(solvable::bare) = R(1);
    return e;
}

/// How many instances of two ensembles differ in a bit of their states; the first has `shift` more before them.
template <class R>
std::int64_t differences(const myriad::ensemble<solvable, R>& all, const myriad::ensemble<solvable, R>& some,
                         std::int64_t shift = 0) {
    std::int64_t different = 0;
    for (std::int64_t i = 0; i < some.size(); ++i) {
        bool same = true;
        for (int c = 0; c < solvable::n_state; ++c)
            same = same && std::memcmp(&all.state(c).data()[i + shift], &some.state(c).data()[i], sizeof(R)) == 0;
        different += same ? 0 : 1;
    }
    return different;
}
double distance(const myriad::ensemble<solvable>& a, const myriad::ensemble<solvable>& b) {
    double largest = 0;
    for (int c = 0; c < solvable::n_state; ++c) largest = std::max(largest, (a.state(c) - b.state(c)).abs().maxCoeff());
    return largest;
}

template <class Method, class Ensemble>
void run(Ensemble& e, const myriad::options& o, int threads = 1) {
    myriad::solve<Method>(tests::test_device(threads), e, o);
}
using em = myriad::euler_maruyama;

}  // namespace

TEST_CASE("an instance's path is the same alone, among others, by any number of threads and in a chunk of a study") {
    auto all = start(203);
    run<myriad::milstein>(all, {.step = 0.01, .seed = 9});
    auto again = start(203);
    run<myriad::milstein>(again, {.step = 0.01, .seed = 9, .schedule = myriad::schedule::dynamic}, 3);
    CHECK(differences(all, again) == 0);
    for (const std::int64_t first : {1, 50, 198}) {
        auto chunk = start(5);
        myriad::host::ensemble_access::data(chunk).first_index = first;
        run<myriad::milstein>(chunk, {.step = 0.01, .seed = 9});
        CHECK(differences(all, chunk, first) == 0);
    }
    auto alone = start(1);
    run<myriad::milstein>(alone, {.step = 0.01, .seed = 9});
    CHECK(differences(all, alone) == 0);
}

TEST_CASE("neighbours with steps that end elsewhere change no bit of a path") {
    auto all = start(64);
    run<em>(all, {.step = 0.01, .seed = 9, .noise_step = 0.04});
    auto mixed = start(64);
    for (std::int64_t i = 0; i < 64; ++i)
        if (i % 3 == 0) mixed.t_end()(i) = 0.1 + 0.0123 * static_cast<double>(i);
    run<em>(mixed, {.step = 0.01, .seed = 9, .noise_step = 0.04});
    std::int64_t different = 0;
    for (std::int64_t i = 0; i < 64; ++i)
        if (i % 3 != 0) different += all.state(solvable::wide)[i] != mixed.state(solvable::wide)[i];
    CHECK(different == 0);
}

TEST_CASE("single precision has the same paths alone and among others") {
    auto all = start<float>(101);
    run<myriad::milstein>(all, {.step = 0.01, .seed = 9, .noise_step = 0.02}, 2);
    auto alone = start<float>(1);
    myriad::host::ensemble_access::data(alone).first_index = 77;
    run<myriad::milstein>(alone, {.step = 0.01, .seed = 9, .noise_step = 0.02});
    CHECK(differences(all, alone, 77) == 0);
}

TEST_CASE("steps of any length that a cell has follow the same path, forwards and backwards") {
    constexpr double cell = 0.125;
    auto whole = bare(100);
    run<em>(whole, {.step = cell, .seed = 4});
    CHECK((whole.state(solvable::wide) - whole.state(solvable::growth)).abs().minCoeff() > 0);
    for (const double step : {cell / 2, cell / 16, 0.375 * cell, 2 * cell, 8 * cell}) {
        INFO("step " << step);
        auto e = bare(100);
        run<em>(e, {.step = step, .seed = 4, .noise_step = cell});
        CHECK(distance(e, whole) < 1e-13);  // some hundred roundings of numbers near one
        e.time_domain(1, 0);
    }
    // W(0) - W(1) is the same as W(1) - W(0), but for the sign, along the path of the domain that begins at 1.
    auto backwards = bare(100, 1.0, 0.0), finer = bare(100, 1.0, 0.0);
    run<em>(backwards, {.step = cell, .seed = 4});
    run<em>(finer, {.step = cell / 4, .seed = 4, .noise_step = cell});
    CHECK(distance(backwards, finer) < 1e-13);
    CHECK(distance(backwards, whole) > 1);
}

TEST_CASE("a path does not depend on the place of its domain in time, nor on rounding far from zero") {
    auto near = bare(50), far = bare(50, 1000.3, 1001.3);
    run<em>(near, {.step = 0.01, .seed = 8});
    run<em>(far, {.step = 0.01, .seed = 8});
    CHECK(distance(near, far) < 1e-5);  // by the length of the last step, which ends at t_end
}

TEST_CASE("phases that continue in time follow one path, and those that begin anew have paths of their own") {
    auto whole = bare(100);
    run<em>(whole, {.step = 0.01, .seed = 6});
    // A phase ends within a step: 0.01 is no part of 0.125.
    auto parts = bare(100);
    run<em>(parts, {.phases = 8, .step = 0.01, .phase_length = 0.125, .seed = 6});
    CHECK(distance(parts, whole) < 1e-13);

    auto anew = bare(100);
    const auto report = myriad::solve<em>(
        tests::test_device(), anew, {.phases = 2, .step = 0.01, .seed = 6, .record = {.states = {solvable::growth}}});
    const auto w = report.records.state(solvable::growth);
    const Eigen::ArrayXd first = w.col(0), second = w.col(1) - w.col(0);
    CHECK((first - whole.state(solvable::growth)).abs().maxCoeff() == 0);
    CHECK(std::fabs((first * second).mean()) < 4 / std::sqrt(100.0));
}

TEST_CASE("steps that end at stop times, and begin there within a cell, follow the path") {
    auto whole = bare(30);
    run<em>(whole, {.step = 0.125, .seed = 6});
    myriad::ensemble<noisy::interrupted> e(30);
    for (int c = 0; c < solvable::n_state; ++c) e.state(c) = 0;
    e.parameter(solvable::ito) = 1;
    e.parameter(solvable::bare) = 1;
    e.accessory(noisy::interrupted::interval) = Eigen::ArrayXd::LinSpaced(30, 0.01, 0.3);
    e.accessory(noisy::interrupted::steps) = 0;
    e.time_domain(0, 1);
    myriad::solve<em>(tests::test_device(), e, {.step = 0.125, .seed = 6});
    CHECK((e.state(solvable::growth) - whole.state(solvable::growth)).abs().maxCoeff() < 1e-3);
    CHECK((e.state(solvable::decay) - whole.state(solvable::decay) - (1 / e.accessory(0) + 1e-9).floor())
              .abs()
              .maxCoeff() < 1e-3);
    CHECK(e.accessory(noisy::interrupted::steps).minCoeff() >= 8);
}

TEST_CASE("phases in several calls give the same bits as in one") {
    for (const double length : {0.0, 0.07}) {
        auto at_once = start(37);
        run<myriad::milstein>(at_once, {.phases = 4, .step = 0.01, .phase_length = length, .seed = 12});
        auto in_parts = start(37);
        for (int call = 0; call < 2; ++call)
            run<myriad::milstein>(in_parts, {.phases = 2, .step = 0.01, .phase_length = length, .seed = 12});
        CHECK(differences(at_once, in_parts) == 0);
    }
}

TEST_CASE("another seed gives another path") {
    auto one = bare(1000), other = bare(1000);
    run<em>(one, {.step = 0.1, .seed = 0});
    run<em>(other, {.step = 0.1, .seed = 1});
    const auto product = one.state(solvable::growth) * other.state(solvable::growth);
    CHECK(std::fabs(product.mean()) < 4 / std::sqrt(1000.0));
}

TEST_CASE("samples at the ends of steps are the states there, and between them on a straight line") {
    auto e = bare(3);
    run<myriad::dense<em>>(e,
                           {.step = 0.25,
                            .seed = 2,
                            .samples = {.states = {solvable::growth}, .capacity = 4, .times = {0.25, 0.375, 0.5, 1}}});
    auto half = bare(3, 0.0, 0.5);
    run<em>(half, {.step = 0.25, .seed = 2});
    for (std::int64_t i = 0; i < 3; ++i) {
        const auto w = [&](int k) { return e.samples().state(solvable::growth)(i, k); };
        CHECK(w(2) == half.state(solvable::growth)[i]);
        CHECK(w(1) == Approx(0.5 * (w(0) + w(2))));
        CHECK(w(3) == e.state(solvable::growth)[i]);
    }
}

TEST_CASE("a path that is not finite ends its instance alone") {
    auto e = start(20), other = start(20);
    e.state(solvable::growth)(7) = std::numeric_limits<double>::max();
    run<myriad::milstein>(e, {.step = 0.01, .seed = 3});
    run<myriad::milstein>(other, {.step = 0.01, .seed = 3});
    CHECK(e.statuses()[7] == myriad::status::not_finite);
    std::int64_t different = 0;
    for (std::int64_t i = 0; i < 20; ++i)
        if (i != 7) different += e.state(solvable::wide)[i] != other.state(solvable::wide)[i];
    CHECK(different == 0);
}

TEST_CASE("a diffusion is found to be additive, and to depend on each state's own alone") {
    using namespace myriad::detail;
    CHECK_FALSE(is_additive<solvable>);
    CHECK_FALSE(dependence_of_noise<solvable>.on_other_states);
    CHECK(dependence_of_noise<sharing>.on_other_states);
    CHECK(is_additive<noisy::additive>);
    CHECK(n_wiener<solvable> == 3);
    CHECK(n_wiener<sharing> == 2);
    CHECK_THAT(myriad::describe<sharing>(), Contains("hooks: rhs, diffusion (2 processes)"));
}

TEST_CASE("steps that a path has no places for are refused, and its options without a diffusion") {
    auto e = start(2);
    const auto message = [&](const myriad::options& o) { return tests::message_of([&] { run<em>(e, o); }); };
    CHECK_THAT(
        message({.step = 0.01, .noise_step = 0.03}),
        Contains("step is 0.01, which is neither a multiple of noise_step, 0.03, nor a number of 65536ths of it"));
    CHECK_THAT(message({.step = 1e-7, .noise_step = 0.1}), Contains("nor a number of 65536ths of it"));
    CHECK_THAT(message({.step = 0.1, .noise_step = -1}),
               Contains("noise_step is -1 (must not be negative, and finite)"));
    CHECK_THAT(message({.step = 0.1, .seed = -1}), Contains("seed is -1 (must be from 0 to 4294967295)"));
    CHECK_THAT(message({.phases = 1, .step = 1}), Contains("nothing was thrown"));
    auto long_ones = start<float>(1, 0, 1e6F);
    CHECK_THAT(tests::message_of([&] {
                   myriad::solve<myriad::milstein>(tests::test_device(), long_ones, {.step = 1, .phase_length = 1});
               }),
               Contains("cells (at most 262144 can be told apart in single precision)"));
    myriad::host::ensemble_access::data(e).first_index = std::int64_t{1} << 36;
    CHECK_THAT(message({.step = 0.1}), Contains("has no paths of its own"));
}
