// SPDX-License-Identifier: MIT
// describe(): the library lists the parts of a model that it has found, so that a missing one shows.
#include "myriad/host/model/describe.hpp"

#include <string>

#include "myriad/model.hpp"
#include "tests/catch.hpp"
#include "tests/host/ensemble/models.hpp"
#include "tests/support/sparse.hpp"

namespace {

using ensemble_models::bare;
using ensemble_models::complete;
using ensemble_models::watched;
using myriad::describe;

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// A bare model with one hook and declaration more.
struct with_generic_after_step : bare {
    template <class R>
    MYRIAD_FUNCTION static myriad::mask_of<R> after_step(auto& lane) {
        return lane.y[x] < R(0.5);
    }
};
struct with_generic_after_step_without_result : bare {
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.y[x] = myriad::max(lane.y[x], R(0));
    }
};
struct with_scalar_after_step : bare {
    MYRIAD_FUNCTION static myriad::action after_step(auto&) { return myriad::action::end_phase; }
};
struct with_misspelt_hooks : bare {
    MYRIAD_FUNCTION static void initialize(auto&) {}
    MYRIAD_FUNCTION static void after_steps(auto&) {}
    MYRIAD_FUNCTION static void finalise(auto&) {}
};
struct with_summaries : bare {
    enum accessory { largest, last, n_accessory };
    enum observed { height, n_observed };
    static constexpr myriad::summary summaries[] = {{height, myriad::over_phase::maximum, largest},
                                                    {height, myriad::over_phase::time_of_maximum, last}};
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_observed>{y[x]};
    }
};
struct with_stops : bare {
    enum stop { dose, n_stop };
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int number, const auto&) {
        return static_cast<R>(number);
    }
    MYRIAD_FUNCTION static void after_stop(int, int, auto&) {}
};
/// A parameter that has the name of a hook.
struct with_a_parameter_stop_time : bare {
    enum parameter { stop_time, condition, n_parameter };
};
struct with_triggers : bare {
    enum event { warm, n_event };
    enum trigger { too_warm, n_trigger };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static bool condition(int, const auto& positive) { return positive[warm]; }
    MYRIAD_FUNCTION static void after_trigger(int, auto&) {}
};
struct with_declarations : bare {
    static constexpr bool writes_parameters = true;
    static constexpr bool writes_time_domain = true;
    static constexpr bool accessories_are_outputs = true;
    static constexpr bool scalar_only = true;
    static constexpr bool rare_events = true;
    static constexpr bool large_rhs = true;
};
struct with_declarations_denied : bare {
    static constexpr bool writes_parameters = false;
    static constexpr bool scalar_only = false;
};
struct branching : bare {
    static constexpr bool scalar_only = true;
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        if (y[x] > R(1)) return {R(0), R(0)};
        return {R(1), y[x]};
    }
};
struct with_jacobian : bare {
    template <class R>
    MYRIAD_FUNCTION static myriad::matrix<R, n_state> jacobian(auto, const myriad::vec<R, n_state>&, const auto&) {
        return {};
    }
};
struct large {
    enum { n_state = 7 };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 7> rhs(auto, const myriad::vec<R, 7>& y, const auto&) {
        return y;
    }
};
/// The same, with a branch.
struct large_with_branch : large {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 7> rhs(auto t, const myriad::vec<R, 7>& y, const auto&) {
        if (t > 1.0) return {};
        return y;
    }
};
/// Counts without names are counts as well.
struct unnamed {
    enum { n_state = 3, n_parameter = 2 };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 3> rhs(auto, const myriad::vec<R, 3>& y, const auto&) {
        return y;
    }
};

TEST_CASE("a complete model is described with every component and hook", "[describe]") {
    CHECK(describe<complete>() ==
          "components: 2 state, 2 parameter, 1 shared parameter, 1 shared integer, 2 accessory, 3 integer accessory, "
          "1 event\n"
          "hooks: rhs, events, initialise, after_step (scalar), after_event, finalise\n"
          "declares: nothing\n"
          "stiff methods: Jacobian by dual numbers, LU factors on GPUs in registers\n");
}

TEST_CASE("a bare model is described with its right-hand side alone", "[describe]") {
    CHECK(describe<bare>() ==
          "components: 2 state, 1 parameter, 0 shared parameter, 0 shared integer, 0 accessory, 0 integer accessory, "
          "0 event\n"
          "hooks: rhs\n"
          "declares: nothing\n"
          "stiff methods: Jacobian by dual numbers, LU factors on GPUs in registers\n");
    CHECK(has(describe<unnamed>(), "components: 3 state, 2 parameter, 0 shared"));
}

TEST_CASE("what stiff methods make of a model is described", "[describe]") {
    CHECK(has(describe<with_jacobian>(), "hooks: rhs, jacobian\n"));
    CHECK(has(describe<with_jacobian>(), "stiff methods: the model's Jacobian, LU factors on GPUs in registers\n"));
    CHECK(has(describe<large>(),
              "stiff methods: Jacobian by dual numbers, LU factors of 7 entries instead of 49, for 7 of the Jacobian, "
              "found when the model was compiled\n"));
    CHECK(has(describe<large_with_branch>(),
              "stiff methods: Jacobian by dual numbers, LU factors on GPUs in local memory\n"));
    CHECK(has(describe<sparse::ring<8>>(), "declares: autonomous, jacobian_pattern\n"));
    CHECK(has(describe<sparse::arrow<9>>(),
              "LU factors of 25 entries instead of 81, for 25 of the Jacobian, as declared\n"));
}

TEST_CASE("a model with events alone is described with them", "[describe]") {
    CHECK(has(describe<watched>(), "1 event\nhooks: rhs, events\n"));
}

TEST_CASE("a model with stop times or triggers is described with them", "[describe]") {
    CHECK(has(describe<with_stops>(), "hooks: rhs, stop_time, after_stop\n"));
    CHECK(has(describe<with_a_parameter_stop_time>(), "hooks: rhs\n"));
    CHECK(has(describe<with_triggers>(), "hooks: rhs, events, condition, after_trigger\n"));
}

TEST_CASE("a misspelt hook does not show", "[describe]") {
    CHECK(has(describe<with_misspelt_hooks>(), "hooks: rhs, finalise\n"));
}

TEST_CASE("scalar and generic forms of after_step are told apart", "[describe]") {
    CHECK(has(describe<with_scalar_after_step>(), "hooks: rhs, after_step (scalar)\n"));
    CHECK(has(describe<with_generic_after_step>(), "hooks: rhs, after_step (generic)\n"));
    CHECK(has(describe<with_generic_after_step_without_result>(), "hooks: rhs, after_step (generic)\n"));
}

TEST_CASE("observed quantities show with the number of their summaries", "[describe]") {
    CHECK(has(describe<with_summaries>(), "hooks: rhs, observe (2 summaries)\n"));
}

TEST_CASE("declarations show, but not those that are denied", "[describe]") {
    CHECK(has(describe<with_declarations>(),
              "declares: writes_parameters, writes_time_domain, accessories_are_outputs, scalar_only, rare_events, "
              "large_rhs\n"));
    CHECK(has(describe<with_declarations_denied>(), "declares: nothing\n"));
    CHECK(has(describe<branching>(), "declares: scalar_only\n"));
}

TEST_CASE("counts and declarations can be asked for by name", "[describe]") {
    CHECK(myriad::detail::n_state<complete> == 2);
    CHECK(myriad::detail::n_parameter<complete> == 2);
    CHECK(myriad::detail::n_shared<complete> == 1);
    CHECK(myriad::detail::n_shared_integer<complete> == 1);
    CHECK(myriad::detail::n_accessory<complete> == 2);
    CHECK(myriad::detail::n_integer_accessory<complete> == 3);
    CHECK(myriad::detail::n_event<complete> == 1);
    CHECK(myriad::detail::n_event<bare> == 0);
    CHECK(myriad::detail::has_after_event<complete>);
    CHECK_FALSE(myriad::detail::has_after_event<watched>);
    CHECK(myriad::detail::writes_parameters<with_declarations>);
    CHECK_FALSE(myriad::detail::writes_parameters<with_declarations_denied>);
    CHECK_FALSE(myriad::detail::writes_time_domain<bare>);
}

}  // namespace
