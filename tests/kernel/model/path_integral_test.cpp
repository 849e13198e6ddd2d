// SPDX-License-Identifier: MIT
// Integrals of paths over time: their distribution, the same values whatever the steps, and in packs and plain lanes.

#include "myriad/kernel/model/path_integral.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>

#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::detail::get_lane;
using myriad::detail::parts_of_cell;
using myriad::detail::path_constants_of;
using myriad::detail::path_integrals;
using myriad::detail::path_interval;
using myriad::detail::path_place;

template <class R>
path_interval<R> interval(path_place<R> from, path_place<R> to, std::int64_t instance, R cell = 1) {
    static std::map<R, myriad::detail::path_constants<R>> of_cell;
    path_interval<R> over{from, to, {}, &of_cell.try_emplace(cell, path_constants_of(cell, 1)).first->second};
    over.of.set(0, instance, 0);
    return over;
}
/// A place that is so many parts from the beginning.
template <class R>
path_place<R> place(std::int64_t parts) {
    using number = typename myriad::detail::path_integers<R>::cell;
    const std::int64_t cell = parts >= 0 ? parts / parts_of_cell : -((parts_of_cell - 1 - parts) / parts_of_cell);
    return {static_cast<number>(cell), static_cast<std::int32_t>(parts - cell * parts_of_cell)};
}

}  // namespace

TEMPLATE_TEST_CASE("increments and integrals have the variances and covariances of a Wiener process", "", double,
                   float) {
    using R = TestType;
    // over a cell, its halves, and an interval that begins and ends within cells
    for (const auto& [from, to] : {std::pair{0, 65'536}, {0, 32'768}, {32'768, 65'536}, {20'000, 150'000}}) {
        const double l = static_cast<double>(to - from) / parts_of_cell;
        const int count = 1 << 16;
        double w_w = 0, w_i = 0, i_i = 0, others = 0;
        for (int i = 0; i < count; ++i) {
            const auto found = path_integrals<3>(interval<R>(place<R>(from), place<R>(to), i));
            const auto w = static_cast<double>(found.increment[1]), integral = static_cast<double>(found.integral[1]);
            w_w += w * w, w_i += w * integral, i_i += integral * integral;
            others += static_cast<double>(found.integral[2]) * integral;
        }
        // Four standard deviations of the means of squares, and of products a b: the variance is var a var b + cov^2.
        const double bound = 4 / std::sqrt(count);
        CHECK(w_w / count == Approx(l).epsilon(bound * std::sqrt(2.0)));
        CHECK(i_i / count == Approx(l * l * l / 3).epsilon(bound * std::sqrt(2.0)));
        CHECK(w_i / count == Approx(l * l / 2).epsilon(bound * std::sqrt(7.0 / 3)));
        CHECK(others / count == Approx(0).margin(bound * l * l * l / 3));
    }
}

TEMPLATE_TEST_CASE("the quarters of a cell have no correlation, in increments and integrals", "", double, float) {
    using R = TestType;
    constexpr int count = 1 << 14, quarters = 4, values = 2 * quarters;
    double product[values][values]{};
    for (int i = 0; i < count; ++i) {
        double x[values];  // W and H of each quarter, scaled to unit variance
        for (int k = 0; k < quarters; ++k) {
            const std::int64_t begin = k * (parts_of_cell / quarters);
            const auto found =
                path_integrals<1>(interval<R>(place<R>(begin), place<R>(begin + parts_of_cell / quarters), i));
            const double w = static_cast<double>(found.increment[0]);
            const double h = static_cast<double>(found.integral[0]) * quarters - w / 2;
            x[2 * k] = w * std::sqrt(double{quarters});
            x[2 * k + 1] = h * std::sqrt(12.0 * quarters);
        }
        for (int k = 0; k < values; ++k)
            for (int j = 0; j <= k; ++j) product[k][j] += x[k] * x[j];
    }
    // Within four standard deviations.
    for (int k = 0; k < values; ++k)
        for (int j = 0; j <= k; ++j)
            CHECK(std::fabs(product[k][j] / count - (k == j ? 1 : 0)) < 4 * std::sqrt((k == j ? 2.0 : 1.0) / count));
}

TEMPLATE_TEST_CASE("integrals over parts, in whatever division, are those over the whole", "", double, float) {
    using R = TestType;
    constexpr int count = 5;
    const R cell = R(0.5);
    const std::int64_t begin = -12'345, end = 3 * parts_of_cell + 777;
    const auto whole = path_integrals<count>(interval<R>(place<R>(begin), place<R>(end), 42, cell));
    const auto back = path_integrals<count>(interval<R>(place<R>(end), place<R>(begin), 42, cell));
    for (const std::int64_t length : {4096, 10'000, 32'768, 65'536, 100'000}) {
        double w[count]{}, integral[count]{};
        for (std::int64_t at = begin; at < end; at += length) {
            const std::int64_t to = std::min(at + length, end);
            const auto part = path_integrals<count>(interval<R>(place<R>(at), place<R>(to), 42, cell));
            const double over = static_cast<double>(cell) * static_cast<double>(to - at) / parts_of_cell;
            for (int k = 0; k < count; ++k) {
                integral[k] += over * w[k] + static_cast<double>(part.integral[k]);
                w[k] += static_cast<double>(part.increment[k]);
            }
        }
        for (int k = 0; k < count; ++k) {  // some 100 values near one, each rounded
            const double margin = 200.0 * static_cast<double>(myriad::epsilon_of<R>);
            CHECK(w[k] == Approx(static_cast<double>(whole.increment[k])).margin(margin));
            CHECK(integral[k] == Approx(static_cast<double>(whole.integral[k])).margin(margin));
        }
    }
    // Backwards the integral is that of W(s) - W(end), from the end to the beginning.
    const double over = static_cast<double>(cell) * static_cast<double>(end - begin) / parts_of_cell;
    for (int k = 0; k < count; ++k)
        CHECK(static_cast<double>(back.integral[k]) ==
              Approx(over * static_cast<double>(whole.increment[k]) - static_cast<double>(whole.integral[k]))
                  .margin(100.0 * static_cast<double>(myriad::epsilon_of<R>)));
}

TEMPLATE_TEST_CASE("at the ends of cells the path is that without integrals", "", double, float) {
    using R = TestType;
    const auto over = interval<R>(place<R>(-parts_of_cell), place<R>(2 * parts_of_cell), 7);
    const auto with = path_integrals<3>(over);
    const auto without = myriad::detail::path_increments<3>(over);
    for (int k = 0; k < 3; ++k) CHECK(with.increment[k] == without[k]);
}

TEMPLATE_TEST_CASE("integrals have the same bits in a plain lane and in packs, whatever the other lanes do", "",
                   (myriad::pack<double, 1>), (myriad::pack<float, 2>)) {
    using S = TestType;
    using R = myriad::real_of<S>;
    constexpr int lanes = S::lanes, count = 5;
    std::int64_t different = 0;
    for (int kind = 0; kind < 3; ++kind) {  // all over one cell, some over more or over parts, all over parts
        path_interval<S> over{};
        const auto constants = path_constants_of(R(0.25), 1);
        over.constants = &constants;
        path_interval<R> alone[lanes];
        for (int i = 0; i < lanes; ++i) {
            const bool parts = kind == 2 || (kind == 1 && i % 3 == 1);
            const int from = (7 * i - 20) * parts_of_cell + (parts ? 1024 * i : 0);
            const int length = parts ? parts_of_cell / 4 : parts_of_cell * (kind == 1 && i % 3 == 2 ? i : 1);
            alone[i] = interval<R>(place<R>(from), place<R>(from + length), 1000 * i, R(0.25));
            over.of.set(i, 1000 * i, 0);
            myriad::detail::set_place(over.from, i, alone[i].from);
            myriad::detail::set_place(over.to, i, alone[i].to);
        }
        const auto together = path_integrals<count>(over);
        for (int i = 0; i < lanes; ++i) {
            const auto own = path_integrals<count>(alone[i]);
            for (int k = 0; k < count; ++k) {
                const R w = get_lane(together.increment[k], i), integral = get_lane(together.integral[k], i);
                different += std::memcmp(&w, &own.increment[k], sizeof w) != 0;
                different += std::memcmp(&integral, &own.integral[k], sizeof w) != 0;
            }
        }
    }
    CHECK(different == 0);
}
