// SPDX-License-Identifier: MIT
// Axes: the values of any instance, in whatever parts they are asked for, and every mistake that can be made.
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <myriad/random.hpp>
#include <myriad/study/plan/axes.hpp>

#include "tests/catch.hpp"
#include "tests/support/message_of.hpp"

namespace {

using namespace myriad;
using enum studies::component_kind;
using Catch::Matchers::Contains;
using tests::message_of;

studies::component_names names() {
    return {"swing",
            {{state, 0, "x"},
             {state, 1, "v"},
             {parameter, 0, "k"},
             {parameter, 1, "x"},
             {parameter, 2, ""},
             {shared, 0, "B"},
             {shared_integer, 0, "power"},
             {integer_accessory, 0, "count"}}};
}

/// All values of a component.
std::vector<double> column(const axes& a, const studies::component& c) {
    std::vector<double> all(static_cast<std::size_t>(a.size()));
    for (const axes::entry& e : a.entries())
        if (e.what == c) a.fill(e, 0, a.size(), all.data());
    return all;
}
std::vector<double> all_of(const axis_values& v) {
    std::vector<double> all;
    for (std::int64_t i = 0; i < v.size(); ++i) all.push_back(v[i]);
    return all;
}

}  // namespace

TEST_CASE("linspace with ends too far apart is not said to be given infinity", "[axes]") {
    CHECK_THAT(message_of([] { (void)linspace(-1.7e308, 1.7e308, 5); }),
               Contains("linspace from -1.7e+308 to 1.7e+308 is longer than the largest number"));
}

TEST_CASE("linspace has the values of numpy.linspace, and both ends", "[axes]") {
    CHECK(all_of(linspace(0.2, 0.3, 4)) ==
          std::vector{0.2, 0.2 + 1 * (0.3 - 0.2) / 3, 0.2 + 2 * ((0.3 - 0.2) / 3), 0.3});
    CHECK(all_of(linspace(7, 9, 1)) == std::vector{7.0});
    CHECK(all_of(linspace(1, -1, 3)) == std::vector{1.0, 0.0, -1.0});
    const axis_values many = linspace(0, 0.1, 1'000'003);
    CHECK(many[1'000'002] == 0.1);
}
TEST_CASE("geomspace takes the ends themselves and has a constant ratio", "[axes]") {
    const axis_values v = geomspace(1e-3, 1e3, 7);
    CHECK(v[0] == 1e-3);
    CHECK(v[6] == 1e3);
    for (int i = 0; i < 7; ++i) CHECK(v[i] == Approx(std::pow(10, i - 3)).epsilon(1e-14));  // a few roundings
    CHECK(geomspace(-8, -2, 3)[1] == Approx(-4).epsilon(1e-15));
    CHECK(geomspace(5, 6, 1)[0] == 5);
}
TEST_CASE("The last axis of a grid varies fastest", "[axes]") {
    axes a(names());
    a.add("k", values({1, 2}));
    a.add("v", values({10, 20, 30}));
    a.set("state.x", 5);
    REQUIRE(a.size() == 6);
    CHECK(column(a, {parameter, 0}) == std::vector<double>{1, 1, 1, 2, 2, 2});
    CHECK(column(a, {state, 1}) == std::vector<double>{10, 20, 30, 10, 20, 30});
    CHECK(column(a, {state, 0}) == std::vector<double>(6, 5));
    REQUIRE(a.dimensions().size() == 2);
    CHECK(a.dimensions()[0].name == "k");
    CHECK(a.dimensions()[1].name == "v_start");  // a call changes v
}
TEST_CASE("Paired axes are one dimension", "[axes]") {
    axes a(names());
    a.zip({{"k", values({1, 2, 3})}, {"state.x", linspace(4, 6, 3)}});
    a.repeat(2);
    REQUIRE(a.size() == 6);
    CHECK(column(a, {parameter, 0}) == std::vector<double>{1, 1, 2, 2, 3, 3});
    CHECK(column(a, {state, 0}) == std::vector<double>{4, 4, 5, 5, 6, 6});
    CHECK(a.dimensions()[0].name == "k_state_x_start");
    CHECK(a.dimensions()[1].name == "draw");
}
TEST_CASE("Any part of the instances has the values that they have as a whole", "[axes]") {
    axes a(names());
    a.add("k", geomspace(1, 1000, 7));
    a.zip({{"v", linspace(0, 1, 5)}, {"state.x", linspace(3, 4, 5)}});
    a.add("parameter.x", normal(2, 0.5));
    a.repeat(3);
    for (const axes::entry& e : a.entries()) {
        std::vector<double> whole(static_cast<std::size_t>(a.size()));
        a.fill(e, 0, a.size(), whole.data());
        for (const std::int64_t size : {1, 2, 4, 31}) {
            for (std::int64_t first = 0; first < a.size(); first += size) {
                std::vector<double> part(static_cast<std::size_t>(std::min(size, a.size() - first)));
                a.fill(e, first, static_cast<std::int64_t>(part.size()), part.data());
                CHECK(std::equal(part.begin(), part.end(), whole.begin() + first));
            }
        }
    }
}
TEST_CASE("Random values depend on seed, component and instance alone", "[axes]") {
    axes a(names()), b(names());
    a.add("k", uniform(-1, 3));
    a.add("parameter.x", uniform(-1, 3));
    a.repeat(20'000);
    a.seed(7);
    b.repeat(20'000);
    b.add("v", normal(0, 1));
    b.add("k", uniform(-1, 3));
    b.seed(7);
    CHECK(column(a, {parameter, 0}) == column(b, {parameter, 0}));
    CHECK(column(a, {parameter, 0}) != column(a, {parameter, 1}));
    const auto before = column(b, {parameter, 0});
    b.seed(8);
    CHECK(before != column(b, {parameter, 0}));

    // Means and variances of n numbers are within 4 standard errors of those of the distributions.
    const auto check = [](const std::vector<double>& all, double mean, double variance, double fourth) {
        const auto n = static_cast<double>(all.size());
        double sum = 0, squares = 0;
        for (const double value : all) sum += value;
        for (const double value : all) squares += (value - mean) * (value - mean);
        CHECK(std::fabs(sum / n - mean) < 4 * std::sqrt(variance / n));
        CHECK(std::fabs(squares / n - variance) < 4 * std::sqrt((fourth - variance * variance) / n));
    };
    check(before, 1, 16.0 / 12, 16.0 * 16 / 80);
    check(column(b, {state, 1}), 0, 1, 3);
}
TEST_CASE("Random values are not those that hooks draw with the same seed", "[axes]") {
    axes a(names());
    a.add("state.x", uniform(0, 1));  // the first component of the first kind
    a.repeat(3);
    const auto drawn = column(a, {state, 0});
    for (std::int64_t i = 0; i < 3; ++i) {
        random_numbers<double> in_hook(0, i, 0);
        for (int draw = 0; draw < 100; ++draw) CHECK(in_hook.uniform() != drawn[static_cast<std::size_t>(i)]);
    }
}
TEST_CASE("Values are rounded to the type of the ensemble", "[axes]") {
    axes a(names());
    a.add("k", linspace(0, 1, 11));
    a.add("count", values({-3, 8}));
    std::vector<float> k(22);
    std::vector<std::int32_t> count(22);
    a.fill(a.entries()[0], 0, 22, k.data());
    a.fill(a.entries()[1], 0, 22, count.data());
    CHECK(k[2] == 0.1F);
    CHECK(count[0] == -3);
    CHECK(count[1] == 8);
}
TEST_CASE("Components are found by their own name, by kind and name, and by number", "[axes]") {
    axes a(names());
    a.set("k", 1);
    a.set("parameter.x", 2);
    a.set("parameter.2", 3);
    a.set("power", 4);
    a.set("t_end", std::numeric_limits<double>::infinity());
    a.set("parameter.0", 5);  // k, given again
    REQUIRE(a.entries().size() == 5);
    CHECK(a.entries()[0].values[0] == 5);
    CHECK(a.size() == 1);
}
TEST_CASE("Mistakes with axes are refused with what is wrong", "[axes]") {
    axes a(names());
    a.add("k", linspace(0, 1, 5));
    CHECK_THAT(message_of([&] { a.add("kk", linspace(0, 1, 5)); }),
               Contains("\"kk\" is no component of swing") && Contains("state x, v; parameter k, x, 2"));
    CHECK_THAT(message_of([&] { a.add("x", linspace(0, 1, 5)); }),
               Contains("several components") && Contains("state.x or parameter.x"));
    CHECK_THAT(message_of([&] { a.add("k", linspace(0, 1, 5)); }), Contains("parameter.k is given twice"));
    CHECK_THAT(message_of([&] { a.set("k", 1); }), Contains("parameter.k has an axis"));
    CHECK_THAT(message_of([&] { a.add("B", linspace(0, 1, 5)); }), Contains("shared.B is the same in all instances"));
    CHECK_THAT(message_of([&] { a.add("count", linspace(0, 1, 5)); }),
               Contains("an integer of 32 bits, but is given 0.25"));
    CHECK_THAT(message_of([&] { a.add("count", uniform(0, 1)); }), Contains("which random values are not"));
    CHECK_THAT(message_of([&] { a.set("power", 1e10); }), Contains("an integer of 32 bits"));
    CHECK_THAT(message_of([&] { a.set("v", std::nan("")); }), Contains("state.v is set to nan"));
    CHECK_THAT(message_of([&] {
                   a.zip({{"v", linspace(0, 1, 5)}, {"state.x", linspace(0, 1, 6)}});
               }),
               Contains("state.v has 5 values, state.x has 6"));
    CHECK_THAT(message_of([&] {
                   a.zip({{"v", linspace(0, 1, 5)}, {"state.v", linspace(0, 1, 5)}});
               }),
               Contains("state.v is given twice"));
    CHECK_THAT(message_of([&] { a.zip({{"v", uniform(0, 1)}}); }), Contains("cannot be paired"));
    CHECK_THAT(message_of([&] { a.zip({}); }), Contains("no axes"));
    CHECK_THAT(message_of([&] { a.repeat(0); }), Contains("0 values"));
    CHECK_THAT(message_of([&] { a.repeat(2, "k"); }), Contains("two axes are called \"k\""));
    CHECK_THAT(message_of([&] { a.repeat(std::int64_t{1} << 52); }), Contains("more than 2^53 instances"));
    CHECK(a.size() == 5);  // nothing of that changed it
    CHECK(a.entries().size() == 1);

    const double inf = std::numeric_limits<double>::infinity();
    CHECK_THAT(message_of([&] { (void)linspace(0, inf, 5); }), Contains("linspace is given inf"));
    CHECK_THAT(message_of([&] { (void)linspace(-1e308, 1e308, 5); }), Contains("longer than the largest"));
    CHECK_THAT(message_of([&] { (void)linspace(0, 1, 0); }), Contains("linspace is given 0 values"));
    CHECK_THAT(message_of([&] { (void)geomspace(-1, 1, 5); }), Contains("passes zero"));
    CHECK_THAT(message_of([&] { (void)values({}); }), Contains("values is given 0 values"));
    CHECK_THAT(message_of([&] { (void)values({1, std::nan("")}); }), Contains("finite"));
    CHECK_THAT(message_of([&] { (void)normal(0, 0); }), Contains("must be positive"));
    CHECK_THAT(message_of([&] { (void)uniform(0, inf); }), Contains("finite"));
}
