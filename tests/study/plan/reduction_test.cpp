// SPDX-License-Identifier: MIT
// Reductions of made-up columns: their values, and that these do not depend on chunks.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <myriad/study/plan/reduction.hpp>

#include "tests/catch.hpp"
#include "tests/support/message_of.hpp"

namespace {

using namespace myriad;
using Catch::Matchers::Contains;
using tests::message_of;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

/// A variable "x" of one or more values for each instance, and how the instances ended.
struct made_up {
    studies::variable x{.name = "x", .inner = {}}, status{.name = "status", .type = studies::element::u8};
    std::vector<double> values;
    std::vector<std::uint8_t> statuses;

    explicit made_up(std::vector<double> all, std::int64_t inner = 1) : values(std::move(all)) {
        if (inner > 1) x.inner = {{"phase", inner}};
        statuses.resize(values.size() / static_cast<std::size_t>(inner), static_cast<std::uint8_t>(status::success));
    }
    void fail(std::size_t i) { statuses[i] = static_cast<std::uint8_t>(myriad::status::max_steps); }

    /// The results of a reduction, from chunks of that many instances.
    std::vector<std::vector<double>> reduce(const ensemble_reduction& r, std::size_t chunk) const {
        const auto plan = r.definition().plan({&x});
        const std::size_t inner = values.size() / statuses.size();
        const auto together = plan.start();
        for (std::size_t first = 0; first < statuses.size(); first += chunk) {
            const std::size_t count = std::min(chunk, statuses.size() - first);
            const std::span all(values);
            const chunk_columns::column columns[] = {
                {&x, std::as_bytes(all.subspan(first * inner, count * inner))},
                {&status, std::as_bytes(std::span(statuses).subspan(first, count))}};
            const auto part = plan.start();
            part->add(chunk_columns(static_cast<std::int64_t>(first), static_cast<std::int64_t>(count), columns));
            const auto partial = part->partial();
            REQUIRE(static_cast<std::int64_t>(partial.size()) == plan.partial_size);
            together->add(std::span<const double>(partial));
        }
        return together->results();
    }
    std::vector<double> first_of(const ensemble_reduction& r) const { return reduce(r, statuses.size())[0]; }
};

}  // namespace

TEST_CASE("A histogram has numpy's bins, and counts what is outside", "[reduction]") {
    const made_up data({-1, 0, 0.5, 1, 1, 1.9, 2, 2.1, not_a_number, inf, -inf});
    const auto found = data.reduce(histogram_of("x", linspace(0, 2, 3)), 4);
    CHECK(found[0] == std::vector<double>{2, 4});
    CHECK(found[1] == std::vector<double>{1, 1, 3});
    CHECK(data.first_of(histogram_of("x", values({-1, 0, 0.25, 2}))) == std::vector<double>{1, 1, 5});
}
TEST_CASE("A histogram puts numbers at and next to an edge into the right bin", "[reduction]") {
    for (const axis_values& edges : {linspace(0.1, 0.7, 101), geomspace(1e-3, 10, 40)}) {
        std::vector<double> at, expected(static_cast<std::size_t>(edges.size()) - 1, 2);
        for (std::int64_t i = 0; i < edges.size(); ++i) {
            at.push_back(edges[i]);
            at.push_back(std::nextafter(edges[i], 0));
        }
        ++expected.back();  // which has its upper edge
        CHECK(made_up(at).first_of(histogram_of("x", edges)) == expected);
    }
}
TEST_CASE("Histograms of each phase count its values alone", "[reduction]") {
    made_up data({0.5, 10, 1.5, -1, 1.7, not_a_number, 0.1, 0.1}, 2);
    data.fail(3);
    const auto found = data.reduce(histograms_of("x", values({0, 1, 2, 20})), 3);
    CHECK(found[0] == std::vector<double>{1, 2, 0, 0, 0, 1});
    CHECK(found[1] == std::vector<double>{0, 0, 0, 1, 0, 1});
    const made_up one({0.5, 1.5, 7});
    CHECK(one.reduce(histograms_of("x", linspace(0, 2, 3)), 2) == one.reduce(histogram_of("x", linspace(0, 2, 3)), 2));
}
TEST_CASE("Quantiles spread a bin's values over it, and are NaN outside the edges", "[reduction]") {
    const auto quantiles = [](const made_up& of, std::vector<double> which, const axis_values& edges) {
        return of.first_of(quantiles_of("x", std::move(which), edges));
    };
    // Of 1 and 3 instances in bins of unequal width, a quarter lies below the edge between them.
    const made_up four({0.9, 1.1, 1.2, 4});
    CHECK(quantiles(four, {0, 0.125, 0.25, 0.5, 1}, values({0, 1, 4})) == std::vector<double>{0, 0.5, 1, 2, 4});
    // A bin that is empty holds no quantile.
    CHECK(quantiles(made_up({0.5, 2.5}), {0, 0.5, 0.75}, linspace(0, 3, 4)) == std::vector<double>{0, 1, 2.5});
    // What lies outside counts, but has no place; what is not finite does not count.
    const auto found = quantiles(made_up({-5, 0.5, 0.5, 5, not_a_number}), {0.1, 0.25, 0.75, 0.9}, linspace(0, 1, 2));
    CHECK(std::isnan(found[0]));
    CHECK(found[1] == 0);
    CHECK(found[2] == 1);
    CHECK(std::isnan(found[3]));
    CHECK(std::isnan(quantiles(made_up({not_a_number}), {0.5}, linspace(0, 1, 2))[0]));
    // The first quantile of each phase comes first.
    CHECK(quantiles(made_up({0.5, 2.5, 0.5, 2.5}, 2), {0.5, 1}, linspace(0, 3, 4)) ==
          std::vector<double>{0.5, 2.5, 1, 3});
}
TEST_CASE("Quantiles lie in the bin of the sorted value that they are", "[reduction]") {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    std::vector<double> all(1001);
    for (double& value : all) value = normal(random);
    const std::vector<double> which{0.001, 0.05, 0.3, 0.5, 0.95, 0.999};
    const auto found = made_up(all).first_of(quantiles_of("x", which, linspace(-5, 5, 201)));
    std::sort(all.begin(), all.end());
    for (std::size_t i = 0; i < which.size(); ++i) {
        const double exact = all[static_cast<std::size_t>(std::ceil(which[i] * 1001)) - 1];
        CHECK(std::fabs(found[i] - exact) <= 0.05 * (1 + 1e-12));  // a bin's width
    }
}
TEST_CASE("Extrema and means are of each phase, and leave failed instances and NaN out", "[reduction]") {
    made_up data({1, 10, 2, not_a_number, 3, 30, -100, 1000}, 2);
    data.fail(3);
    CHECK(data.first_of(minimum_of("x")) == std::vector<double>{1, 10});
    CHECK(data.first_of(maximum_of("x")) == std::vector<double>{3, 30});
    CHECK(data.first_of(mean_of("x")) == std::vector<double>{2, 20});
    for (std::size_t i = 0; i < 3; ++i) data.fail(i);
    CHECK(std::isnan(data.first_of(minimum_of("x"))[0]));
    CHECK(std::isnan(data.first_of(mean_of("x"))[1]));
}
TEST_CASE("A covariance of a variable with itself has the bits of its variance", "[reduction]") {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(1e6, 1e-3);
    std::vector<double> all(500);
    for (double& value : all) value = normal(random);
    const made_up data(all, 2);
    const auto plan = covariance_of("x", "x").definition().plan({&data.x, &data.x});
    const auto state = plan.start();
    const chunk_columns::column columns[] = {{&data.x, std::as_bytes(std::span(data.values))},
                                             {&data.status, std::as_bytes(std::span(data.statuses))}};
    state->add(chunk_columns(0, 250, columns));
    CHECK(static_cast<std::int64_t>(state->partial().size()) == plan.partial_size);
    CHECK(state->results()[0] == data.first_of(variance_of("x")));
}
TEST_CASE("Variances and standard errors are exact where deviations are far below the values", "[reduction]") {
    made_up data({1, 10, 2, not_a_number, 3, 30, -100, 1000}, 2);
    data.fail(3);
    CHECK(data.first_of(variance_of("x")) == std::vector<double>{1, 200});
    CHECK(data.first_of(standard_error_of("x")) == std::vector<double>{std::sqrt(1.0 / 3), 10});
    CHECK(std::isnan(made_up({5}).first_of(variance_of("x"))[0]));
    CHECK(made_up({5, 5, 5}).first_of(variance_of("x")) == std::vector<double>{0});
    // 1e9 and a few of its last bits: sums of squares in double would have no digit of the variance.
    constexpr double bit = 0x1p-23;
    CHECK(made_up({1e9, 1e9 + bit, 1e9 + 2 * bit}).first_of(variance_of("x")) == std::vector<double>{bit * bit});
    CHECK(made_up({1e9, 1e9 + bit, 1e9 + bit}).first_of(variance_of("x"))[0] == Approx(bit * bit / 3).epsilon(1e-15));
    // A mean that is rounded by far more than the deviations: 1 + 2^-53 here.
    CHECK(made_up({1, 1 + 0x1p-52}).first_of(variance_of("x"))[0] == 0x1p-105);
    CHECK(made_up({-1e-150, 1e-150}).first_of(variance_of("x"))[0] == Approx(2e-300));
    CHECK(made_up({1e140, -1e140}).first_of(variance_of("x"))[0] == Approx(2e280));
    CHECK(std::isnan(made_up({1e150, 1, 2}).first_of(variance_of("x"))[0]));
}
TEST_CASE("A mean near the largest number is finite, where the sum is not", "[reduction]") {
    constexpr double largest = std::numeric_limits<double>::max();
    CHECK(made_up({largest, largest, largest}).first_of(mean_of("x")) == std::vector<double>{largest});
    CHECK(made_up({-largest, -largest}).first_of(mean_of("x")) == std::vector<double>{-largest});
    CHECK(made_up({1e308, 1.2e308, 1.4e308}).first_of(mean_of("x"))[0] == Approx(1.2e308));
    // What the sum's overflow may not change: the mean of small ones.
    CHECK(made_up({5e-324, 5e-324}).first_of(mean_of("x")) == std::vector<double>{5e-324});
}

TEST_CASE("Integers of phases that an instance did not reach are reduced as missing, not as 0", "[reduction]") {
    const studies::variable n{.name = "n", .type = studies::element::i32, .inner = {{"phase", 2}}};
    const studies::variable status{.name = "status", .type = studies::element::u8};
    std::int32_t values[] = {4, 6, 8, 0};
    studies::fill(studies::element::i32, &values[3], 1);
    const std::uint8_t statuses[] = {0, 0};
    const chunk_columns::column columns[] = {{&n, std::as_bytes(std::span(values))},
                                             {&status, std::as_bytes(std::span(statuses))}};
    const auto reduce = [&](const ensemble_reduction& r) {
        const auto state = r.definition().plan({&n}).start();
        state->add(chunk_columns(0, 2, columns));
        return state->results();
    };
    CHECK(reduce(minimum_of("n"))[0] == std::vector<double>{4, 6});
    CHECK(reduce(mean_of("n"))[0] == std::vector<double>{6, 6});
    const auto histogram = reduce(histogram_of("n", linspace(0, 10, 3)));
    CHECK(histogram[0] == std::vector<double>{1, 2});
    CHECK(histogram[1] == std::vector<double>{0, 0, 1});
}
TEST_CASE("Reductions have the same bits whatever the chunks are", "[reduction]") {
    std::mt19937_64 random(3);
    std::vector<double> all(3000);
    for (double& value : all) value = std::ldexp(static_cast<double>(random()), -static_cast<int>(random() % 80)) - 1e3;
    const made_up data(all, 3);
    const auto user = sum_of("squares", {"x"}, 2, [](const chunk_columns& chunk, std::span<double> sums) {
        const auto x = chunk.values<double>("x");
        // Exact in whatever order: integers and counts.
        for (const double value : x) sums[0] += std::floor(std::fabs(value) / 1e18);
        sums[1] += static_cast<double>(chunk.size());
    });
    for (const ensemble_reduction& r :
         {histogram_of("x", linspace(-1e3, 1e19, 50)), histograms_of("x", linspace(-1e3, 1e19, 50)),
          quantiles_of("x", {0.1, 0.5}, linspace(-1e3, 1e19, 50)), minimum_of("x"), maximum_of("x"), mean_of("x"),
          variance_of("x"), standard_error_of("x"), user}) {
        const auto whole = data.reduce(r, 1000);
        for (const std::size_t chunk : std::vector<std::size_t>{1, 7, 512, 999}) CHECK(data.reduce(r, chunk) == whole);
    }
    CHECK(data.reduce(user, 10)[0][1] == 1000);
}
TEST_CASE("Mistakes with reductions are refused with what is wrong", "[reduction]") {
    CHECK_THAT(message_of([] { (void)histogram_of("x", values({1, 1})); }), Contains("do not increase"));
    CHECK_THAT(message_of([] { (void)histogram_of("x", values({1})); }), Contains("two or more edges"));
    CHECK_THAT(message_of([] { (void)histograms_of("x", values({1})); }), Contains("two or more edges"));
    CHECK_THAT(message_of([] { (void)quantiles_of("x", {}, linspace(0, 1, 2)); }), Contains("none is given"));
    for (const double q : {-0.1, 1.1, not_a_number})
        CHECK_THAT(message_of([&] { (void)quantiles_of("x", {0.5, q}, linspace(0, 1, 2)); }), Contains("from 0 to 1"));
    CHECK_THAT(message_of([] { (void)sum_of("", {}, 1, [](auto&, auto) {}); }), Contains("a name"));
    CHECK_THAT(message_of([] { (void)sum_of("s", {}, 1, nullptr); }), Contains("no function"));
    const made_up data({1, 2});
    const auto asks = [&](auto read) {
        return message_of(
            [&] { data.first_of(sum_of("s", {}, 1, [&](const chunk_columns& c, std::span<double>) { read(c); })); });
    };
    CHECK_THAT(asks([](const chunk_columns& c) { c.values<double>("y"); }),
               Contains("no variable \"y\" is computed; there are x, status"));
    CHECK_THAT(asks([](const chunk_columns& c) { c.values<float>("x"); }), Contains("float64, not float32"));
    CHECK_THAT(message_of([&] {
                   data.first_of(sum_of("s", {}, 1, [](auto&, std::span<double> sums) { sums[0] = not_a_number; }));
               }),
               Contains("gave nan for instances 0 to 1"));
}
