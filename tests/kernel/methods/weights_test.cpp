// SPDX-License-Identifier: MIT
// The kernels' weights: in single precision the order conditions that determine every step's error are preserved.
#include "myriad/kernel/methods/weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "myriad/kernel/stepper/step.hpp"
#include "myriad/methods.hpp"
#include "tests/catch.hpp"

namespace {

constexpr double rounding = std::numeric_limits<float>::epsilon() / 2;

/// The sums of weights, of their absolute values, and of weights times nodes, of a row.
struct sums {
    double weights = 0, absolute = 0, moments = 0;
};

/// The sum of a row of an explicit method; row 0 has none. `nodes` are those of the rows before it.
template <class Method, int row, class R, std::size_t stages>
sums sums_of(const std::array<double, stages>& nodes) {
    sums s;
    myriad::detail::static_for<myriad::detail::first_stage<Method, row>, Method::stages>([&](auto j) {
        constexpr int stage = decltype(j)::value;
        const double w = static_cast<double>(myriad::detail::first_weight<Method, row, R>) *
                         static_cast<double>(myriad::detail::relative_weight<Method, row, stage, R>);
        s.weights += w;
        s.absolute += std::abs(w);
        s.moments += w * nodes[static_cast<std::size_t>(stage)];
    });
    return s;
}

template <class Method>
void check_explicit() {
    constexpr auto stages = static_cast<std::size_t>(Method::stages);
    std::array<double, stages> nodes{};
    myriad::detail::static_for<1, Method::stages>([&](auto i) {
        constexpr int row = decltype(i)::value;
        const sums of_row = sums_of<Method, row, float>(nodes);
        const double node = of_row.weights;
        CAPTURE(row);
        CHECK(std::abs(node - Method::tableau().c[static_cast<std::size_t>(row)]) <=
              std::max(4.0, of_row.absolute) * rounding);
        nodes[static_cast<std::size_t>(row)] = node;
    });
    const sums solution = sums_of<Method, Method::stages, float>(nodes);
    CHECK(std::abs(solution.weights - 1) <= rounding / 4);
    CHECK(std::abs(solution.moments - 0.5) <= rounding / 4);
    if constexpr (Method::embedded_order > 0) {
        const sums error = sums_of<Method, Method::stages + 1, float>(nodes);
        CHECK(std::abs(error.weights) <= rounding / 4);
        CHECK(std::abs(error.moments) <= rounding / 4);
    }
}

/// The weights of a Rosenbrock method in float arithmetic: the responses of its stages and its solution to a constant
/// slope, and of its solution to a linear one.
template <class Method>
void check_rosenbrock() {
    constexpr auto stages = static_cast<std::size_t>(Method::stages);
    const double gamma = 1 / static_cast<double>(myriad::detail::reciprocal_gamma<Method, float>);
    std::array<double, stages> constant{}, linear{};
    double node = 0, moment = 0;  // of the argument of a stage, then of the solution
    std::array<double, stages> argument{};
    const auto advance = [&](auto i) {
        constexpr int row = decltype(i)::value, begin = myriad::detail::first_new_stage<Method, row>;
        myriad::detail::static_for<begin, row>([&](auto j) {
            argument[static_cast<std::size_t>(j)] =
                static_cast<double>(myriad::detail::rosenbrock_weight<Method, myriad::detail::rosenbrock_row::argument,
                                                                      row, decltype(j)::value, float>);
        });
        node = moment = 0;
        for (std::size_t j = 0; j < static_cast<std::size_t>(row); ++j) {
            node += argument[j] * constant[j];
            moment += argument[j] * linear[j];
        }
    };
    myriad::detail::static_for<0, Method::stages>([&](auto i) {
        constexpr int stage = decltype(i)::value;
        constexpr auto at = static_cast<std::size_t>(stage);
        if constexpr (stage > 0) advance(i);
        CAPTURE(stage);
        CHECK(std::abs(node - Method::tableau().c[at]) <= 4 * rounding);
        constant[at] = 1;
        myriad::detail::static_for<0, stage>([&](auto j) {
            constant[at] +=
                static_cast<double>(myriad::detail::rosenbrock_weight<Method, myriad::detail::rosenbrock_row::coupling,
                                                                      stage, decltype(j)::value, float>) *
                constant[static_cast<std::size_t>(j)];
        });
        constant[at] *= gamma;
        CHECK(std::abs(constant[at] - Method::tableau().d[at]) <= 4 * rounding);
        linear[at] = node + constant[at];
        myriad::detail::static_for<0, stage>([&](auto j) {
            linear[at] +=
                static_cast<double>(myriad::detail::rosenbrock_weight<Method, myriad::detail::rosenbrock_row::coupling,
                                                                      stage, decltype(j)::value, float>) *
                linear[static_cast<std::size_t>(j)];
        });
        linear[at] *= gamma;
    });
    advance(myriad::detail::constant_index<Method::stages>{});
    CHECK(std::abs(node - 1) <= rounding);
    CHECK(std::abs(moment - 0.5) <= rounding);
}

}  // namespace

TEST_CASE("weights in single precision satisfy the order conditions to two as well as rounding lets them") {
    SECTION("runge_kutta_4") { check_explicit<myriad::runge_kutta_4>(); }
    SECTION("cash_karp") { check_explicit<myriad::cash_karp>(); }
    SECTION("tsitouras_5") { check_explicit<myriad::tsitouras_5>(); }
    SECTION("dormand_prince_5") { check_explicit<myriad::dormand_prince_5>(); }
    SECTION("verner_7") { check_explicit<myriad::verner_7>(); }
    SECTION("verner_9") { check_explicit<myriad::verner_9>(); }
    SECTION("dormand_prince_8") { check_explicit<myriad::dormand_prince_8>(); }
    SECTION("rosenbrock_23") { check_rosenbrock<myriad::rosenbrock_23>(); }
    SECTION("rodas_5p") { check_rosenbrock<myriad::rodas_5p>(); }
}

TEST_CASE("weights in double precision are the tableau's over the first of their row") {
    using method = myriad::tsitouras_5;
    constexpr auto t = method::tableau();
    myriad::detail::static_for<1, method::stages>([&](auto j) {
        constexpr int stage = decltype(j)::value;
        CHECK(myriad::detail::relative_weight<method, method::stages, stage, double> ==
              t.b[static_cast<std::size_t>(stage)] / t.b[0]);
    });
}
