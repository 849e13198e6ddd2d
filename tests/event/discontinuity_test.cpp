// SPDX-License-Identifier: MIT
// Event functions that jump: what their actions do to them, and phases that end on a jump.
#include "tests/catch.hpp"
#include "tests/event/time_models.hpp"
#include "tests/event/watching.hpp"
#include "tests/support/device.hpp"

using namespace watching;

namespace {

// Hits are located to the rounding of t and x, and each turns up in the next as twice as much.
constexpr double resolution = 100 * std::numeric_limits<double>::epsilon();

myriad::ensemble<walled> ball(bool turns_round, double x, double v, double t_end) {
    myriad::ensemble<walled> e(1);
    e.state(walled::x) = x;
    e.state(walled::v) = v;
    e.shared_integer(walled::turns_round) = turns_round ? 1 : 0;
    e.time_domain(0, t_end);
    return e;
}

template <class Model>
std::vector<double> logged(const myriad::ensemble<Model>& e) {
    std::vector<double> times;
    for (int k = 0; k < e.integer_accessory(Model::fired)[0]; ++k) times.push_back(e.accessory(k)[0]);
    return times;
}

myriad::options hits(std::int64_t stop_after = 0, myriad::direction d = myriad::direction::either) {
    myriad::options o;
    o.relative_tolerance = 1e-12;
    o.absolute_tolerance = 1e-12;
    o.step = 0.07;
    o.maximum_step = 0.4;
    o.events = {{.direction = d, .tolerance = 1e-6, .stop_after = stop_after}};
    return o;
}

}  // namespace

TEMPLATE_TEST_CASE("a ball that turns round where a sign jumps fires once per hit", "", ALL_METHODS) {
    for (const auto d : {myriad::direction::either, myriad::direction::falling}) {
        auto e = ball(true, 0.3, 1, 10);
        const auto report = myriad::solve<TestType>(tests::test_device(1), e, hits(0, d));
        CHECK(report.count(myriad::status::success) == 1);
        CHECK(agree(logged(e), {0.7, 1.7, 2.7, 3.7, 4.7, 5.7, 6.7, 7.7, 8.7, 9.7}, resolution));
        CHECK(std::abs(e.state(walled::x)[0] - 0.3) <= resolution);
    }
}

TEMPLATE_TEST_CASE("a ball that goes through fires at either wall", "", ALL_METHODS) {
    auto e = ball(false, 1.5, -1, 3);
    const auto report = myriad::solve<TestType>(tests::test_device(1), e, hits());
    CHECK(report.count(myriad::status::success) == 1);
    CHECK(agree(logged(e), {0.5, 1.5}, resolution));
}

TEMPLATE_TEST_CASE("phases that a jump ends find it once", "", ALL_METHODS) {
    for (const bool turns_round : {true, false}) {
        for (const bool one_call : {true, false}) {
            CAPTURE(turns_round, one_call);
            auto e = turns_round ? ball(true, 0.3, 1, 3) : ball(false, 1.5, -1, 3);
            auto o = hits(1);
            o.phase_time = myriad::phase_time::carry_on;
            o.phases = one_call ? 5 : 1;
            for (int call = 0; call < (one_call ? 1 : 5); ++call) myriad::solve<TestType>(tests::test_device(1), e, o);
            CHECK(e.t()[0] == 3);
            CHECK(agree(logged(e), turns_round ? std::vector{0.7, 1.7, 2.7} : std::vector{0.5, 1.5}, resolution));
        }
    }
}

TEMPLATE_TEST_CASE("a phase that the host puts back before the jump it ended on finds it again", "", ALL_METHODS) {
    auto e = ball(false, 1.5, -1, 1);
    for (int call = 1; call <= 3; ++call) {
        myriad::solve<TestType>(tests::test_device(1), e, hits(1));
        CHECK(e.status(0) == myriad::status::stopped_by_event);
        CHECK(e.integer_accessory(walled::fired)[0] == call);
        e.state(walled::x) = 1.5;
    }
}
