// SPDX-License-Identifier: MIT
// What a store knows of a study's model: every edit of a function is seen, and rounding is not.

#include "myriad/study/plan/model_behaviour.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <myriad/myriad.hpp>

#include "myriad/host/checks/behaviour.hpp"
#include "myriad/study/store/records.hpp"
#include "tests/catch.hpp"

namespace {

using namespace myriad;
using namespace myriad::studies;
using Catch::Matchers::Contains;

enum class edit {
    none,
    rewritten,      // the same in other words
    damping,        // of a velocity that is zero at the start
    late,           // a force that begins after the start
    twelfth_digit,  // of a parameter
    event,
    action,
    small_action,
    action_that_ends,
    stop,
    step,
    condition,
    observed,
    undefined,
};

/// A driven oscillator with every kind of function, which starts at rest in an equilibrium.
template <edit is>
struct oscillator {
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };
    enum accessory { highest, mean, n_accessory };
    enum integer_accessory { hits, n_integer_accessory };
    enum event { up, down, n_event };
    enum stop { kick, n_stop };
    enum trigger { both, n_trigger };
    enum observed { energy, n_observed };
    static constexpr summary summaries[] = {{energy, over_phase::integral, mean}};

    template <class R>
    static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto& p) {
        const R w = p[k] * R(is == edit::twelfth_digit ? 1 + 1e-10 : 1);
        const R damping = R(is == edit::damping ? 0.101 : 0.1) * y[v];
        const R force = is == edit::late && t > R(3) ? R(1) : R(0);
        const R back = is == edit::rewritten ? w * w * y[x] - w * w * R(0.1) : w * (w * (y[x] - R(0.1)));
        const R root = is == edit::undefined ? sqrt(y[x] - R(100)) : R(0);
        return {y[v], force - back - damping + root};
    }
    template <class R>
    static vec<R, n_event> events(auto, const vec<R, n_state>& y, const auto&) {
        return {y[x] - R(is == edit::event ? 0.51 : 0.5), y[x] + R(0.5)};
    }
    template <class R>
    static vec<R, n_observed> observe(auto, const vec<R, n_state>& y, const auto&) {
        return {y[x] * y[x] + R(is == edit::observed ? 2 : 1) * y[v] * y[v]};
    }
    template <class R>
    static R stop_time(int, int number, const auto& p) {
        return (R(number) + R(is == edit::stop ? 1.5 : 1)) * p[k];
    }
    static bool condition(int, const auto& positive) {
        return is == edit::condition ? positive[up] || positive[down] : positive[up] && positive[down];
    }
    static void initialise(auto& lane) { lane.accessory[highest] = lane.y[x]; }
    static action after_event(int event, auto& lane) {
        using R = std::remove_cvref_t<decltype(lane.y[v])>;
        if (event == up) lane.y[v] *= R(is == edit::action ? -0.8 : -0.9);
        if (event == down) lane.y[v] += 1;
        lane.integer_accessory[hits] += is == edit::small_action ? 2 : 1;
        return is == edit::action_that_ends && event == down ? action::end_phase : action::proceed;
    }
    static void after_stop(int, int, auto& lane) { lane.y[v] = 0; }
    static void after_trigger(int, auto& lane) { lane.y[x] = 0; }
    static void after_step(auto& lane) {
        if (is == edit::step ? lane.y[x] < lane.accessory[highest] : lane.y[x] > lane.accessory[highest])
            lane.accessory[highest] = lane.y[x];
    }
};

template <edit is, class R = double>
model_behaviour behaviour_of() {
    using model = oscillator<is>;
    const component_names names("oscillator", {{component_kind::state, 0, "x"},
                                               {component_kind::state, 1, "v"},
                                               {component_kind::parameter, 0, "k"},
                                               {component_kind::accessory, 0, "highest"},
                                               {component_kind::accessory, 1, "mean"},
                                               {component_kind::integer_accessory, 0, "hits"}});
    ensemble<model, R> one(1);
    const auto show = [&](std::int64_t instance, const detail::shown_place& place, void* to,
                          void (*take)(void*, const detail::shown_value&)) {
        one.state(model::x) = R(0.1);
        one.state(model::v) = R(0);
        one.parameter(model::k) = R(1) + R(0.1) * static_cast<R>(instance);
        one.accessory(model::highest) = R(0);
        one.accessory(model::mean) = R(0);
        one.integer_accessory(model::hits) = 0;
        one.time_domain(0, 10);
        detail::show_behaviour<model, R>(host::inputs_in(host::ensemble_access::data(one)), 0, place, to, take);
    };
    return {names, 1'000'000, static_cast<double>(std::numeric_limits<R>::epsilon()), show};
}

template <edit is, class R = double>
std::string difference() {
    const std::string stored = model_json("group", behaviour_of<edit::none, R>());
    std::string all;
    for (const statement& one : behaviour_of<is, R>().differences_from(model_of(stored, "group")))
        all += one.text() + '\n';
    return all;
}

}  // namespace

TEST_CASE("a model is the same as itself, and as one with other roundings", "[study]") {
    CHECK(difference<edit::none>() == "");
    CHECK(difference<edit::rewritten>() == "");
    CHECK(difference<edit::rewritten, float>() == "");
}

TEST_CASE("an edit of any function of a model is named", "[study]") {
    CHECK_THAT(difference<edit::damping>(), Contains("the right-hand side of state.v: "));
    CHECK_THAT((difference<edit::late, float>()), Contains("the right-hand side of state.v: "));
    CHECK_THAT(difference<edit::late>(), Contains("the right-hand side of state.v: "));
    CHECK_THAT(difference<edit::twelfth_digit>(), Contains("the right-hand side of state.v: "));
    CHECK_THAT(difference<edit::event>(), Contains("the function of event 0: "));
    CHECK_THAT(difference<edit::action>(), Contains("state.v after the action of event 0: "));
    CHECK_THAT(difference<edit::small_action>(), Contains("integer_accessory.hits after the action of event 1: 1 in "
                                                          "the store, 2 here"));
    CHECK_THAT(difference<edit::action_that_ends>(), Contains("what is to end after the action of event 1: nothing"));
    CHECK_THAT(difference<edit::stop>(), Contains("the time of stop 0: "));
    CHECK_THAT(difference<edit::step>(), Contains("accessory.highest after a step: "));
    CHECK_THAT(difference<edit::condition>(), Contains("the condition of trigger 0: "));
    CHECK_THAT(difference<edit::observed>(), Contains("the observed quantity 0: "));
    CHECK_THAT(difference<edit::undefined>(), Contains("the right-hand side of state.v: ") && Contains("nan here"));
}
