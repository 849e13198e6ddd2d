// SPDX-License-Identifier: MIT
// The ensemble's Eigen maps: whole components read and written in place, wrong components refused, and restart.
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/host/ensemble/refusal.hpp"
#include "tests/support/device.hpp"

namespace {

using ensemble_models::bare;
using ensemble_models::complete;
using ensemble_models::watched;
using myriad::cash_karp;
using myriad::device;
using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;

const device one_thread = tests::test_device(1);

TEST_CASE("an ensemble begins with nothing set and nothing started", "[ensemble]") {
    const ensemble<complete> e(7);
    CHECK(e.size() == 7);
    for (const int c : {0, 1}) {
        CHECK(e.state(c).isNaN().all());
        CHECK(e.parameter(c).isNaN().all());
        CHECK(e.accessory(c).isNaN().all());
    }
    for (const int c : {0, 1, 2}) CHECK((e.integer_accessory(c) == 0).all());
    CHECK(e.t_begin().isNaN().all());
    CHECK(e.t_end().isNaN().all());
    CHECK(std::isnan(e.shared(complete::scale)));
    CHECK((e.phases_done() == 0).all());
    for (std::int64_t i = 0; i < 7; ++i) {
        CHECK(e.status(i) == status::not_started);
        CHECK_FALSE(e.ended(i));
    }
    CHECK_FALSE(e.counted());
}

TEST_CASE("components are Eigen maps over all instances, written in bulk", "[ensemble]") {
    ensemble<complete> e(46);
    e.parameter(complete::rate) = Eigen::ArrayXd::LinSpaced(e.size(), 0.0, 4.5);
    e.state(complete::x) = 2 * e.parameter(complete::rate) + 1;
    e.state(complete::v).head(10) = 3.0;
    e.state(complete::v).tail(36).setConstant(-1);
    e.accessory(complete::peak) = e.state(complete::x).max(e.state(complete::v));
    e.integer_accessory(complete::steps) = Eigen::ArrayXi::LinSpaced(46, 0, 45);
    e.t_begin() = 1.0;
    e.t_end().setLinSpaced(2.0, 6.5);
    CHECK(e.parameter(complete::rate).size() == 46);
    for (std::int64_t i = 0; i < 46; ++i) {
        const auto n = static_cast<double>(i);
        CHECK(e.parameter(complete::rate)[i] == Approx(0.1 * n).margin(1e-14));  // rounding of LinSpaced
        CHECK(e.state(complete::x)[i] == 2 * e.parameter(complete::rate)[i] + 1);
        CHECK(e.state(complete::v)[i] == (i < 10 ? 3 : -1));
        CHECK(e.accessory(complete::peak)[i] == std::max(e.state(complete::x)[i], e.state(complete::v)[i]));
        CHECK(e.integer_accessory(complete::steps)[i] == i);
    }
    CHECK(e.accessory(complete::entered).isNaN().all());  // its neighbours are untouched
    CHECK(e.parameter(complete::force).isNaN().all());
    CHECK((e.integer_accessory(complete::turns) == 0).all());
    CHECK(e.t_end()[45] == 6.5);
}

TEST_CASE("values of another number than there are instances are refused, and do not run past the ends", "[ensemble]") {
    ensemble<complete> e(46);
    const Eigen::ArrayXd good = Eigen::ArrayXd::LinSpaced(46, 0, 1), few = good.head(10),
                         many = Eigen::ArrayXd::Zero(47);
    e.state(complete::x) = good;
    refused([&] { e.state(complete::x) = few; },
            {"state 0 (x) has 46 values", "is given 10", "a single number for all"});
    refused([&] { e.state(complete::x) = many; }, {"state 0 (x)", "is given 47"});
    refused([&] { e.state(complete::x) += few; }, {"is given 10"});
    refused([&] { e.state(complete::x) -= few; }, {"is given 10"});
    refused([&] { e.state(complete::x) *= few; }, {"is given 10"});
    refused([&] { e.state(complete::x) /= few; }, {"is given 10"});
    refused([&] { e.state(complete::x) = 2 * few + 1; }, {"is given 10"});
    refused([&] { e.state(complete::x) = few.matrix(); }, {"is given 10"});
    refused([&] { e.state(complete::x) = few.matrix().transpose(); }, {"is given 10"});
    refused([&] { e.state(complete::x) = Eigen::ArrayXXd::Zero(1, 46); }, {"is given 46 that are not one column"});
    const ensemble<complete> other(3);
    refused([&] { e.state(complete::x) = other.state(complete::x); }, {"is given 3"});
    refused([&] { e.parameter(complete::force) = few; }, {"parameter 1 (force) has 46 values", "is given 10"});
    refused([&] { e.accessory(complete::peak) = few; }, {"accessory 0 (peak)"});
    refused([&] { e.integer_accessory(complete::turns) = few.cast<int>(); }, {"integer accessory 1 (turns)"});
    refused([&] { e.t_end() = few; }, {"t_end has 46 values", "is given 10"});
    refused([&] { e.tolerance_scale() = few; }, {"tolerance_scale has 46 values"});
    CHECK((e.state(complete::x) == good).all());
    ensemble<complete> three(3);
    refused([&] { three.state(complete::v) << 1, 2; }, {"state 1 (v) has 3 values", "is given 2"});
    refused([&] { three.state(complete::v) << 1, 2, 3, 4; }, {"state 1 (v) has 3 values", "is given 4"});
    CHECK(three.state(complete::x).isNaN().all());
}

TEST_CASE("functions of Eigen that give a component another length are refused, and do not fill it", "[ensemble]") {
    ensemble<complete> e(46);
    auto x = e.state(complete::x);
    x = 7;
    Eigen::ArrayXd few = Eigen::ArrayXd::Zero(10), as_many = Eigen::ArrayXd::LinSpaced(46, 0, 9);
    const auto refuses = [](auto&& call) {
        refused(call, {"state 0 (x) has 46 values", "is given 10", "a single number for all"});
    };
    refuses([&] { x.setLinSpaced(10, 0, 1); });
    refuses([&] { x.resize(10); });
    refuses([&] { x.resize(10, 1); });
    refuses([&] { x.swap(few); });
    refuses([&] { x.swap(e.state(complete::v).head(10)); });
    refused([&] { x.resize(46, 2); }, {"state 0 (x) has 46 values", "is given 92 that are not one column"});
    CHECK((x == 7).all());
    x.resize(46);
    x.resize(46, 1);
    CHECK((x == 7).all());
    CHECK(x.setLinSpaced(46, 0, 4.5)[45] == 4.5);
    CHECK(x.setLinSpaced(0, 3)[45] == 3);
    x.swap(as_many);
    CHECK(x[45] == 9);
    CHECK(as_many[45] == 3);
    e.state(complete::v) = 5;
    x.swap(e.state(complete::v));
    CHECK(e.state(complete::v)[45] == 9);
    CHECK((x == 5).all());
    CHECK((x.setZero() == 0).all());
    // The maps lack the other members by which Eigen's arrays get a length.
    const auto has_others = [](auto& map) {
        return requires { map.setZero(46); }
        || requires { map.setOnes(46); }
        || requires { map.setConstant(46, 3); }
        || requires { map.setRandom(46); }
        || requires { map.conservativeResize(46); }
        || requires { map.resizeLike(map); };
    };
    CHECK_FALSE(has_others(x));
}

TEST_CASE("components take whatever of their length Eigen can assign, and parts of them are Eigen's", "[ensemble]") {
    ensemble<complete> e(4), other(4);
    const auto is = [](const auto& values, double a, double b, double c, double d) {
        return values[0] == a && values[1] == b && values[2] == c && values[3] == d;
    };
    auto x = e.state(complete::x);
    x << 1, 2, 3, 4;
    CHECK(is(e.state(complete::x), 1, 2, 3, 4));
    other.state(complete::x) = e.state(complete::x);
    CHECK(is(other.state(complete::x), 1, 2, 3, 4));
    e.state(complete::x) = Eigen::RowVector4d(4, 3, 2, 1);
    CHECK(is(x, 4, 3, 2, 1));
    x = Eigen::VectorXd::Constant(4, 2);
    CHECK((x == 2).all());
    x += Eigen::Array4d(0, 1, 2, 3);
    x *= 2;
    CHECK(is(x, 4, 6, 8, 10));
    x -= 1;
    x /= x;
    CHECK((x == 1).all());
    x = x + x.reverse();  // an expression of the map itself
    x.segment(1, 2) = 5;
    x << Eigen::Array2d(7, 8), 9, 10;
    CHECK(is(x, 7, 8, 9, 10));
    x = 0;
    Eigen::Ref<Eigen::ArrayXd> as_argument = x;
    as_argument[2] = 3;
    for (double& value : e.state(complete::x)) value += 1;
    CHECK(is(x, 1, 1, 4, 1));
}

TEST_CASE("a component is contiguous, begins on a cache line, and is the same memory at every access", "[ensemble]") {
    ensemble<complete> e(64);
    double* const data = e.state(complete::v).data();
    CHECK(data == e.state(1).data());
    CHECK(data == std::as_const(e).state(complete::v).data());
    CHECK(data == e.state(complete::x).data() + 64);
    CHECK(reinterpret_cast<std::uintptr_t>(e.state(complete::x).data()) % 64 == 0);
    CHECK(e.state(complete::v).innerStride() == 1);
    data[5] = 0.25;
    CHECK(e.state(complete::v)[5] == 0.25);
}

TEST_CASE("a constant ensemble is read only, and results always are", "[ensemble]") {
    using e = ensemble<complete>;
    CHECK(std::is_same_v<decltype(std::declval<e&>().state(0)), e::map<double>>);
    CHECK(std::is_same_v<decltype(std::declval<const e&>().state(0)), e::const_map<double>>);
    CHECK(std::is_same_v<decltype(std::declval<const e&>().t_end()), e::const_map<double>>);
    CHECK(std::is_same_v<decltype(std::declval<e&>().t()), e::const_map<double>>);
    CHECK(std::is_same_v<decltype(std::declval<e&>().rhs_evaluations()), e::const_map<std::int64_t>>);
    CHECK(std::is_same_v<decltype(std::declval<ensemble<bare, float>&>().state(0)), ensemble<bare, float>::map<float>>);
    CHECK_FALSE(std::is_copy_constructible_v<e>);
    CHECK(std::is_nothrow_move_constructible_v<e>);
}

TEST_CASE("an ensemble that was moved away has no instances, and says so to whoever uses it", "[ensemble]") {
    auto a = good_oscillators();
    options o;
    o.phases = 2;
    o.record.states = {complete::x};
    auto report = solve<cash_karp>(one_thread, a, o);
    auto b = std::move(a);
    CHECK(a.size() == 0);
    const auto& read = a;
    const auto uses = {
        +[](ensemble<complete>& e) { e.state(complete::x) = 1; },
        +[](ensemble<complete>& e) { e.parameter(complete::rate) = 1; },
        +[](ensemble<complete>& e) { e.accessory(complete::peak) = 1; },
        +[](ensemble<complete>& e) { e.integer_accessory(complete::turns) = 1; },
        +[](ensemble<complete>& e) { e.shared(complete::scale) = 1; },
        +[](ensemble<complete>& e) { e.shared_integer(complete::sign) = 1; },
        +[](ensemble<complete>& e) { e.t_begin() = 1; },
        +[](ensemble<complete>& e) { e.t_end() = 1; },
        +[](ensemble<complete>& e) { e.tolerance_scale() = 1; },
        +[](ensemble<complete>& e) { e.t(); },
        +[](ensemble<complete>& e) { e.phases_done(); },
        +[](ensemble<complete>& e) { e.next_step(); },
        +[](ensemble<complete>& e) { e.status(0); },
        +[](ensemble<complete>& e) { solve<cash_karp>(one_thread, e); },
    };
    for (auto* const use : uses) refused([&] { use(a); }, {"this ensemble was moved away"});
    refused([&] { read.state(complete::x); }, {"this ensemble was moved away"});
    CHECK_FALSE(a.counted());
    a.restart();
    const auto records = std::move(report.records);
    refused([&] { report.records.state(complete::x); }, {"these records were moved away"});
    CHECK(records.state(complete::x).cols() == 2);
    a = std::move(b);
    CHECK(a.size() == 5);
    CHECK(b.size() == 0);
    a = ensemble<complete>(3);
    CHECK(a.state(complete::x).size() == 3);
}

TEST_CASE("an ensemble that is being integrated is refused to a second call, from another thread or from progress",
          "[ensemble]") {
    auto e = good_decays(1000), expected = good_decays(1000);
    solve<cash_karp>(one_thread, expected);
    bool tried = false;
    options o;
    o.progress = [&](std::int64_t, std::int64_t) {
        if (std::exchange(tried, true)) return;
        std::thread([&] { refused([&] { solve<cash_karp>(one_thread, e); }, {"is being integrated already"}); }).join();
        refused([&] { solve<cash_karp>(one_thread, e); }, {"is being integrated already", "an ensemble of its own"});
    };
    solve<cash_karp>(one_thread, e, o);
    CHECK(tried);
    CHECK((e.phases_done() == 1).all());
    CHECK((e.state(bare::x) == expected.state(bare::x)).all());
    o.progress = [](std::int64_t, std::int64_t) { throw std::runtime_error("enough"); };
    CHECK_THROWS_AS(solve<cash_karp>(one_thread, e, o), std::runtime_error);
    refused([&] { solve<cash_karp>(one_thread, e, options{.max_steps = -1}); }, {"max_steps"});
    CHECK(solve<cash_karp>(one_thread, e).count(status::success) == 1000);  // no turn was skipped
}

TEST_CASE("phases that would be more than an instance can count are refused until restart", "[ensemble]") {
    auto e = good_decays(3);
    constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
    const_cast<std::int32_t*>(e.phases_done().data())[1] = most - 5;  // as after billions of phases
    myriad::host::ensemble_access::data(e).expect_phases(most - 5);
    myriad::host::ensemble_access::data(e).untouched = false;  // so that a GPU receives it
    options o;
    o.phases = 3;
    solve<cash_karp>(one_thread, e, o);
    CHECK(e.phases_done()[1] == most - 2);
    refused([&] { solve<cash_karp>(one_thread, e, o); },
            {"3 phases are asked for after 2147483645", "2147483647", "restart()"});
    CHECK(e.phases_done()[1] == most - 2);
    e.restart();
    CHECK(solve<cash_karp>(one_thread, e, o).count(status::success) == 3);
    for (int turn = 0; turn < 10; ++turn)
        myriad::host::ensemble_access::data(e).expect_phases(1'000'000'000);  // none of which were done by instances
                                                                              // that have ended
}

TEST_CASE("an ensemble that was moved keeps its memory", "[ensemble]") {
    auto a = good_decays(9);
    const double* const data = a.state(bare::x).data();
    auto b = std::move(a);
    CHECK(b.size() == 9);
    CHECK(b.state(bare::x).data() == data);
    CHECK(solve<cash_karp>(one_thread, b).count(status::success) == 9);
}

TEST_CASE("enumerators that a model inherits name its components, beside an enumeration declared anew as numbers",
          "[ensemble]") {
    struct stronger : complete {
        enum shared { strength = complete::n_shared, n_shared };
    };
    ensemble<stronger> e(3);
    e.state(stronger::v) = 2;
    e.shared_integer(stronger::sign) = -1;
    e.shared(stronger::strength) = 5;
    e.shared(int(stronger::scale)) = 7;
    CHECK(e.state(1)[2] == 2);
    CHECK(e.shared_integer(0) == -1);
    CHECK(e.shared(1) == 5);
    CHECK(e.shared(0) == 7);
}

TEST_CASE("component indices out of range are refused", "[ensemble]") {
    ensemble<complete> e(3);
    refused([&] { e.state(2); }, {"state 2 does not exist", "the model has 2", "enumerators"});
    refused([&] { e.state(-1); }, {"state -1 does not exist"});
    refused([&] { std::as_const(e).state(2); }, {"state 2 does not exist"});
    refused([&] { e.parameter(2); }, {"parameter 2 does not exist", "the model has 2"});
    refused([&] { e.accessory(2); }, {"accessory 2 does not exist"});
    refused([&] { e.integer_accessory(3); }, {"integer accessory 3 does not exist", "the model has 3"});
    refused([&] { e.shared(1); }, {"shared parameter 1 does not exist", "the model has 1"});
    refused([&] { e.shared_integer(1); }, {"shared integer 1 does not exist"});
    refused([&] { e.status(3); }, {"instance 3 does not exist", "has 3 instances"});
    refused([&] { e.status(-1); }, {"instance -1 does not exist"});
    refused([&] { e.state(std::int64_t{1} << 32); }, {"does not exist"});  // its lower half is 0
    ensemble<watched> w(3);
    refused([&] { w.accessory(0); }, {"accessory 0 does not exist", "the model has 0"});
    refused([&] { w.shared(0); }, {"shared parameter 0 does not exist", "the model has 0"});
}

TEST_CASE("records and samples that were not chosen are refused", "[ensemble]") {
    auto e = good_decays();
    options o;
    o.phases = 2;
    o.record.states = {bare::w};
    const auto report = solve<cash_karp>(one_thread, e, o);
    CHECK(report.records.phases() == 2);
    CHECK(report.records.state(bare::w).rows() == 5);
    CHECK(report.records.state(bare::w).cols() == 2);
    CHECK(report.records.state(bare::w)(3, 1) == e.state(bare::w)[3]);
    refused([&] { report.records.state(bare::x); }, {"state 0 was not recorded", "options::record"});
    refused([&] { report.records.state(2); }, {"state 2 was not recorded"});
    refused([&] { report.records.accessory(0); }, {"accessory 0 was not recorded"});
    refused([&] { report.records.time(); }, {"time", "was not recorded"});
    refused([&] { e.samples().state(bare::x); }, {"state 0 was not sampled", "options::samples.states"});
}

TEST_CASE("restart lets every instance begin again, failed ones too", "[ensemble]") {
    auto e = good_decays(20);
    e.parameter(bare::rate)[4] = 1e308;
    e.state(bare::x)[4] = 1e10;
    solve<cash_karp>(one_thread, e);
    REQUIRE(e.status(4) == status::not_finite);
    CHECK(e.ended(4));
    CHECK(e.phases_done()[4] == 0);
    CHECK(e.phases_done()[5] == 1);

    const auto again = good_decays(20);
    e.parameter(bare::rate) = again.parameter(bare::rate);
    e.state(bare::x) = again.state(bare::x);
    e.state(bare::w) = again.state(bare::w);
    e.restart();
    for (std::int64_t i = 0; i < 20; ++i) {
        CHECK(e.status(i) == status::not_started);
        CHECK_FALSE(e.ended(i));
    }
    CHECK((e.phases_done() == 0).all());
    CHECK((e.accepted_steps() == 0).all());

    auto fresh = good_decays(20);
    solve<cash_karp>(one_thread, e);
    const auto report = solve<cash_karp>(one_thread, fresh);
    CHECK(report.count(status::success) == 20);
    CHECK((e.state(bare::x) == fresh.state(bare::x)).all());
    CHECK((e.state(bare::w) == fresh.state(bare::w)).all());
    CHECK((e.accepted_steps() == fresh.accepted_steps()).all());
    CHECK((e.rhs_evaluations() == fresh.rhs_evaluations()).all());
}

TEST_CASE("a failed instance that is given new inputs does not stay failed in silence: the call says restart",
          "[ensemble]") {
    auto e = good_decays(20);
    const auto fresh = good_decays(20);
    e.parameter(bare::rate)[4] = 1e308;
    e.state(bare::x)[4] = 1e10;
    options o;
    solve<cash_karp>(one_thread, e, o);
    REQUIRE(e.status(4) == status::not_finite);

    // Reading through maps that could be written to, and setting another domain, change no input of the failed
    // instance.
    REQUIRE(e.state(bare::x).isFinite().all());
    e.time_domain(0, 2);
    const auto again = solve<cash_karp>(one_thread, e, o);
    CHECK(again.first_failed == 4);
    CHECK(again.first_t_end == 1);  // of the failed run
    CHECK(again.first_parameter == std::vector<double>{1e308});

    e.parameter(bare::rate)[4] = 0.5;
    refused([&] { solve<cash_karp>(one_thread, e, o); },
            {"instance 4 ended in an earlier call (not_finite)", "set anew since: ", "restart()"});
    e.parameter(bare::rate) = fresh.parameter(bare::rate);
    e.state(bare::x) = fresh.state(bare::x);
    e.state(bare::w) = fresh.state(bare::w);
    auto moved = std::move(e);
    refused([&] { solve<cash_karp>(one_thread, moved, o); }, {"instance 4 ended in an earlier call", "restart()"});
    CHECK((moved.state(bare::x) == 1).all());

    o.invalid_instances = myriad::invalid_instances::mark;
    const auto marked = solve<cash_karp>(one_thread, moved, o);
    CHECK(marked.count(status::success) == 19);
    CHECK(marked.first_failed == 4);
    CHECK(marked.first_state.empty());
    CHECK(marked.first_parameter.empty());
    REQUIRE(marked.notes.size() == 1);
    CHECK(marked.notes[0].text().find("1 instance that ended in earlier calls took no part") == 0);
    std::ostringstream text;
    text << marked;
    CHECK(text.str().find("instance 4 ended as not_finite") != std::string::npos);
    CHECK(text.str().find("; its state or parameters were set anew since\n") != std::string::npos);

    o.invalid_instances = myriad::invalid_instances::refuse;
    moved.restart();
    CHECK(solve<cash_karp>(one_thread, moved, o).count(status::success) == 20);
}

TEST_CASE("restart keeps states, parameters and accessories, and forgets the step and the side of events",
          "[ensemble]") {
    auto e = good_oscillators(10), fresh = good_oscillators(10);
    options o;
    o.phase_step = myriad::phase_step::carry_on;
    solve<cash_karp>(one_thread, e, o);
    CHECK((e.integer_accessory(complete::finished) == 1).all());
    CHECK((e.integer_accessory(complete::turns) > 0).all());
    e.restart();
    CHECK((e.integer_accessory(complete::finished) == 1).all());
    e.state(complete::x) = fresh.state(complete::x);
    e.state(complete::v) = fresh.state(complete::v);
    solve<cash_karp>(one_thread, e, o);
    solve<cash_karp>(one_thread, fresh, o);
    CHECK((e.state(complete::x) == fresh.state(complete::x)).all());
    CHECK((e.accessory(complete::peak) == fresh.accessory(complete::peak)).all());
    CHECK((e.integer_accessory(complete::turns) == fresh.integer_accessory(complete::turns)).all());
    CHECK((e.integer_accessory(complete::finished) == 2).all());
    CHECK((e.accepted_steps() == fresh.accepted_steps()).all());
}

TEST_CASE("a domain for all instances takes no memory until single ones are asked for") {
    myriad::ensemble<bare> e(100);
    e.time_domain(1, 3);
    CHECK(e.has_common_domain());
    CHECK(e.t_begin_of(7) == 1);
    CHECK(e.t_end_of(99) == 3);
    e.t_end()(5) = 4;
    CHECK_FALSE(e.has_common_domain());
    CHECK((e.t_begin() == 1).all());
    CHECK(e.t_end()(4) == 3);
    CHECK(e.t_end_of(5) == 4);
    e.time_domain(0, 2);
    CHECK((e.t_begin() == 0).all());
    CHECK((e.t_end() == 2).all());
}

TEST_CASE("a common domain gives the bits of the same domains set one by one") {
    const auto solved = [](auto&& set) {
        myriad::ensemble<bare> e(100);
        e.state(0) = Eigen::ArrayXd::LinSpaced(100, 1, 2);
        e.state(1) = 0.5;
        e.parameter(0) = 0.5;
        set(e);
        myriad::solve<myriad::runge_kutta_4>(tests::test_device(), e, {.phases = 2, .step = 0.01});
        std::vector<double> end(e.state(0).begin(), e.state(0).end());
        end.insert(end.end(), e.t().begin(), e.t().end());
        return end;
    };
    CHECK(solved([](auto& e) { e.time_domain(0.5, 2.25); }) == solved([](auto& e) {
              e.t_begin() = 0.5;
              e.t_end() = 2.25;
          }));
}

}  // namespace
