// SPDX-License-Identifier: MIT
// Increments and integrals over the halves of a cell: those of any two places, in packs and plain lanes.
#include "myriad/kernel/model/path_tree.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::detail::get_lane;
using myriad::detail::parts_of_cell;
using myriad::detail::path_constants_of;
using myriad::detail::path_integrals;
using myriad::detail::set_lane;
using myriad::detail::set_place;
using myriad::detail::tree_integrals;
using myriad::detail::tree_interval;

/// From a part of cell 3 on over so many, backwards if negative.
template <class R>
tree_interval<R> node(std::int32_t from, std::int32_t length, bool is_node = true) {
    const std::int32_t to = from + length;
    using number = typename myriad::detail::path_integers<R>::cell;
    const auto place = [](std::int32_t part) {
        return myriad::detail::path_place<R>{number(3 + part / parts_of_cell), part % parts_of_cell};
    };
    static const auto constants = path_constants_of(R(0.5), 7);
    tree_interval<R> over{{place(from), place(to), {}, &constants}, is_node ? std::abs(length) : 0};
    over.of.set(0, 11, 0);
    return over;
}

}  // namespace

TEMPLATE_TEST_CASE("over a node the path is that between its places, forwards and backwards", "", double, float) {
    using R = TestType;
    // Differences of values of the whole cell lose what a shorter node is smaller by.
    for (const std::int32_t length : {65'536, 32'768, 8192, 512})
        for (const std::int32_t from : {0, 65'536 - length, 32'768 / length * length}) {
            if (from + length > parts_of_cell) continue;
            for (const bool backwards : {false, true}) {
                const std::int32_t begin = backwards ? from + length : from, way = backwards ? -length : length;
                const auto found = tree_integrals<3>(node<R>(begin, way));
                const auto expected = path_integrals<3>(node<R>(begin, way));
                for (int k = 0; k < 3; ++k) {
                    const double l = 0.5 * length / parts_of_cell, rounding = sizeof(R) == 8 ? 1e-15 : 1e-6;
                    CHECK(static_cast<double>(found.increment[k]) ==
                          Approx(static_cast<double>(expected.increment[k])).margin(rounding));
                    CHECK(static_cast<double>(found.integral[k]) ==
                          Approx(static_cast<double>(expected.integral[k])).margin(rounding));
                    CHECK(std::fabs(static_cast<double>(found.increment[k])) < 6 * std::sqrt(l));
                    CHECK(found.increment[k] != R(0));
                }
            }
        }
}

TEST_CASE("two halves make a whole, down to the shortest node") {
    std::int32_t from = 0;
    for (std::int32_t length = parts_of_cell; length > 1; length /= 2) {
        const auto whole = tree_integrals<2>(node<double>(from, length));
        const auto first = tree_integrals<2>(node<double>(from, length / 2));
        const auto second = tree_integrals<2>(node<double>(from + length / 2, length / 2));
        const double half = 0.25 * length / parts_of_cell;
        for (int k = 0; k < 2; ++k) {
            CHECK(first.increment[k] + second.increment[k] == Approx(whole.increment[k]).epsilon(1e-12));
            CHECK(first.integral[k] + half * first.increment[k] + second.integral[k] ==
                  Approx(whole.integral[k]).epsilon(1e-12));
        }
        if (length % 4 == 0) from += length / 2;
    }
}

TEMPLATE_TEST_CASE("a lane has the bits of a plain number whatever its neighbours' intervals are", "", double, float) {
    using R = TestType;
    using S = myriad::pack<R, 2>;
    tree_interval<S> all;
    const auto constants = path_constants_of(R(0.5), 7);
    all.constants = &constants;
    const auto one_of = [](int i) {
        if (i % 3 == 2) return node<R>(1000 * i, 777, false);
        return i % 3 == 0 ? node<R>(0, parts_of_cell) : node<R>(4096 * (i % 4 + 1), 1024);
    };
    for (int i = 0; i < myriad::lanes_of<S>; ++i) {
        const tree_interval<R> one = one_of(i);
        set_place(all.from, i, one.from);
        set_place(all.to, i, one.to);
        set_lane(all.length, i, one.length);
        all.of.set(i, 11, 0);
    }
    const auto found = tree_integrals<3>(all);
    for (int i = 0; i < myriad::lanes_of<S>; ++i) {
        const auto expected = tree_integrals<3>(one_of(i));
        for (int k = 0; k < 3; ++k) {
            CHECK(get_lane(found.increment[k], i) == expected.increment[k]);
            CHECK(get_lane(found.integral[k], i) == expected.integral[k]);
        }
    }
}
