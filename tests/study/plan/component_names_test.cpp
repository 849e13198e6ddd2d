// SPDX-License-Identifier: MIT
// The names of components in results; how they are looked up is in axes_test.cpp.
#include <myriad/study/plan/component_names.hpp>

#include "tests/catch.hpp"

TEST_CASE("Results name a component by its own name unless another has it", "[component_names]") {
    using namespace myriad::studies;
    using enum component_kind;
    const component_names names("swing", {{state, 0, "x"},
                                          {parameter, 0, "x"},
                                          {state, 1, "v"},
                                          {parameter, 1, "status"},
                                          {accessory, 0, ""},
                                          {parameter, 2, "t_end"},
                                          {parameter, 3, "v_end"},
                                          {accessory, 1, "t_last"},
                                          {accessory, 2, "the_end"}});
    const auto variable = [&](const char* name) {
        return names.variable(names.find(name, {state, parameter, accessory, t_end}));
    };
    CHECK(variable("v") == "v");
    CHECK(variable("state.x") == "state_x");
    CHECK(variable("parameter.0") == "parameter_x");
    CHECK(variable("status") == "parameter_status");  // which is how instances ended
    CHECK(variable("accessory.0") == "accessory_0");
    CHECK(variable("t_end") == "t_end");              // of the time domain
    CHECK(variable("v_end") == "parameter_v_end");    // the last value of v
    CHECK(variable("t_last") == "accessory_t_last");  // the time at which the last phase ended
    CHECK(variable("the_end") == "the_end");
    CHECK(variable("parameter.t_end") == "parameter_t_end");
    CHECK(names.initial_variable(names.find("v", {state})) == "v_start");
    CHECK(names.initial_variable(names.find("parameter.x", {parameter})) == "parameter_x");
}
