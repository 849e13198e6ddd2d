// SPDX-License-Identifier: MIT
// What is computed and kept of a study, and what tells it from others.
#include <limits>
#include <string>
#include <vector>

#include <myriad/study/plan/study_plan.hpp>

#include "tests/catch.hpp"
#include "tests/support/message_of.hpp"

namespace {

using namespace myriad;
using namespace myriad::studies;
using enum component_kind;
using Catch::Matchers::Contains;

study_request request() {
    axes a(component_names("swing", {{state, 0, "x"}, {parameter, 0, "k"}, {accessory, 0, "a"}, {shared, 0, "B"}}));
    a.add("k", linspace(0, 1, 5));
    a.set("x", 2);
    a.set("B", 3);
    a.set("t_begin", 0);
    a.set("t_end", std::numeric_limits<double>::infinity());
    study_request asked{"cash_karp", element::f64, a, {}, {}, {}, {}, {}, {}, {}};
    asked.options.phases = 10;
    asked.options.record = {.from_phase = 6, .states = {0}, .time = true};
    return asked;
}
std::vector<std::string> names_of(const layout& content) {
    std::vector<std::string> names;
    for (const variable& v : content.variables) names.push_back(v.name);
    return names;
}
std::string message_of(const study_request& asked) {
    return tests::message_of([&] { plan_study(asked); });
}

}  // namespace

TEST_CASE("A study keeps records, last values and statuses along its axes", "[study_plan]") {
    study_request asked = request();
    asked.axes.add("a", normal(0, 1));
    asked.keep.end = {"x", "t"};
    asked.units = {{"state.x", "m"}, {"t", "s"}};
    layout content = plan_study(asked).content;
    content.chunk = 2;
    content.check();
    CHECK(names_of(content) == std::vector<std::string>{"a_start", "x", "t", "x_end", "t_last", "status"});
    CHECK(content.instances() == 5);
    CHECK(content.variables[0].role == role::coordinate);
    const variable& x = content.variables[content.find("x")];
    CHECK(x.inner == std::vector<dimension>{{"phase", 4}});
    CHECK(x.attributes ==
          std::vector<attribute>{{"long_name", "state x at the end of each recorded phase"}, {"units", "m"}});
    CHECK(content.variables[content.find("t_last")].attributes ==
          std::vector<attribute>{{"long_name", "time at which the last phase ended"}, {"units", "s"}});

    std::vector<std::string> coordinates;
    for (const coordinate& c : content.coordinates) coordinates.push_back(c.name + '(' + c.dimension + ')');
    CHECK(coordinates == std::vector<std::string>{"k(k)", "x_start()", "B()", "t_begin()", "t_end()", "phase(phase)"});
    std::vector<double> phase(2);
    content.coordinates.back().values(1, phase);
    CHECK(phase == std::vector<double>{7, 8});
}
TEST_CASE("Random values are not kept if that is not wanted, and can be reduced", "[study_plan]") {
    study_request asked = request();
    asked.axes.add("a", normal(0, 1));
    asked.keep.random = false;
    asked.reductions = {mean_of("a_start")};
    CHECK(names_of(plan_study(asked).content) ==
          std::vector<std::string>{"a_start_mean_partial", "a_start_mean", "x", "t", "status"});
}
TEST_CASE("What only a reduction needs is computed, and not kept", "[study_plan]") {
    study_request asked = request();
    asked.keep.records = asked.keep.status = false;
    asked.reductions = {mean_of("x"), maximum_of("a_end"), histogram_of("t_last", linspace(0, 1, 3))};
    study_plan plan = plan_study(asked);
    plan.content.chunk = 5;
    plan.content.check();
    CHECK(names_of(plan.content) == std::vector<std::string>{"x_mean_partial", "x_mean", "a_end_maximum_partial",
                                                             "a_end_maximum", "t_last_histogram_partial",
                                                             "t_last_histogram", "t_last_outside"});
    CHECK(plan.quantities.size() == 5);  // x, t, status, a_end, t_last
    CHECK(plan.bytes_per_instance() == 4 * 8 + 4 * 8 + 1 + 8 + 8);
    CHECK(plan.content.variables[1].inner == std::vector<dimension>{{"phase", 4}});
}
TEST_CASE("Descriptions differ exactly where results may", "[study_plan]") {
    const auto description = [](auto change) {
        study_request asked = request();
        change(asked);
        return plan_study(asked).content.description;
    };
    const std::string plain = description([](study_request&) {});
    CHECK_THAT(plain, Contains("\"parameter.k\": \"linspace(0, 1, 5)\""));
    const std::string others[] = {
        description([](study_request& s) { s.options.relative_tolerance = 1e-9; }),
        description([](study_request& s) { s.options.absolute_tolerance = {1e-9}; }),
        description([](study_request& s) { s.options.step = 1e-3; }),
        description([](study_request& s) { s.options.phases = 11; }),
        description([](study_request& s) { s.options.events = {{.tolerance = 1e-7}}; }),
        description([](study_request& s) { s.options.record.from_phase = 5; }),
        description([](study_request& s) { s.axes.set("x", 2.0000000000000004); }),
        description([](study_request& s) { s.axes.repeat(2); }),
        description([](study_request& s) { s.axes.add("a", uniform(0, 1)); }),
        description([](study_request& s) { s.axes.add("a", uniform(0, 1)), s.axes.seed(1); }),
        description([](study_request& s) { s.axes.add("a", values(std::vector<double>(2000, 1))); }),
        description([](study_request& s) {
            std::vector<double> list(2000, 1);
            list[1000] = 2;
            s.axes.add("a", values(list));
        }),
        description([](study_request& s) { s.method = "tsitouras_5"; }),
        description([](study_request& s) { s.keep.end = {"x"}; }),
        description([](study_request& s) { s.keep.status = false; }),
        description([](study_request& s) { s.reductions = {mean_of("x")}; }),
        description([](study_request& s) { s.reductions = {histogram_of("x", linspace(0, 1, 3))}; }),
        description([](study_request& s) { s.reductions = {histogram_of("x", linspace(0, 2, 3))}; }),
        description([](study_request& s) { s.generator = "first"; }),
        description([](study_request& s) {
            s.notes = {{"model", "2"}};
        }),
        description([](study_request& s) {
            s.units = {{"t", "s"}};
        }),
        plain,
    };
    for (const std::string& one : others) CHECK(std::count(std::begin(others), std::end(others), one) == 1);
    CHECK(plain == description([](study_request& s) {
              s.options.schedule = schedule::by_cost;
              s.options.chunk_size = 100;
              s.options.advice = advice::off;
              s.axes.seed(3);  // nothing is random
          }));
}
TEST_CASE("Studies that lack something are refused", "[study_plan]") {
    study_request asked = request();
    asked.axes = axes(asked.axes.names());
    asked.axes.set("x", 1);
    CHECK_THAT(message_of(asked), Contains("parameter.k has no value in any instance"));
    asked.generator = "named";
    CHECK(message_of(asked) == "nothing was thrown");

    asked = request();
    asked.keep.end = {"y"};
    CHECK_THAT(message_of(asked), Contains("\"y\" is no component of swing"));
    asked.keep.end = {"x", "x"};
    CHECK_THAT(message_of(asked), Contains("two variables are called x_end"));
    asked.keep.end = {};
    asked.reductions = {mean_of("v")};
    CHECK_THAT(message_of(asked), Contains("\"v\", which is not computed: there are x, t, status, and the last"));
    asked.reductions = {};
    asked.options.samples = {.states = {0}, .capacity = 1, .times_of_instances = {1, 2, 3, 4, 5}};
    CHECK_THAT(message_of(asked), Contains("times_of_instances"));
    asked.options.samples = {};
    asked.title = "no UTF-8: \xff";
    CHECK_THAT(message_of(asked), Contains("the title is no text in UTF-8"));
    asked.title = "";
    asked.units = {{"t", "\xe9"}};
    CHECK_THAT(message_of(asked), Contains("the unit of t is no text in UTF-8"));
}
