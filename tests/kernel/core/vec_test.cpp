// SPDX-License-Identifier: MIT
// A vector is made from as many values as it has components, and contains only these.
#include <type_traits>

#include <myriad/model.hpp>

#include "tests/catch.hpp"

using myriad::matrix;
using myriad::vec;

TEST_CASE("a vector is trivial and as large as its values") {
    STATIC_REQUIRE(std::is_trivial_v<vec<double, 3>>);
    STATIC_REQUIRE(std::is_trivial_v<matrix<float, 3>>);
    STATIC_REQUIRE(std::is_standard_layout_v<vec<double, 3>>);
    STATIC_REQUIRE(sizeof(vec<double, 3>) == 3 * sizeof(double));
}

TEST_CASE("tables of vectors are constants") {
    static constexpr vec<double, 2> table[] = {{1, 2}, {3, 4.5}};
    STATIC_REQUIRE(table[1][1] == 4.5);
    STATIC_REQUIRE(vec<int, 3>{}[2] == 0);
}

TEST_CASE("a matrix takes its rows in braces, with or without those of the arrays within") {
    static constexpr matrix<double, 2> rows = {{1, 2}, {3, 4}};
    static constexpr matrix<double, 2> arrays = {{{{1, 2}}, {{3, 4}}}};
    STATIC_REQUIRE(rows[1][0] == 3);
    STATIC_REQUIRE(arrays[1][0] == 3);
    STATIC_REQUIRE(matrix<double, 1>{{5}}[0][0] == 5);
}

namespace {
template <class R>
vec<R, 1> in_braces(R x) {
    return {x};
}
}  // namespace

TEST_CASE("a vector of one component is returned in braces") { CHECK(in_braces(2.5)[0] == 2.5); }

TEST_CASE("an index that is known at run time alone is anyone's") {
    enum which { first, second };
    vec<int, 2> v{1, 2};
    int sum = 0;
    for (int i = 0; i < 2; ++i) sum += v[i];
    for (const which w : {first, second}) sum += v[w];
    CHECK(sum == 6);
}
