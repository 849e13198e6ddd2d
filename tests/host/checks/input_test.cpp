// SPDX-License-Identifier: MIT
// Bad input is refused before any work, by a message that names the problem, why it is one, and what to do.
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "tests/host/ensemble/refusal.hpp"
#include "tests/support/device.hpp"

namespace {

using ensemble_models::bare;
using ensemble_models::complete;
using ensemble_models::forgotten;
using ensemble_models::hooked;
using ensemble_models::watched;
using myriad::cash_karp;
using myriad::dense;
using myriad::device;
using myriad::ensemble;
using myriad::options;
using myriad::runge_kutta_4;
using myriad::solve;
using myriad::status;
using myriad::tsitouras_5;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const device one_thread = tests::test_device();

/// Checks that valid decays are refused with these options, by a message with all the words, and stay unchanged.
template <class Method = cash_karp>
void options_refused(const options& o, std::initializer_list<const char*> words) {
    auto e = good_decays();
    refused([&] { solve<Method>(one_thread, e, o); }, words);
    CHECK((e.state(bare::x) == 1.0).all());
    CHECK(e.status(0) == status::not_started);
}

template <class Model>
void input_refused(ensemble<Model>& e, std::initializer_list<const char*> words, const options& o = {}) {
    refused([&] { solve<cash_karp>(one_thread, e, o); }, words);
    CHECK(e.status(0) == status::not_started);
    CHECK_FALSE(e.counted());
}

/// Options that sample x at 5 times of [0, 1].
options sampled() {
    options o;
    o.samples.states = {bare::x};
    o.samples.evenly = 5;
    o.samples.capacity = 5;
    return o;
}

// --------------------------------------------------------------------------------------------------------------------
// Sizes
// --------------------------------------------------------------------------------------------------------------------

TEST_CASE("an empty or negative ensemble is refused", "[input]") {
    refused([] { ensemble<bare> e(0); }, {"ensemble has 0 instances", "must be positive"});
    refused([] { ensemble<bare> e(-3); }, {"ensemble has -3 instances", "must be positive"});
    refused([] { ensemble<bare, float> e(-1); }, {"ensemble has -1 instances"});
    refused([] { ensemble<bare> e(std::numeric_limits<std::int64_t>::min()); }, {"must be positive"});
}

TEST_CASE("a number of tolerances other than one or the number of states is refused", "[input]") {
    options o;
    o.relative_tolerance = {1e-9, 1e-9, 1e-9};
    options_refused(o, {"relative_tolerance has 3 values", "2 state components", "one value for all, or one for each"});
    o = {};
    o.absolute_tolerance = std::vector<double>(5, 1e-9);
    options_refused(o, {"absolute_tolerance has 5 values", "2 state components"});
    o = {};
    o.absolute_tolerance = std::vector<double>{};
    options_refused(o, {"absolute_tolerance has 0 values", "one value for all, or one for each"});
}

TEST_CASE("a number of event options other than none or the number of events is refused", "[input]") {
    options o;
    o.events.resize(2);
    options_refused(o, {"events has 2 entries", "0 event functions", "or none for defaults"});
    auto e = good_oscillators();
    input_refused(e, {"events has 2 entries", "1 event function", "one entry for each"}, o);
}

// --------------------------------------------------------------------------------------------------------------------
// Components never set, and values that are not finite
// --------------------------------------------------------------------------------------------------------------------

TEST_CASE("a component that was never set is named, with how to set it", "[input]") {
    ensemble<complete> e(4);
    input_refused(e, {"shared parameter 0 (scale)", "never set, or set to NaN", "ensemble.shared("});
    e.shared(complete::scale) = 1;
    input_refused(e, {"state 0 (x) is NaN in all 4 instances", "never set", "ensemble.state(x) ="});
    e.state(complete::x) = 1.0;
    input_refused(e, {"state 1 (v) is NaN in all 4 instances", "never set", "ensemble.state(v) ="});
    e.state(complete::v) = 0.0;
    input_refused(e, {"parameter 0 (rate) is NaN in all 4", "never set", "ensemble.parameter(rate) ="});
    e.parameter(complete::rate) = 1.0;
    input_refused(e, {"parameter 1 (force) is NaN in all 4", "ensemble.parameter(force) ="});
    e.parameter(complete::force) = 0.0;
    input_refused(e, {"t_begin is NaN in all 4", "never set", "ensemble.t_begin() ="});
    e.t_begin() = 0.0;
    input_refused(e, {"t_end is NaN in all 4", "never set", "ensemble.t_end() ="});
    e.t_end() = 1.0;
    CHECK(solve<cash_karp>(one_thread, e).count(status::success) == 4);  // accessories need not be set
}

TEST_CASE("a domain that was set to NaN is not said to have been set by nobody", "[input]") {
    auto e = good_decays();
    e.time_domain(0, nan);
    input_refused(e, {"t_end is NaN in all 5", "never set, or set to NaN"});
    e.time_domain(nan, 1);
    input_refused(e, {"t_begin is NaN in all 5", "never set, or set to NaN"});
}

struct unnamed {
    enum { x, y, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return s;
    }
};

TEST_CASE("a component of an enumeration without a name is named by its number", "[input]") {
    ensemble<unnamed> e(2);
    const Eigen::ArrayXd three = Eigen::ArrayXd::Zero(3);
    refused([&] { e.state(unnamed::y) = three; }, {"state 1 has 2 values"});
}

TEST_CASE("states, parameters and times that are not finite are counted, and the first instance is named", "[input]") {
    SECTION("a NaN state") {
        auto e = good_decays();
        e.state(bare::w)[2] = nan;
        e.state(bare::w)[4] = infinity;
        input_refused(
            e, {"state 1 (w) is not finite in 2 of 5 instances", "first in instance 2 (nan)", "invalid_instances"});
    }
    SECTION("an infinite parameter") {
        auto e = good_decays();
        e.parameter(bare::rate)[3] = -infinity;
        input_refused(
            e, {"parameter 0 (rate) is not finite in 1 of 5 instances", "instance 3 (-inf)", "correct the inputs"});
    }
    SECTION("infinite states in all instances were set") {
        auto e = good_decays();
        e.state(bare::x) = infinity;
        refused([&] { solve<cash_karp>(one_thread, e); },
                {"state 0 (x) is not finite in 5 of 5 instances", "instance 0 (inf)"});
    }
    SECTION("a NaN time") {
        auto e = good_decays();
        e.t_begin()[1] = nan;
        input_refused(e, {"t_begin is not finite in 1 of 5 instances", "instance 1 (nan)", "correct the inputs"});
        e = good_decays();
        e.t_end()[4] = nan;
        input_refused(e, {"t_end is not finite in 1 of 5 instances", "instance 4 (nan)", "correct the inputs"});
    }
    SECTION("a shared parameter") {
        auto e = good_oscillators();
        e.shared(complete::scale) = infinity;
        input_refused(e, {"shared parameter 0 (scale) is inf", "ensemble.shared("});
        e.shared(complete::scale) = nan;
        input_refused(e, {"shared parameter 0 (scale) is nan", "ensemble.shared("});
    }
    SECTION("with one instance") {
        auto e = good_decays(1);
        e.state(bare::x)[0] = infinity;
        refused([&] { solve<cash_karp>(one_thread, e); },
                {"state 0 (x) is not finite in 1 of 1 instances", "instance 0 (inf)"});
    }
    SECTION("in a float ensemble") {
        auto e = good_decays<float>();
        e.state(bare::x)[3] = std::numeric_limits<float>::infinity();
        refused([&] { solve<cash_karp>(one_thread, e); },
                {"state 0 (x) is not finite in 1 of 5 instances", "instance 3 (inf)"});
    }
}

TEST_CASE("an infinite t_begin is refused without advice to end the phase by an event", "[input]") {
    for (const double bad : {infinity, -infinity}) {
        auto e = good_decays();
        e.t_begin()[1] = bad;
        std::string said;
        try {
            solve<cash_karp>(one_thread, e);
        } catch (const myriad::error& failure) {
            said = failure.what();
        }
        INFO(said);
        CHECK(said.find("t_begin is not finite in 1 of 5 instances") != std::string::npos);
        CHECK(said.find("event") == std::string::npos);
    }
}

TEST_CASE("an infinite t_end is refused where nothing can end the phase", "[input]") {
    for (const double end : {infinity, -infinity}) {
        auto e = good_decays();
        e.t_end()[2] = end;
        input_refused(e, {"t_end is not finite in 1 of 5 instances", "first in instance 2", "inf",
                          "event with stop_after", "hook"});
        auto w = good_travellers();
        w.t_end() = end;
        input_refused(w, {"t_end is not finite in 5 of 5 instances", "stop_after"});
    }
    auto e = good_decays();
    e.t_end() = infinity;
    e.t_end()[3] = nan;
    input_refused(e, {"t_end is not finite in 5 of 5 instances"});
}

TEST_CASE("an infinite t_end is accepted where an event or a hook ends the phase", "[input]") {
    options o;
    o.events.resize(1);
    o.events[0].stop_after = 1;
    auto w = good_travellers();
    w.t_end() = infinity;
    CHECK(solve<cash_karp>(one_thread, w, o).count(status::stopped_by_event) == 5);
    for (std::int64_t i = 0; i < 5; ++i) {
        // the event's tolerance, 1e-6, over the speed
        CHECK(std::abs(w.t()[i] - 1 / (1.0 + static_cast<double>(i))) <= 1e-6);
    }
    ensemble<hooked> h(3);
    h.state(hooked::x) = 1.0;
    h.time_domain(0, infinity);
    CHECK(solve<cash_karp>(one_thread, h).count(status::stopped_by_user) == 3);
    CHECK((h.t() >= 1.0).all());
    CHECK(h.t().isFinite().all());
}

TEST_CASE("an infinite t_end with fixed steps ends at the event", "[input]") {
    options o;
    o.step = 0.125;
    o.max_steps = 1000;
    o.events.resize(1);
    o.events[0].stop_after = 1;
    auto w = good_travellers();
    w.t_end() = infinity;
    const auto report = solve<runge_kutta_4>(one_thread, w, o);
    CHECK(report.count(status::stopped_by_event) == 5);
    for (std::int64_t i = 0; i < 5; ++i) CHECK(std::abs(w.t()[i] - 1 / (1.0 + static_cast<double>(i))) <= 1e-6);
}

// --------------------------------------------------------------------------------------------------------------------
// Options
// --------------------------------------------------------------------------------------------------------------------

TEST_CASE("tolerances that are negative or not finite are refused, and two that are zero", "[input]") {
    for (const double bad : {-1e-9, 0.0, -0.0, nan, infinity}) {
        CAPTURE(bad);
        options o;
        o.relative_tolerance = bad;
        if (bad != 0) options_refused(o, {"relative_tolerance is ", "must be at least 0", "or 0 for"});
        o.absolute_tolerance = 0;
        if (bad == 0)
            options_refused(o, {"relative_tolerance and absolute_tolerance are 0", "error you accept per step"});
        o = {};
        o.absolute_tolerance = {1e-9, bad};
        if (bad != 0) options_refused(o, {"absolute_tolerance is ", "must not be negative", "or 0 for"});
        o = {};
        o.events.resize(1);
        o.events[0].tolerance = bad;
        auto e = good_oscillators();
        if (bad != 0) input_refused(e, {"event tolerance is ", "must not be negative", "1e-6"}, o);
    }
    options o;
    o.relative_tolerance = -1e-9;
    options_refused(o, {"relative_tolerance is -1e-09 (must be at least 0"});
}

TEST_CASE("a relative tolerance of zero leaves the error to the absolute one", "[input]") {
    auto e = good_decays<double>(100);
    options o;
    o.relative_tolerance = 0;
    o.absolute_tolerance = 1e-9;
    const auto report = solve<cash_karp>(one_thread, e, o);
    CHECK(report.count(status::success) == 100);
    for (std::int64_t i = 0; i < 100; ++i)
        CHECK(std::abs(e.state(bare::x)[i] - std::exp(-e.parameter(bare::rate)[i])) < 1e-8);
}
TEST_CASE("a relative tolerance of 9e18 is refused, and does not end in states that are not finite", "[input]") {
    for (const double bad : {1.0, 9e18, 1e300}) {
        options o;
        o.relative_tolerance = {bad, 2 * bad};
        options_refused(o, {"relative_tolerance is ", "less than 1", "absolute_tolerance"});
    }
}

template <class R>
void check_relative_tolerance_alone(double tolerance) {
    auto e = good_decays<R>(100);
    e.state(bare::x)[70] = 0;  // both states of this one are zero, and stay so
    e.state(bare::w).setZero();
    options o;
    o.relative_tolerance = tolerance;
    o.absolute_tolerance = 0;
    const auto report = solve<cash_karp>(one_thread, e, o);
    CHECK(report.count(status::success) == 100);
    CHECK(report.accepted_steps < 100 * 100);
    CHECK(e.state(bare::x)[70] == 0);
    CHECK(e.state(bare::w)[70] == 0);
    for (std::int64_t i = 0; i < 70; ++i) {
        const auto rate = static_cast<double>(e.parameter(bare::rate)[i]), x = std::exp(-rate), w = (1 - x) / rate;
        // errors per step, which decay along with x; w begins at zero and grows
        CHECK(std::abs(static_cast<double>(e.state(bare::x)[i]) - x) < 10 * tolerance * x);
        CHECK(std::abs(static_cast<double>(e.state(bare::w)[i]) - w) < 10 * tolerance * w);
    }
}

TEST_CASE("an absolute tolerance of zero is taken, and states that are zero divide nothing by zero", "[input]") {
    check_relative_tolerance_alone<double>(1e-9);
    check_relative_tolerance_alone<float>(1e-5);
}

TEST_CASE("tolerances that fixed steps do not use are neither refused in single precision nor said to be raised",
          "[input]") {
    auto e = good_decays<float>();
    options o;
    o.step = 0.125;
    o.relative_tolerance = 1e-60;  // zero in float
    o.absolute_tolerance = 1e-60;
    const auto report = solve<runge_kutta_4>(one_thread, e, o);
    CHECK(report.count(status::success) == 5);
    CHECK(report.notes.empty());
}

TEST_CASE("steps that are not positive and finite are refused", "[input]") {
    for (const double bad : {-0.5, 0.0, infinity, -infinity}) {
        CAPTURE(bad);
        options o;
        o.step = bad;
        options_refused(o, {"step is ", "must be positive", "first step"});
        options_refused<runge_kutta_4>(o, {"step is ", "must be positive", "fixed step"});
    }
}

TEST_CASE("a method of fixed steps without a step is refused", "[input]") {
    options_refused<runge_kutta_4>({}, {"step is not set", "fixed steps", "give options::step"});
}

TEST_CASE("step limits that leave no step are refused", "[input]") {
    options o;
    o.minimum_step = 0.5;
    o.maximum_step = 0.25;
    options_refused(o, {"minimum_step 0.5 is above maximum_step 0.25", "no step size is left"});
    for (const double bad : {-1.0, nan, infinity}) {
        o = {};
        o.minimum_step = bad;
        options_refused(o, {"minimum_step is ", "must not be negative"});
    }
    for (const double bad : {-1.0, 0.0, nan}) {
        o = {};
        o.maximum_step = bad;
        options_refused(o, {"maximum_step is ", "must be positive"});
    }
    for (const double bad : {0.5, -5.0, nan, infinity}) {
        o = {};
        o.growth_limit = bad;
        options_refused(o, {"growth_limit is ", "must be at least 1", "such as 5"});
    }
    for (const double bad : {0.0, 1.0, 2.0, -0.1, nan}) {
        o = {};
        o.shrink_limit = bad;
        options_refused(o, {"shrink_limit is ", "must be between 0 and 1", "such as 0.1"});
    }
    o = {};
    o.minimum_step = o.maximum_step = 0.125;  // no contradiction
    auto e = good_decays();
    CHECK_NOTHROW(solve<cash_karp>(one_thread, e, o));
}

TEST_CASE("counts that are not positive, or that no kernel can count to, are refused", "[input]") {
    constexpr std::int64_t huge = std::int64_t{1} << 40;
    for (const std::int64_t bad : {std::int64_t{0}, std::int64_t{-1}, huge}) {
        CAPTURE(bad);
        options o;
        o.phases = bad;
        options_refused(o, {"phases is ", "must be from 1 to"});
        o = {};
        o.sub_samples = bad;
        options_refused(o, {"sub_samples is ", "must be from 1 to"});
        o = {};
        o.accumulation_limit = bad;
        options_refused(o, {"accumulation_limit is ", "must be from 1 to"});
    }
    options more;
    more.accumulation_limit = 65536;  // than are counted from one phase to the next
    options_refused(more, {"accumulation_limit is 65536", "must be from 1 to 65535"});
    for (const std::int64_t bad : {std::int64_t{-1}, huge}) {
        options o;
        o.max_steps = bad;
        options_refused(o, {"max_steps is ", "must be from 1 to"});
        o = {};
        o.events.resize(1);
        o.events[0].stop_after = bad;
        auto e = good_oscillators();
        input_refused(e, {"stop_after is ", "must be from 0 to"}, o);
    }
    options o;
    o.max_steps = 20'000'000;  // a float counts to 2^24
    auto e = good_decays<float>();
    refused([&] { solve<cash_karp>(one_thread, e, o); }, {"max_steps is 20000000", "must be from 1 to 16000000"});
}

TEST_CASE("an event direction that does not exist is refused", "[input]") {
    options o;
    o.events.resize(1);
    o.events[0].direction = static_cast<myriad::direction>(7);
    auto e = good_oscillators();
    input_refused(e, {"event direction is 7", "falling, either, rising or none"}, o);
}

TEST_CASE("a choice that does not exist is refused, for every option that is one", "[input]") {
    const auto check = [](const char* name, auto&& set) {
        for (const int bad : {-1, 17}) {
            options o;
            set(o, bad);
            options_refused(o, {name, "which is none", "choose"});
        }
    };
    const auto to = [](auto& choice, int number) {
        choice = static_cast<std::remove_reference_t<decltype(choice)>>(number);
    };
    check("phase_time is ", [&](options& o, int bad) { to(o.phase_time, bad); });
    check("phase_step is ", [&](options& o, int bad) { to(o.phase_step, bad); });
    check("counting is ", [&](options& o, int bad) { to(o.counting, bad); });
    check("advice is ", [&](options& o, int bad) { to(o.advice, bad); });
    check("invalid_instances is ", [&](options& o, int bad) { to(o.invalid_instances, bad); });
    check("schedule is ", [&](options& o, int bad) { to(o.schedule, bad); });
    check("shared_placement is ", [&](options& o, int bad) { to(o.shared_placement, bad); });
}

TEST_CASE("an event tolerance below the resolution of its function is refused", "[input]") {
    options o;
    o.events.resize(1);
    auto e = good_travellers();  // x - 1: rounding of the one is 2^-53, of the 0 at which x begins nothing
    o.events[0].tolerance = 1e-17;
    input_refused(e,
                  {"tolerance of event 0 is 1e-17", "rounding changes its function by 1.11022302e-16", "instance 0",
                   "raise the tolerance"},
                  o);
    o.events[0].tolerance = 2.3e-16;
    CHECK(solve<cash_karp>(one_thread, e, o).count(status::success) == 5);

    // It begins at 1e9, and advances by the rounding of that, about.
    auto f = good_travellers();
    f.state(0) = 1e9;
    o.events[0].tolerance = 1e-12;
    input_refused(f, {"tolerance of event 0 is 1e-12", "rounding", "raise the tolerance"}, o);
    // A value that is far from zero now may be close to it later, where it is resolved.
    o.events[0].tolerance = 1e-9;
    CHECK(solve<cash_karp>(one_thread, f, o).count(status::success) == 5);
    // One instance of many that is far away is its own affair.
    auto g = good_travellers();
    g.state(0)[2] = 1e9;
    o.events[0].tolerance = 1e-12;
    CHECK(solve<cash_karp>(one_thread, g, o).count(status::success) == 5);
}

TEST_CASE("a step or tolerance that vanishes in the model's float is refused", "[input]") {
    // positive in double, zero in float
    auto e = good_decays<float>();
    options o;
    o.relative_tolerance = 1e-60;
    o.absolute_tolerance = 1e-60;
    refused([&] { solve<cash_karp>(one_thread, e, o); }, {"tolerance"});
    o = {};
    o.step = 1e-60;
    o.max_steps = 100;
    e = good_decays<float>();
    refused([&] { solve<runge_kutta_4>(one_thread, e, o); }, {"step"});
}

TEST_CASE("records of components or phases that do not exist are refused", "[input]") {
    options o;
    o.record.states = {bare::x, 2};
    options_refused(o, {"record.states names component 2", "the model has 2", "enumerators"});
    o = {};
    o.record.states = {-1};
    options_refused(o, {"record.states names component -1"});
    o = {};
    o.record.states = {bare::x, bare::x};
    options_refused(o, {"record.states names component 0 twice", "once"});
    o = {};
    o.record.accessories = {0};
    options_refused(o, {"record.accessories names component 0", "the model has 0"});
    o = {};
    o.record.integer_accessories = {0};
    options_refused(o, {"record.integer_accessories names component 0", "the model has 0"});
    o = {};
    o.phases = 3;
    o.record.time = true;
    o.record.from_phase = 3;
    options_refused(o, {"record.from_phase is 3", "the call has 3 phases", "nothing would be recorded"});
    o.record.from_phase = -1;
    options_refused(o, {"record.from_phase is -1"});
}

TEST_CASE("components named by enumerators of another enumeration are refused, and not taken by number", "[input]") {
    const auto complete_refused = [](const options& o, std::initializer_list<const char*> words) {
        auto e = good_oscillators();
        input_refused(e, words, o);
    };
    options o;
    o.record.states = {complete::x, complete::force};
    complete_refused(o, {"record.states names component 1", "ensemble_models::complete::parameter", "complete::state"});
    o = {};
    o.record.states.push_back(complete::peak);
    complete_refused(o, {"record.states names component 0", "complete::accessory", "complete::state"});
    o = {};
    o.record.accessories = {complete::steps};
    complete_refused(o, {"record.accessories names component 0", "complete::integer_accessory", "complete::accessory"});
    o = {};
    o.record.integer_accessories = {complete::scale};
    complete_refused(o, {"record.integer_accessories names component 0", "complete::shared"});
    o = {};
    o.record.states = {bare::x};  // of another model
    complete_refused(o, {"record.states names component 0", "bare::state", "complete::state"});
    o = {};
    o.record.accessories = {bare::rate};  // of a model without any
    options_refused(o, {"record.accessories names component 0", "bare::parameter"});
    o = sampled();
    o.samples.states = {bare::rate};
    options_refused<dense<cash_karp>>(o, {"samples.states names component 0", "bare::parameter", "bare::state"});

    auto e = good_oscillators();
    o = {};
    o.record = {
        .states = {complete::v, 0}, .accessories = std::vector<int>{1}, .integer_accessories = {complete::turns}};
    const auto report = solve<cash_karp>(one_thread, e, o);
    CHECK(report.records.state(0)(2, 0) == e.state(0)[2]);
    CHECK(report.records.accessory(complete::entered)(2, 0) == 0);
    CHECK(report.records.integer_accessory(complete::turns)(2, 0) == e.integer_accessory(1)[2]);
}

TEST_CASE("records that name nothing are refused, and not ignored", "[input]") {
    options o;
    o.phases = 3;
    o.record.from_phase = 1;
    options_refused(o, {"record.from_phase is 1", "names nothing to record", "leave out"});
}

TEST_CASE("a method that was not instantiated is refused by a message that says what to write", "[input]") {
    auto e = good_decays();
    refused([&] { solve<tsitouras_5>(one_thread, e); },
            {"not instantiated", "MYRIAD_INSTANTIATE(model, method)", "source file"});
    ensemble<forgotten> f(2);
    f.state(forgotten::x) = 1.0;
    f.time_domain(0, 1);
    refused([&] { solve<cash_karp>(one_thread, f); }, {"not instantiated", "MYRIAD_INSTANTIATE", "myriad_add_models"});
    ensemble<watched, float> w(2);  // in double only
    refused([&] { solve<cash_karp>(one_thread, w); }, {"not instantiated", "MYRIAD_INSTANTIATE_FLOAT"});
}

// --------------------------------------------------------------------------------------------------------------------
// Samples
// --------------------------------------------------------------------------------------------------------------------

TEST_CASE("samples by a method without dense output are refused", "[input]") {
    options_refused<cash_karp>(sampled(), {"no dense output", "dense<Method>", "MYRIAD_INSTANTIATE"});
}

TEST_CASE("no way, or two ways, of choosing samples is refused", "[input]") {
    options o = sampled();
    o.samples.evenly = 0;
    options_refused<dense<cash_karp>>(
        o, {"samples names 0 of evenly, times, times_of_instances and every", "exactly one"});
    o = sampled();
    o.samples.every = 3;
    options_refused<dense<cash_karp>>(
        o, {"samples names 2 of evenly, times, times_of_instances and every", "exactly one"});
    o.samples.times = {0.5};
    options_refused<dense<cash_karp>>(o, {"samples names 3 of"});
}

TEST_CASE("samples without states are refused, and not ignored", "[input]") {
    for (int which = 0; which < 5; ++which) {
        options o;
        if (which == 0) o.samples.evenly = 5;
        if (which == 1) o.samples.capacity = 5;
        if (which == 2) o.samples.times = {0.5};
        if (which == 3) o.samples.every = 2;
        if (which == 4) o.samples.minimum_spacing = 0.1;
        const char* const names[] = {"samples.evenly", "samples.capacity", "samples.times", "samples.every",
                                     "samples.minimum_spacing"};
        options_refused<dense<cash_karp>>(o, {names[which], "samples.states names no state", "name the states"});
        options_refused<cash_karp>(o, {names[which], "samples.states names no state"});
    }
}

TEST_CASE("a capacity of zero, or too small for the chosen samples, is refused", "[input]") {
    for (const std::int64_t bad : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1} << 40}) {
        options o = sampled();
        o.samples.capacity = bad;
        options_refused<dense<cash_karp>>(o, {"samples.capacity is ", "must be from 1 to", "samples to keep"});
    }
    options o = sampled();
    o.samples.capacity = 4;
    options_refused<dense<cash_karp>>(o, {"samples.capacity is 4", "give 5 samples", "raise the capacity"});
    o = sampled();
    o.phases = 3;
    o.samples.from_phase = 1;
    o.samples.capacity = 9;
    options_refused<dense<cash_karp>>(o, {"samples.capacity is 9", "give 10 samples"});
    o = sampled();
    o.samples.evenly = 0;
    o.samples.times = {0.25, 0.5, 0.75};
    o.samples.capacity = 2;
    options_refused<dense<cash_karp>>(o, {"samples.capacity is 2", "give 3 samples"});
}

TEST_CASE("sample times outside the domain, unordered or not finite are refused", "[input]") {
    options o = sampled();
    o.samples.evenly = 0;
    o.samples.times = {0.5, 0.25};
    options_refused<dense<cash_karp>>(o, {"samples.times go from 0.5 to 0.25", "instance 0", "from 0 to 1", "order"});
    o.samples.times = {0.25, 0.75, 0.5};
    options_refused<dense<cash_karp>>(o, {"samples.times are not in order at number 2", "0.5 after 0.75"});
    o.samples.times = {0.25, 0.25};
    options_refused<dense<cash_karp>>(o, {"samples.times are not in order", "once"});
    o.samples.times = {0.25, nan};
    options_refused<dense<cash_karp>>(o, {"samples.times[1] is nan", "must be finite"});
    o.samples.times = {-0.25, 0.5};
    options_refused<dense<cash_karp>>(o, {"samples.times go from -0.25 to 0.5", "instance 0", "within the domain"});
    o.samples.times = {0.5, 1.25};
    options_refused<dense<cash_karp>>(o, {"samples.times go from 0.5 to 1.25", "within the domain"});
    o.samples.times = {0.5, 1 + 1e-14};  // more than sixteen roundings: told with the digits that differ
    options_refused<dense<cash_karp>>(o, {"samples.times go from 0.5 to 1.00000000000001,", "from 0 to 1:"});

    auto e = good_decays();
    e.t_end()[3] = 0.375;
    o.samples.times = {0.25, 0.5};
    refused([&] { solve<dense<cash_karp>>(one_thread, e, o); }, {"instance 3", "from 0 to 0.375", "within the domain"});
    e.t_end()[3] = -1;
    refused([&] { solve<dense<cash_karp>>(one_thread, e, o); }, {"instance 3", "from 0 to -1"});
}

TEST_CASE("other wrong sample options are refused", "[input]") {
    options o = sampled();
    o.samples.states = {2};
    options_refused<dense<cash_karp>>(o, {"samples.states names component 2", "the model has 2"});
    o = sampled();
    o.samples.states = {bare::x, bare::x};
    options_refused<dense<cash_karp>>(o, {"samples.states names component 0 twice"});
    for (const std::int64_t bad : {1, -1}) {
        o = sampled();
        o.samples.evenly = bad;
        options_refused<dense<cash_karp>>(o, {"samples.evenly is ", "must be from 2"});
    }
    o = sampled();
    o.samples.evenly = 0;
    o.samples.every = -2;
    options_refused<dense<cash_karp>>(o, {"samples.every is -2", "must be from 1"});
    o = sampled();
    o.samples.minimum_spacing = -0.5;
    options_refused<dense<cash_karp>>(o, {"samples.minimum_spacing is -0.5", "must not be negative"});
    o = sampled();
    o.samples.from_phase = 1;
    options_refused<dense<cash_karp>>(o,
                                      {"samples.from_phase is 1", "the call has 1 phases", "nothing would be sampled"});
    o.samples.from_phase = -1;
    options_refused<dense<cash_karp>>(o, {"samples.from_phase is -1", "must not be negative"});
}

TEST_CASE("samples that do not fit those of an earlier call are refused", "[input]") {
    auto e = good_decays();
    options o = sampled();
    o.samples.capacity = 20;
    solve<dense<cash_karp>>(one_thread, e, o);
    CHECK((e.samples().stored() == 5).all());
    options other = o;
    other.samples.capacity = 30;
    refused([&] { solve<dense<cash_karp>>(one_thread, e, other); },
            {"another capacity (30)", "20", "same in all calls"});
    other = o;
    other.samples.states = {bare::w};
    refused([&] { solve<dense<cash_karp>>(one_thread, e, other); }, {"other states", "same in all calls"});
    CHECK_NOTHROW(solve<dense<cash_karp>>(one_thread, e, o));
    CHECK((e.samples().stored() == 10).all());
}

TEST_CASE("a call that is refused for its sample times marks no instance", "[input]") {
    auto e = good_decays();
    e.state(bare::x)[1] = nan;
    options o = sampled();
    o.samples.evenly = 0;
    o.samples.times = {5.0};
    o.invalid_instances = myriad::invalid_instances::mark;
    refused([&] { solve<dense<cash_karp>>(one_thread, e, o); }, {"samples.times", "within the domain"});
    CHECK(e.status(1) == status::not_started);
}

// --------------------------------------------------------------------------------------------------------------------
// Instances that are marked instead
// --------------------------------------------------------------------------------------------------------------------

TEST_CASE("instances with invalid input can be marked, and all others are integrated as if alone", "[input]") {
    constexpr std::int64_t size = 100;  // several packs, the last one partly filled
    options o;
    o.invalid_instances = myriad::invalid_instances::mark;
    auto clean = good_decays(size);
    solve<cash_karp>(one_thread, clean, o);

    auto e = good_decays(size);
    e.state(bare::x)[0] = nan;
    e.state(bare::w)[7] = -infinity;
    e.parameter(bare::rate)[40] = nan;
    e.t_begin()[41] = infinity;
    e.t_end()[98] = nan;
    e.t_end()[99] = infinity;  // and nothing could end it
    const auto report = solve<cash_karp>(tests::test_device(2), e, o);
    CHECK(report.count(status::invalid_input) == 6);
    CHECK(report.count(status::success) == size - 6);
    CHECK(report.failed() == 6);
    CHECK(report.first_failed == 0);
    CHECK(report.first_status == status::invalid_input);
    std::int64_t different = 0;
    for (std::int64_t i = 0; i < size; ++i) {
        if (i == 0 || i == 7 || i == 40 || i == 41 || i == 98 || i == 99) {
            CHECK(e.status(i) == status::invalid_input);
            CHECK(e.accepted_steps()[i] == 0);
            continue;
        }
        different += e.state(bare::x)[i] != clean.state(bare::x)[i] || e.state(bare::w)[i] != clean.state(bare::w)[i] ||
                     e.accepted_steps()[i] != clean.accepted_steps()[i] || e.status(i) != status::success;
    }
    CHECK(different == 0);
    CHECK(std::isnan(e.state(bare::x)[0]));  // inputs stay as they were
    CHECK(e.state(bare::x)[99] == 1.0);

    // They take no further part until restarted, also where the inputs were corrected.
    e.state(bare::x)[0] = 1.0;
    CHECK(solve<cash_karp>(one_thread, e, o).count(status::invalid_input) == 6);
    e.restart();
    CHECK(solve<cash_karp>(one_thread, e, o).count(status::invalid_input) == 5);
}

TEST_CASE("an instance that turns not finite costs itself alone", "[input]") {
    constexpr std::int64_t size = 100;
    auto clean = good_decays(size), e = good_decays(size);
    solve<cash_karp>(one_thread, clean);
    e.parameter(bare::rate)[30] = 1e308;  // rate x overflows
    e.state(bare::x)[30] = 1e10;
    const auto report = solve<cash_karp>(one_thread, e);
    CHECK(e.status(30) == status::not_finite);
    CHECK(e.state(bare::x)[30] == 1e10);
    CHECK(report.failed() == 1);
    std::int64_t different = 0;
    for (std::int64_t i = 0; i < size; ++i)
        different += i != 30 &&
                     (e.state(bare::x)[i] != clean.state(bare::x)[i] || e.state(bare::w)[i] != clean.state(bare::w)[i]);
    CHECK(different == 0);
}

TEST_CASE("evenly spaced samples over an infinite domain are refused", "[input]") {
    // Infinity has no fifth part.
    auto e = good_travellers();
    e.t_end() = infinity;
    options o;
    o.events.resize(1);
    o.events[0].stop_after = 1;
    o.samples.states = {watched::x};
    o.samples.evenly = 5;
    o.samples.capacity = 5;
    refused([&] { solve<dense<cash_karp>>(one_thread, e, o); }, {"evenly", "inf"});
}

// --------------------------------------------------------------------------------------------------------------------
// Devices
// --------------------------------------------------------------------------------------------------------------------

TEST_CASE("unknown devices are refused by name, with those there are", "[input]") {
    if (device::no_gpu().empty()) {
        refused([] { device::parse("cuda:99"); }, {"\"cuda:99\"", "does not exist", "numbered from 0"});
    } else {
        for (const char* name : {"cuda", "cuda:0", "cuda:1"})
            refused([&] { device::parse(name); },
                    {name, "not available", device::no_gpu().c_str(), "\"cpu\" or \"auto\""});
    }
    for (const char* name : {"cuda:", "cuda:x", "cuda:-1", "cuda:1x"})
        refused([&] { device::parse(name); }, {name, "no valid number", "cuda:0"});
    for (const char* name : {"cpu:0", "cpu:x", "cpu:", "cpu:-2", "cpu:2x", "cpu: 2", "cpu:99999999999"}) {
        INFO(name);
        refused([&] { device::parse(name); }, {name, "no valid number of threads", "cpu:4"});
    }
    for (const char* name : {"gpu", "", "CPU", "cpus", "auto:2", " cpu"}) {
        INFO(name);
        refused([&] { device::parse(name); },
                {myriad::message('"', name, '"').c_str(), "unknown", "auto, cpu, cpu:THREADS, cuda or cuda:NUMBER"});
    }
    refused([] { device::parse("cpu:5000"); }, {"5000 threads", "must be from 1 to 4096"});
    refused([] { device::cpu(-1); }, {"-1 threads", "must be from 1 to 4096", "0 for all cores"});
}

TEST_CASE("devices have the names by which they are found", "[input]") {
    CHECK((device::parse("auto").which() == device::kind::cuda) == device::no_gpu().empty());
    CHECK(device::parse("cpu").threads() == 0);
    CHECK(device::parse("cpu").name() == "cpu");
    CHECK(device::parse("cpu:4").threads() == 4);
    CHECK(device::parse("cpu:4").name() == "cpu:4");
    for (const device& d : myriad::devices()) CHECK(device::parse(d.name()).name() == d.name());
    CHECK(myriad::devices().front().name() == device::best().name());
}

}  // namespace
