// SPDX-License-Identifier: MIT
// Runs whose chunks are computed by other objects of the same study.
#include "myriad/study/run/handed_out_run.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <myriad/myriad.hpp>
#include <myriad/study.hpp>

#include "tests/catch.hpp"
#include "tests/study/models.hpp"

namespace {

using namespace myriad;
using Catch::Matchers::Contains;
using study_of_lorenz = study<studied::lorenz, runge_kutta_4, float>;

/// 100 instances in chunks of 30, of which those with a negative r fail.
struct example : study_of_lorenz {
    example() {
        axis("r", linspace(-1, 27, 20));
        axis("x", normal(1, 0.1));
        set("y", 1);
        set("z", 1);
        repeat(5);
        time_domain(0, 0.5);
        options.step = 0.01;
        chunk = 30;
        devices = {device::cpu(1)};
        keep.end = {"x", "z"};
        reduce(mean_of("x_end"));
        reduce(histogram_of("z_end", linspace(0, 40, 9)));
    }
};

}  // namespace

TEST_CASE("chunks that others compute give the bits of a run") {
    example whole, here, there;
    const study_result expected = whole.run();
    studies::handed_out_run run = here.hand_out();
    std::vector<std::int64_t> order;
    while (const auto chunk = run.claim_next()) order.push_back(*chunk);
    REQUIRE(order == std::vector<std::int64_t>{0, 1, 2, 3});
    CHECK_FALSE(run.complete());
    for (const std::int64_t chunk : {2, 0, 3, 1}) {
        const std::optional<studies::computed_chunk> computed = there.compute(chunk, run.content().chunk);
        REQUIRE(computed.has_value());
        run.commit(chunk, *computed);
    }
    CHECK(run.complete());
    CHECK(run.instances_done() == 100);
    const study_result result = here.finish(run);
    CHECK(result.complete);
    CHECK(result.instances == 100);
    CHECK(result.by_status == expected.by_status);
    CHECK(result.failed() == 5);
    for (const char* name : {"x_end_mean", "z_end_histogram", "status"})
        CHECK(result.values(name) == expected.values(name));
    const auto x = result.values_of<float>("x_end", 5, 95), x_expected = expected.values_of<float>("x_end", 5, 95);
    CHECK(x == x_expected);
}

TEST_CASE("a run that was handed out ends with what came back") {
    example here;
    studies::handed_out_run run = here.hand_out();
    const auto first = run.claim_next(), second = run.claim_next();
    REQUIRE((first && second));
    run.commit(*first, *here.compute(*first, 30));
    run.release(*second);
    CHECK(run.claim_next() == second);
    run.release(*second);
    const study_result result = here.finish(run);
    CHECK_FALSE(result.complete);
    CHECK(result.instances == 30);
}

TEST_CASE("a chunk of another study is refused") {
    example here;
    studies::handed_out_run run = here.hand_out();
    const auto first = run.claim_next();
    REQUIRE(first);
    studies::computed_chunk values = *here.compute(0, 20);
    CHECK_THROWS_WITH(run.commit(*first, values), Contains("they are of another study"));
    values = *here.compute(0, 30);
    values.columns.pop_back();
    CHECK_THROWS_WITH(run.commit(*first, values), Contains("variables: they are of another study"));
    CHECK_THROWS_WITH(here.compute(4, 30), Contains("there is no chunk 4"));
    CHECK_THROWS_WITH(here.compute(0, 101), Contains("chunks of 101 instances"));
}
