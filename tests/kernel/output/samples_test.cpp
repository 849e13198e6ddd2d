// SPDX-License-Identifier: MIT
// Which samples dense output stores: times, steps, spacing, components, and no more than fit.
#include <algorithm>
#include <limits>

#include "tests/kernel/output/sampling.hpp"
#include "tests/support/prepared.hpp"

using namespace output;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <class R>
void check_evenly(double span) {
    each_dense_method([&]<class Dense, class Method> {
        auto e = curves<R>(span);
        const auto start = ensemble<curve, R>(curves<R>(span));
        options o = evenly(13);
        o.relative_tolerance = o.absolute_tolerance = 1e-5;
        solve<Dense>(tests::test_device(1), e, o);
        REQUIRE((e.samples().stored() == 13).all());
        const auto t = e.samples().time();
        for (std::int64_t i = 0; i < e.size(); ++i) {
            const double begin = static_cast<double>(e.t_begin()[i]), end = static_cast<double>(e.t_end()[i]);
            for (int k = 0; k < 13; ++k) {
                // two roundings: of k / 12 and of the sum
                const double off = std::abs(static_cast<double>(t(i, k)) - (begin + k * (end - begin) / 12));
                CHECK(off <= 1.5 * eps_of<R> * std::max(std::abs(begin), std::abs(end)));
            }
            // both ends exactly, in time and in state
            CHECK(t(i, 0) == e.t_begin()[i]);
            CHECK(t(i, 12) == e.t_end()[i]);
            for (int c = 0; c < curve::n_state; ++c) {
                CHECK(e.samples().state(c)(i, 0) == start.state(c)[i]);
                CHECK(e.samples().state(c)(i, 12) == e.state(c)[i]);
            }
            // Twenty-odd steps with errors below 1e-5 each, which grow by less than e^2 (problems.hpp: u, w in [1/e,
            // e]); fixed steps of 1/64 are far better, and rounding adds some eps in every step.
            CHECK(distance(e, i) <= 30 * 7.4 * (1e-5 + eps_of<R>));
        }
    });
}

}  // namespace

TEST_CASE("evenly spaced samples divide every instance's own domain, both ends included", "[output]") {
    check_evenly<double>(1);
}
TEST_CASE("evenly spaced samples are taken backwards in time too", "[output]") { check_evenly<double>(-1); }
TEST_CASE("evenly spaced samples divide the domain in single precision", "[output]") {
    check_evenly<float>(1);
    check_evenly<float>(-1);
}

TEST_CASE("samples at given times have exactly these times and lie on the solution", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        for (const double direction : {1.0, -1.0}) {
            auto e = curves(direction);
            e.t_begin() = direction > 0 ? 0.25 : 1.25;
            e.t_end() = direction > 0 ? 1.25 : 0.25;
            for (std::int64_t i = 0; i < e.size(); ++i)
                for (int c = 0; c < curve::n_state; ++c) e.state(c)[i] = curve::exact(e.t_begin()[i])[c];
            // at the start, close together, many in a step, at the end
            std::vector<double> times = {0.25, 0.25 + 1e-14, 0.3, 0.300001, 0.301, 0.9, 0.99, 1.25};
            if (direction < 0) std::reverse(times.begin(), times.end());
            options o = evenly(2);
            o.samples.evenly = 0;
            o.samples.times = times;
            o.samples.capacity = 20;
            solve<Dense>(tests::test_device(1), e, o);
            CHECK((e.samples().stored() == 8).all());
            for (std::int64_t i = 0; i < e.size(); ++i) {
                for (int k = 0; k < 8; ++k) CHECK(e.samples().time()(i, k) == times[static_cast<std::size_t>(k)]);
                CHECK(distance(e, i) <= 40 * 7.4 * 1e-6);  // forty steps, grown by e^2 at most
                CHECK(std::isnan(e.samples().time()(i, 8)));
                CHECK(std::isnan(e.samples().state(curve::w)(i, 19)));
            }
        }
    });
}

TEST_CASE("a sample time equal to the end of a float domain is inside it", "[output]") {
    auto e = curves<float>();
    e.t_begin() = 0.25f;
    e.t_end() = 0.7f;  // less than 0.7
    options o = evenly(2);
    o.samples.evenly = 0;
    o.samples.times = {0.5, 0.7};
    solve<dense<cash_karp>>(tests::test_device(1), e, o);
    CHECK((e.samples().stored() == 2).all());
    CHECK(e.samples().time()(0, 1) == 0.7f);
    CHECK(e.samples().state(curve::u)(0, 1) == e.state(curve::u)[0]);
}

TEST_CASE("sample times that are one and the same in single precision are refused", "[output]") {
    auto e = curves<float>();
    options o = evenly(2);
    o.samples.evenly = 0;
    o.samples.times = {1.4, 1.4 + 1e-9};
    std::string said;
    try {
        solve<dense<cash_karp>>(tests::test_device(1), e, o);
    } catch (const myriad::error& problem) {
        said = problem.what();
    }
    CHECK(said.find("samples.times[1]") != std::string::npos);
    CHECK(said.find("single precision") != std::string::npos);
}

TEST_CASE("samples by steps hold the start and the end of every accepted step", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        auto e = curves();
        const auto start = curves();
        solve<Dense>(tests::test_device(1), e, by_steps(1, 200));
        for (std::int64_t i = 0; i < e.size(); ++i) {
            const int n = e.samples().stored()[i];
            REQUIRE(n == e.accepted_steps()[i] + 1);
            CHECK(e.samples().time()(i, 0) == e.t_begin()[i]);
            CHECK(e.samples().time()(i, n - 1) == e.t_end()[i]);
            for (int c = 0; c < curve::n_state; ++c) {
                CHECK(e.samples().state(c)(i, 0) == start.state(c)[i]);
                CHECK(e.samples().state(c)(i, n - 1) == e.state(c)[i]);
            }
            for (int k = 1; k < n; ++k) CHECK(e.samples().time()(i, k) > e.samples().time()(i, k - 1));
        }
    });
}

TEST_CASE("samples by every n-th step are every n-th of those by every step", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        auto all = curves(), some = curves();
        solve<Dense>(tests::test_device(1), all, by_steps(1, 200));
        solve<Dense>(tests::test_device(1), some, by_steps(3, 200));
        for (std::int64_t i = 0; i < all.size(); ++i) {
            const int n = some.samples().stored()[i];
            REQUIRE(n == all.accepted_steps()[i] / 3 + 1);
            for (int k = 0; k < n; ++k) {
                CHECK(some.samples().time()(i, k) == all.samples().time()(i, 3 * k));
                CHECK(some.samples().state(curve::w)(i, k) == all.samples().state(curve::w)(i, 3 * k));
            }
        }
    });
}

TEST_CASE("samples by steps keep the minimum spacing and no more than a step beyond it", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        for (const double direction : {1.0, -1.0}) {
            auto all = curves(direction), some = curves(direction);
            solve<Dense>(tests::test_device(1), all, by_steps(1, 200));
            options o = by_steps(1, 200);
            o.samples.minimum_spacing = 0.2;
            solve<Dense>(tests::test_device(1), some, o);
            for (std::int64_t i = 0; i < all.size(); ++i) {
                double longest = 0;
                for (int k = 1; k < all.samples().stored()[i]; ++k)
                    longest = std::max(longest, std::abs(all.samples().time()(i, k) - all.samples().time()(i, k - 1)));
                const int n = some.samples().stored()[i];
                REQUIRE(n >= 2);
                REQUIRE(n < all.samples().stored()[i]);
                for (int k = 1; k < n; ++k) {
                    const double gap = std::abs(some.samples().time()(i, k) - some.samples().time()(i, k - 1));
                    CHECK(gap >= 0.2);
                    CHECK(gap < 0.2 + longest);
                }
            }
        }
    });
}

TEST_CASE("chosen components are sampled as they are among all", "[output]") {
    auto all = curves(), one = curves();
    solve<dense<tsitouras_5>>(tests::test_device(1), all, evenly(9));
    options o = evenly(9);
    o.samples.states = {curve::w};
    solve<dense<tsitouras_5>>(tests::test_device(1), one, o);
    CHECK(compare::same_bits_everywhere(all.samples().state(curve::w), one.samples().state(curve::w)));
    CHECK_THROWS_AS(one.samples().state(curve::u), myriad::error);
}

TEST_CASE("a full trajectory takes no more samples, says how many it has, and is integrated to its end", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        auto ample = curves(), tight = curves();
        solve<Dense>(tests::test_device(1), ample, by_steps(1, 200));
        solve<Dense>(tests::test_device(1), tight, by_steps(1, 5));
        REQUIRE((ample.accepted_steps() > 5).all());
        CHECK(tight.samples().capacity() == 5);
        CHECK((tight.samples().stored() == 5).all());
        CHECK(compare::same_bits_everywhere(tight.samples().time(), ample.samples().time().leftCols(5)));
        CHECK(compare::same_bits_everywhere(tight.samples().state(0), ample.samples().state(0).leftCols(5)));
        CHECK(compare::difference(ample, tight) == "");
    });
}

TEST_CASE("samples of further phases and calls stop at the capacity", "[output]") {
    auto e = curves();
    options o = by_steps(1, 20);
    for (int call = 0; call < 3; ++call) solve<dense<tsitouras_5>>(tests::test_device(1), e, o);
    REQUIRE((e.accepted_steps() >= 20).all());
    CHECK((e.samples().stored() == 20).all());
}

TEST_CASE("nothing is written beyond the arrays of the samples", "[output]") {
    // The kernel itself, on arrays with a guard on both sides.
    constexpr std::int64_t size = 19, capacity = 4, guard = 64;
    constexpr double pattern = -12345.678;
    for (const bool steps : {true, false}) {
        auto e = curves(1, size);
        options o = by_steps(1, capacity);
        auto call = tests::prepare<dense<cash_karp>>(e, o);
        auto& arguments = call.arguments();
        std::vector<double> time(capacity * size + 2 * guard, pattern),
            values(2 * capacity * size + 2 * guard, pattern);
        std::vector<std::int32_t> stored(size + 2 * guard, -7);
        std::fill_n(stored.begin() + guard, size, 0);
        arguments.sample.time = time.data() + guard;
        arguments.sample.values = values.data() + guard;
        arguments.sample.stored = stored.data() + guard;
        arguments.sample.capacity = capacity;
        arguments.sample.every = steps ? 1 : 0;
        arguments.sample.count = 100;  // far more than fit
        call.sample_columns()[0] = 0;
        call.sample_columns()[1] = 1;
        myriad::openmp::run<curve, dense<cash_karp>, double>(arguments, {});
        const auto untouched = [](const auto& array, auto value) {
            return std::all_of(array.begin(), array.begin() + guard, [&](auto x) { return x == value; }) &&
                   std::all_of(array.end() - guard, array.end(), [&](auto x) { return x == value; });
        };
        CHECK(untouched(time, pattern));
        CHECK(untouched(values, pattern));
        CHECK(untouched(stored, -7));
        CHECK(std::all_of(stored.begin() + guard, stored.end() - guard, [](int n) { return n == capacity; }));
        // and all within is written
        CHECK(std::count(time.begin(), time.end(), pattern) == 2 * guard);
        CHECK(std::count(values.begin(), values.end(), pattern) == 2 * guard);
    }
}

TEST_CASE("phases in one call and in several give the same samples", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        for (const double length : {0.0, 0.5}) {
            for (const std::int64_t every : {0, 2}) {
                options o = every == 0 ? evenly(5, 4) : by_steps(every, 300);
                o.phase_length = length;
                o.phases = 4;
                auto at_once = curves(), split = curves();
                if (length > 0) {
                    at_once.t_end() = std::numeric_limits<double>::infinity();
                    split.t_end() = at_once.t_end();
                }
                solve<Dense>(tests::test_device(1), at_once, o);
                o.phases = 1;
                for (int call = 0; call < 4; ++call) solve<Dense>(tests::test_device(1), split, o);
                CAPTURE(every, length);
                CHECK(same_samples(at_once, split));
                if (every == 0) CHECK((at_once.samples().stored() == (length == 0 ? 20 : 17)).all());
                if (every == 0 && length > 0) {  // the sample between two phases is stored once
                    for (int k = 0; k < 17; ++k)
                        CHECK((at_once.samples().time().col(k) - at_once.t_begin() - 0.125 * k).abs().maxCoeff() <
                              1e-15 * 64);
                }
            }
        }
    });
}

TEST_CASE("phases before from_phase are not sampled", "[output]") {
    auto all = curves(), late = curves();
    options o = evenly(5, 3);
    solve<dense<cash_karp>>(tests::test_device(1), all, o);
    o.samples.from_phase = 2;
    solve<dense<cash_karp>>(tests::test_device(1), late, o);
    CHECK((late.samples().stored() == 5).all());
    CHECK(compare::same_bits_everywhere(late.samples().time().leftCols(5), all.samples().time().rightCols(5)));
    CHECK(compare::same_bits_everywhere(late.samples().state(1).leftCols(5), all.samples().state(1).rightCols(5)));
}

TEST_CASE("restart forgets the samples", "[output]") {
    auto e = curves();
    options o = evenly(5);
    solve<dense<cash_karp>>(tests::test_device(1), e, o);
    e.restart();
    CHECK((e.samples().stored() == 0).all());
    CHECK(std::isnan(e.samples().time()(0, 0)));
    CHECK(std::isnan(e.samples().state(0)(0, 0)));
}

TEST_CASE("sampling changes no bit of the results and costs at most the last evaluation of a phase", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        for (const std::int64_t every : {0, 1}) {
            auto plain = curves(), sampled = curves();
            options o = every == 0 ? evenly(101) : by_steps(every, 200);
            solve<Dense>(tests::test_device(1), sampled, o);
            o.samples = {};
            solve<Method>(tests::test_device(1), plain, o);
            for (std::int64_t i = 0; i < plain.size(); ++i) {
                CHECK(plain.state(0)[i] == sampled.state(0)[i]);
                CHECK(plain.state(1)[i] == sampled.state(1)[i]);
                CHECK(plain.accepted_steps()[i] == sampled.accepted_steps()[i]);
                CHECK(plain.rejected_steps()[i] == sampled.rejected_steps()[i]);
                // The slope at the end of a step, which the Hermite polynomial needs and a stiff method's interpolant
                // does not, is the first of the next step, and is kept for a repeated one.
                constexpr bool is_stiff = requires { Method::tableau().coupling; };
                const std::int64_t kept = Method::first_same_as_last || is_stiff ? 0 : plain.rejected_steps()[i];
                CHECK(sampled.rhs_evaluations()[i] - plain.rhs_evaluations()[i] + kept >= 0);
                CHECK(sampled.rhs_evaluations()[i] - plain.rhs_evaluations()[i] + kept <= 1);
            }
        }
    });
}

TEST_CASE("samples do not depend on threads or on the ensemble's size", "[output]") {
    auto one = curves(1, 203), two = curves(1, 203), few = curves(1, 19);
    for (const std::int64_t every : {0, 2}) {
        const options o = every == 0 ? evenly(17) : by_steps(every, 40);
        ensemble<curve> a = curves(1, 203), b = curves(1, 203), c = curves(1, 19);
        solve<dense<tsitouras_5>>(tests::test_device(1), a, o);
        solve<dense<tsitouras_5>>(tests::test_device(2), b, o);
        solve<dense<tsitouras_5>>(tests::test_device(1), c, o);
        CHECK(same_samples(a, b));
        CHECK(compare::same_bits_everywhere(a.samples().state(0).topRows(19), c.samples().state(0)));
    }
}

TEST_CASE("an instance that fails keeps the samples before its failure and has NaN after them", "[output]") {
    auto e = curves(), whole = curves();
    solve<dense<cash_karp>>(tests::test_device(1), whole, evenly(21));
    options o = evenly(21);
    o.max_steps = 8;
    solve<dense<cash_karp>>(tests::test_device(1), e, o);
    for (std::int64_t i = 0; i < e.size(); ++i) {
        REQUIRE(e.status(i) == status::max_steps);
        const int n = e.samples().stored()[i];
        REQUIRE(n > 0);
        REQUIRE(n < 21);
        for (int k = 0; k < 21; ++k) {
            if (k < n) {
                CHECK(e.samples().state(0)(i, k) == whole.samples().state(0)(i, k));
                CHECK(e.samples().time()(i, k) <= e.t()[i]);
            } else {
                CHECK(std::isnan(e.samples().time()(i, k)));
                CHECK(std::isnan(e.samples().state(0)(i, k)));
            }
        }
    }
}

TEST_CASE("one instance that was marked invalid has no samples and takes none from the others", "[output]") {
    auto clean = curves(), e = curves();
    e.state(0)[7] = not_a_number;
    options o = evenly(9);
    o.invalid_instances = myriad::invalid_instances::mark;
    solve<dense<cash_karp>>(tests::test_device(1), clean, o);
    solve<dense<cash_karp>>(tests::test_device(1), e, o);
    for (std::int64_t i = 0; i < e.size(); ++i) {
        CHECK(e.samples().stored()[i] == (i == 7 ? 0 : 9));
        for (int k = 0; k < 9 && i != 7; ++k) CHECK(e.samples().state(1)(i, k) == clean.samples().state(1)(i, k));
    }
}

TEST_CASE("each instance may have sample times of its own", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        for (const double span : {1.0, -1.0}) {
            auto e = curves(span);
            options o = compare::with_tolerance(1e-6);
            o.step = 1.0 / 64;
            o.samples.states = {curve::u, curve::w};
            o.samples.capacity = 3;
            for (std::int64_t i = 0; i < e.size(); ++i)
                for (const double part : {0.0, 0.25 + 0.03 * static_cast<double>(i), 1.0})
                    o.samples.times_of_instances.push_back(part == 1 ? e.t_end()[i] : e.t_begin()[i] + part * span);
            solve<Dense>(tests::test_device(1), e, o);
            CHECK((e.samples().stored() == 3).all());
            for (std::int64_t i = 0; i < e.size(); ++i) {
                for (int k = 0; k < 3; ++k)
                    CHECK(e.samples().time()(i, k) ==
                          o.samples.times_of_instances[static_cast<std::size_t>(3 * i + k)]);
                // the same as a call with these times for all
                auto one = curves(span);
                options common = o;
                common.samples.times = {o.samples.times_of_instances.begin() + 3 * i,
                                        o.samples.times_of_instances.begin() + 3 * i + 3};
                common.samples.times_of_instances.clear();
                for (std::int64_t j = 0; j < one.size(); ++j) {
                    one.t_begin()[j] = e.t_begin()[i];
                    one.t_end()[j] = e.t_end()[i];
                    for (int c = 0; c < 2; ++c) one.state(c)[j] = curve::exact(e.t_begin()[i])[c];
                }
                solve<Dense>(tests::test_device(1), one, common);
                for (int k = 0; k < 3; ++k) CHECK(one.samples().state(0)(i, k) == e.samples().state(0)(i, k));
            }
        }
    });
}

TEST_CASE("sample times of instances that do not fit are refused", "[output]") {
    auto e = curves();
    options o = compare::with_tolerance(1e-6);
    o.samples.states = {curve::u};
    o.samples.capacity = 2;
    const auto message_of = [&] {
        try {
            solve<dense<cash_karp>>(tests::test_device(1), e, o);
        } catch (const myriad::error& what) {
            return std::string(what.what());
        }
        return std::string();
    };
    const auto has = [&](const char* part) { return message_of().find(part) != std::string::npos; };
    o.samples.times_of_instances.assign(20, 0.5);
    CHECK(has("has 20 times for 19 instances"));
    o.samples.times_of_instances.clear();
    for (std::int64_t i = 0; i < e.size(); ++i)
        for (const double part : {0.25, 0.5}) o.samples.times_of_instances.push_back(e.t_begin()[i] + part);
    auto right = o.samples.times_of_instances;
    o.samples.times_of_instances[7] = o.samples.times_of_instances[6];
    CHECK(has("instance 3 are not in order at number 1"));
    o.samples.times_of_instances = right;
    o.samples.times_of_instances[8] = -3;
    CHECK(has("instance 4 is integrated from"));
    o.samples.times_of_instances = right;
    o.samples.capacity = 1;
    CHECK(has("samples.capacity is 1"));
}
