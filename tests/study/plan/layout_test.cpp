// SPDX-License-Identifier: MIT
// Sizes of layouts, and the messages for those that are not consistent.
#include "myriad/study/plan/layout.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using Catch::Matchers::Contains;
using namespace myriad::studies;

TEST_CASE("the chunks of a layout cover its instances, the last one the rest") {
    const layout content = tests::synthetic_layout();
    CHECK(content.instances() == 35);
    CHECK(content.chunks() == 9);
    std::int64_t next = 0;
    for (std::int64_t chunk = 0; chunk < content.chunks(); ++chunk) {
        CHECK(range_of(content, chunk).first == next);
        next += range_of(content, chunk).count;
    }
    CHECK(next == 35);
    CHECK(range_of(content, 8).count == 3);
    CHECK_THROWS_WITH(range_of(content, 9), "there is no chunk 9: they are 0 to 8");
    // x, y, count, step, status and noise of each instance, a histogram of each chunk, and one of all.
    CHECK(content.bytes() == 35 * (8 + 12 + 8 + 24 + 1 + 8) + 9 * 32 + 32);
}

TEST_CASE("values that are not computed are NaN or numbers that netCDF's readers know") {
    double d = 0;
    float f = 0;
    std::int64_t l = 0;
    std::int32_t i = 0;
    std::uint8_t u = 0;
    fill(element::f64, &d, 1), fill(element::f32, &f, 1), fill(element::i64, &l, 1), fill(element::i32, &i, 1);
    fill(element::u8, &u, 1);
    CHECK(d != d);
    CHECK(f != f);
    CHECK(l == -9223372036854775806);
    CHECK(i == -2147483647);
    CHECK(u == 255);
}

TEST_CASE("a layout that is not consistent is refused with what is wrong") {
    const auto refused = [](auto change, const std::string& message) {
        layout content = tests::synthetic_layout();
        CHECK_NOTHROW(content.check());
        change(content);
        CHECK_THROWS_WITH(content.check(), Contains(message));
    };
    refused([](layout& c) { c.axes[0].length = 0; }, "dimension a of the grid has length 0 (must be positive)");
    refused([](layout& c) { c.axes.push_back({"a", 7}); }, "axis a is given twice");
    refused([](layout& c) { c.axes[0].length = c.axes[1].length = std::int64_t{1} << 40; },
            "the number of instances is more than 2^63");
    refused([](layout& c) { c.variables[3].inner[0].length = std::int64_t{1} << 61; }, "dimension phase of step");
    refused([](layout& c) { c.variables[0].inner = {{"wide", std::int64_t{1} << 61}}; }, "the size of x is more than");
    refused([](layout& c) { c.chunk = 36; }, "a chunk has 36 instances (must be between 1 and their number, 35)");
    refused([](layout& c) { c.chunk = 0; }, "a chunk has 0 instances");
    refused([](layout& c) { c.variables.clear(); }, "nothing to be kept");
    refused([](layout& c) { c.variables[1].name = "x"; }, "the name x is taken");
    refused([](layout& c) { c.variables[1].name = "a"; }, "the name a is taken");
    refused([](layout& c) { c.variables[1].name = "myriad"; }, "the name myriad is taken");
    refused([](layout& c) { c.variables[1].name = "phase"; }, "variable phase has the name of a dimension");
    refused(
        [](layout& c) {
            c.coordinates[0].name = "b";
            c.coordinates[1].name = "c";
        },
        "coordinate b has the name of a dimension that it is not along");
    refused([](layout& c) { c.coordinates[0].dimension = "z"; }, "coordinate a is along z, which is no dimension");
    refused([](layout& c) { c.coordinates[0].values = nullptr; }, "coordinate a has no values");
    refused([](layout& c) { c.variables[1].inner[0].length = 2; }, "dimension phase of step has length 3, and 2");
    refused([](layout& c) { c.axes[0].name = "instance"; }, "dimension instance of the instances has length 35, and 7");
    for (const char* const name : {"", "../x", "a/b", "__x", ".x", "1x", "a b", "zarr\n"})
        refused([&](layout& c) { c.variables[0].name = name; }, "cannot be stored");
    for (const char* const text : {"", "[]", "{", "7"})
        refused([&](layout& c) { c.description = text; }, "is no JSON object");
    CHECK_THROWS_WITH(tests::synthetic_layout().find("z"),
                      "there is no variable z in the results, only x, y, count, step, status, noise, partial, total");
}

TEST_CASE("a coordinate that has fewer values than its dimension says so") {
    const coordinate c = with_values("k", "k", {1.0, 2.0});
    std::vector<double> read(2);
    c.values(0, read);
    CHECK(read == std::vector<double>{1.0, 2.0});
    CHECK_THROWS_WITH(c.values(1, read), Contains("a coordinate has 2 values, and its dimension is longer"));
}

}  // namespace
