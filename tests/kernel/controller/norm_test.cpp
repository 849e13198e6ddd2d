// SPDX-License-Identifier: MIT
// The size of an error estimate: the scale max(atol, rtol max(|y|, |y1|)) of each component, and non-finite values. A
// model file: it builds trials by hand.
#include "myriad/kernel/controller/norm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "myriad/kernel/scalar/pack_math.hpp"
#include "myriad/methods.hpp"
#include "tests/catch.hpp"
#include "tests/support/problems.hpp"

using myriad::detail::get_lane;
using myriad::detail::set_lane;

namespace {

using model = problems::log_circle;  // two components; its right-hand side is not called
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

struct pair {
    double first, second;
};

/// A trial of cash_karp from `y` to `y1` whose error estimates are the given ones, against the given tolerances.
myriad::detail::error_norm<double> norm_of(pair y, pair y1, pair error, pair atol, pair rtol) {
    myriad::detail::kernel_arguments<model, double> args{};
    args.absolute_tolerance[0] = atol.first;
    args.absolute_tolerance[1] = atol.second;
    args.relative_tolerance[0] = rtol.first;
    args.relative_tolerance[1] = rtol.second;
    const double h = 0.25;
    myriad::detail::trial_step<myriad::cash_karp, double, 2> trial{};
    trial.k[0] = {error.first / (h * myriad::cash_karp::tableau().e[0]),
                  error.second / (h * myriad::cash_karp::tableau().e[0])};
    trial.y = {y1.first, y1.second};
    return myriad::detail::scaled_error<model, myriad::cash_karp>(args, myriad::vec<double, 2>{y.first, y.second}, h,
                                                                  trial);
}

bool accepts(const myriad::detail::error_norm<double>& norm) { return norm.finite && norm.worst <= 1; }

// products and quotients of a few rounded numbers
constexpr double tolerance = 8 * std::numeric_limits<double>::epsilon();

void check_worst(const myriad::detail::error_norm<double>& norm, double expected) {
    CHECK(std::abs(norm.worst / expected - 1) <= tolerance);
    CHECK(accepts(norm) == (expected <= 1));
}

}  // namespace

TEST_CASE("an error is measured against the absolute tolerance where that is the larger") {
    check_worst(norm_of({1, 0}, {1, 0}, {3e-6, 0}, {1e-5, 1e-5}, {1e-9, 1e-9}), 0.3);
    check_worst(norm_of({1, 0}, {1, 0}, {3e-5, 0}, {1e-5, 1e-5}, {1e-9, 1e-9}), 3.0);
}
TEST_CASE(
    "an error is measured against the relative tolerance times the state before the step where that is the larger") {
    check_worst(norm_of({-40, 0}, {20, 0}, {3e-6, 0}, {1e-9, 1e-9}, {1e-6, 1e-6}), 3e-6 / 40e-6);
}
TEST_CASE(
    "an error is measured against the relative tolerance times the state after the step where that is the larger") {
    check_worst(norm_of({20, 0}, {-40, 0}, {3e-6, 0}, {1e-9, 1e-9}, {1e-6, 1e-6}), 3e-6 / 40e-6);
}
TEST_CASE("the two tolerances are not added") {
    check_worst(norm_of({1, 0}, {1, 0}, {1.5e-6, 0}, {1e-6, 1e-6}, {1e-6, 1e-6}), 1.5);
}
TEST_CASE("the largest ratio of the components counts, whichever it is and whatever its sign") {
    check_worst(norm_of({1, 1}, {1, 1}, {2e-7, -5e-7}, {1e-6, 1e-6}, {1e-9, 1e-9}), 0.5);
    check_worst(norm_of({1, 1}, {1, 1}, {-6e-7, 5e-7}, {1e-6, 1e-6}, {1e-9, 1e-9}), 0.6);
}
TEST_CASE("every component has its own tolerances") {
    check_worst(norm_of({1, 1}, {1, 1}, {2e-7, 2e-7}, {1e-6, 1e-8}, {1e-9, 1e-9}), 20);
    check_worst(norm_of({1, 1}, {1, 1}, {2e-7, 2e-7}, {1e-8, 1e-6}, {1e-9, 1e-9}), 20);
    check_worst(norm_of({1, 1}, {1, 1}, {2e-7, 2e-7}, {1e-12, 1e-12}, {1e-6, 1e-8}), 20);
}
TEST_CASE("a step without any error is accepted") {
    const auto norm = norm_of({1, 1}, {1, 1}, {0, 0}, {1e-6, 1e-6}, {1e-6, 1e-6});
    CHECK(norm.worst == 0.0);
    CHECK(accepts(norm));
}
TEST_CASE("a step whose error is NaN in one component is not accepted") {
    CHECK_FALSE(accepts(norm_of({1, 1}, {1, 1}, {not_a_number, 0}, {1e-6, 1e-6}, {1e-6, 1e-6})));
    CHECK_FALSE(accepts(norm_of({1, 1}, {1, 1}, {0, not_a_number}, {1e-6, 1e-6}, {1e-6, 1e-6})));
}
TEST_CASE("a step to a state that is not finite is not accepted") {
    for (const double bad : {not_a_number, infinity, -infinity}) {
        CHECK_FALSE(accepts(norm_of({1, 1}, {bad, 1}, {0, 0}, {1e-6, 1e-6}, {1e-6, 1e-6})));
        CHECK_FALSE(accepts(norm_of({1, 1}, {1, bad}, {0, 0}, {1e-6, 1e-6}, {1e-6, 1e-6})));
        // an infinite error over an infinite scale is no number, and a finite one over it would be zero
        CHECK_FALSE(accepts(norm_of({1, 1}, {1, bad}, {0, 1}, {1e-6, 1e-6}, {1e-6, 1e-6})));
    }
}
TEST_CASE("in a pack, the largest ratio is NaN in the lanes where one component's is, and in no others") {
    using pack = myriad::pack<double, 2>;
    for (int bad = 0; bad < 3; ++bad) {
        for (int lane = 0; lane < pack::lanes; ++lane) {
            myriad::vec<pack, 3> ratio{pack(0.5), pack(2.0), pack(0.25)};
            set_lane(ratio[bad], lane, not_a_number);
            const pack largest = myriad::detail::largest_ratio<myriad::cash_karp, 3>(ratio);
            for (int i = 0; i < pack::lanes; ++i) {
                const double found = get_lane(largest, i);
                CHECK((i == lane ? std::isnan(found) : found == 2.0));
            }
        }
    }
}
TEST_CASE("an infinite error is not accepted") {
    CHECK_FALSE(accepts(norm_of({1, 1}, {1, 1}, {infinity, 0}, {1e-6, 1e-6}, {1e-6, 1e-6})));
}

TEST_CASE("the combined estimate of dormand_prince_8 falls with the step to the eighth power") {
    using method = myriad::dormand_prince_8;
    myriad::detail::kernel_arguments<model, double> args{};
    for (int c = 0; c < 2; ++c) args.absolute_tolerance[c] = 1e-6;
    const auto worst = [&](double h) {
        const myriad::inputs<model, double> p{};
        const myriad::vec<double, 2> y = model::exact(0.5);
        myriad::detail::trial_step<method, double, 2> trial;
        trial.k[0] = myriad::detail::evaluate_rhs<model>(0.5, y, p);
        myriad::detail::explicit_rk_step<method, model>(0.5, h, 0.5 + h, y, p, trial);
        return myriad::detail::scaled_error<model, method>(args, y, h, trial).worst;
    };
    // e5 ~ h^6 and e3 ~ h^4, so e5^2 / e3 ~ h^8 (1 + O(h))
    for (const double h : {0.125, -0.125}) CHECK(std::abs(std::log2(worst(h) / worst(h / 2)) - 8) < 0.3);
}

TEST_CASE("two estimates are combined as in DOP853, and are nothing where the first is") {
    using method = myriad::dormand_prince_8;
    myriad::detail::kernel_arguments<model, double> args{};
    for (int c = 0; c < 2; ++c) args.absolute_tolerance[c] = 1;
    myriad::detail::trial_step<method, double, 2> trial{};
    trial.y = {1.0, 1.0};
    for (const pair k : {pair{3, 0}, pair{-5, 4}, pair{0, 0}, pair{1e200, 0}}) {
        trial.k[0] = {k.first, k.second};
        trial.k[8] = {k.second, k.first};
        const auto size = [&](const auto& weight) {
            double d = 0;
            for (int c = 0; c < 2; ++c)
                d = std::max(d, std::abs(weight(0) * trial.k[0][c] + weight(8) * trial.k[8][c]));
            return d;
        };
        const double e5 = size([](int i) { return method::tableau().e[static_cast<std::size_t>(i)]; });
        const double e3 = size([](int i) { return method::coarse_error_weight(i); });
        const auto norm = myriad::detail::scaled_error<model, method>(args, {1.0, 1.0}, 1.0, trial);
        const double expected = e5 == 0 ? 0 : e5 * (e5 / std::hypot(e5, 0.1 * e3));
        CHECK(std::abs(norm.worst - expected) <= 2 * tolerance * expected);
        CHECK(accepts(norm) == (expected <= 1));
    }
    trial.y[1] = infinity;
    CHECK_FALSE(accepts(myriad::detail::scaled_error<model, method>(args, {1.0, 1.0}, 1.0, trial)));
}
