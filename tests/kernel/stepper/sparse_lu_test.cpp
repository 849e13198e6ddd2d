// SPDX-License-Identifier: MIT
// Factors of a known pattern: their order, solutions in one lane and in packs, pivots that cancel, and the derivatives
// that go into them.
#include "myriad/kernel/stepper/sparse_lu.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "myriad/kernel/model/jacobian.hpp"
#include "myriad/kernel/scalar/pack.hpp"
#include "problems/pollution.hpp"
#include "tests/catch.hpp"
#include "tests/support/sparse.hpp"

namespace {

using namespace myriad::detail;
using myriad::inputs;
using myriad::matrix;
using myriad::pack;
using myriad::real_of;
using myriad::vec;

/// Fills the entries of the pattern and the diagonal with random numbers, the diagonal with large ones, and compares
/// the solution in every lane with the right-hand side it came from.
template <class Model, class S>
void check_solutions(unsigned seed) {
    using R = real_of<S>;
    using lu_type = sparse_lu_factors<Model, S>;
    using tables = typename lu_type::tables;
    constexpr int n = n_state<Model>;
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> off(-1, 1), on(2, 3);
    matrix<S, n> a{};
    lu_type lu;
    for (int e = 0; e < tables::n_entry; ++e) lu.a[e] = S(R(0));
    const auto& plan = lu_tables_of<Model>;
    const auto put = [&](int row, int column, int place, auto& draws) {
        for (int lane = 0; lane < myriad::lanes_of<S>; ++lane) {
            const R value = static_cast<R>(draws(engine)) * (row == column ? R(n) : R(1));
            set_lane(a[row][column], lane, value);
            set_lane(lu.a[place], lane, value);
        }
    };
    for (int e = 0; e < n_jacobian_entry<Model>; ++e) {
        const auto entry = jacobian_entries_of<Model>[e];
        if (entry.row != entry.column) put(entry.row, entry.column, plan.position[e], off);
    }
    for (int i = 0; i < n; ++i) {
        put(i, i, plan.diagonal[i], on);
        lu.size[i] = abs(lu.a[plan.diagonal[i]]);
    }
    vec<S, n> x, b;
    for (int i = 0; i < n; ++i) x[i] = S(static_cast<R>(on(engine)));
    for (int i = 0; i < n; ++i) {
        b[i] = S(R(0));
        for (int j = 0; j < n; ++j) b[i] = b[i] + a[i][j] * x[j];
    }
    const auto regular = factorise(lu);
    solve_factorised(lu, b);
    for (int lane = 0; lane < myriad::lanes_of<S>; ++lane) {
        CHECK(get_lane(regular, lane));
        for (int i = 0; i < n; ++i) {
            // the matrix is dominated by its diagonal: no growth, and n roundings or so
            const R error = std::abs(get_lane(b[i], lane) - get_lane(x[i], lane));
            CHECK(error <= R(4 * n) * std::numeric_limits<R>::epsilon() * R(3));
        }
    }
}

/// Whether the derivatives put into the pattern's places are those of the dense Jacobian, and these zero elsewhere.
template <class Model>
void check_derivatives(double tolerance) {
    constexpr int n = n_state<Model>;
    inputs<Model, double> p{};
    const std::int32_t zero = 0;
    p.shared_integer = &zero;
    if constexpr (n_parameter < Model >> 0) p.parameter[0] = 1.7;
    vec<double, n> y;
    for (int c = 0; c < n; ++c) y[c] = std::sin(1.0 + c);
    matrix<double, n> dense;
    dual_jacobian<Model>(0.3, y, p, dense);
    using S = pack<double, 1>;
    inputs<Model, S> p_of_pack{};
    p_of_pack.shared_integer = &zero;
    if constexpr (n_parameter < Model >> 0) p_of_pack.parameter[0] = S(1.7);
    vec<S, n> y_of_pack;
    for (int c = 0; c < n; ++c) y_of_pack[c] = S(y[c]);
    int written_out = 0;
    for_each_jacobian_entry<Model, table_loop<true>>(S(0.3), y_of_pack, p_of_pack, [&](int e, const S& derivative) {
        const auto entry = jacobian_entries_of<Model>[e];
        for (int lane = 0; lane < S::lanes; ++lane)
            CHECK(std::abs(get_lane(derivative, lane) - dense[entry.row][entry.column]) <=
                  tolerance * std::abs(dense[entry.row][entry.column]));
        ++written_out;
    });
    CHECK(written_out == n_jacobian_entry<Model>);
    int found = 0;
    for_each_jacobian_entry<Model, table_loop<false>>(0.3, y, p, [&](int e, double derivative) {
        const auto entry = jacobian_entries_of<Model>[e];
        CHECK(std::abs(derivative - dense[entry.row][entry.column]) <=
              tolerance * std::abs(dense[entry.row][entry.column]));
        dense[entry.row][entry.column] = 0;
        ++found;
    });
    CHECK(found == n_jacobian_entry<Model>);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) CHECK(dense[i][j] == 0);
}

/// The largest number of steps of a factorisation each of which needs the one before it.
template <class Model>
int longest_chain() {
    constexpr int n = n_state<Model>;
    const auto& symbolic = symbolic_lu_of<Model>;
    int length[n]{}, longest = 0;
    for (int s = 0; s < n; ++s) {
        const int here = length[symbolic.pivot[s]] + 1;
        longest = std::max(longest, here);
        for (int k = 0; k < n; ++k)
            if (symbolic.right[s].contains(k) || symbolic.below[s].contains(k)) length[k] = std::max(length[k], here);
    }
    return longest;
}

}  // namespace

TEST_CASE("an arrow is eliminated from its tip's far end, so that nothing fills") {
    constexpr auto& symbolic = symbolic_lu_of<sparse::arrow<9>>;
    CHECK(symbolic.lower == 8);
    CHECK(symbolic.upper == 8);
    CHECK(symbolic.updates == 8);
    CHECK(jacobian_groups_of<sparse::arrow<9>>.count == 9);  // the first row is full
}

TEST_CASE("a ring of oscillators needs a part of the dense factors, and five groups of columns at most") {
    constexpr auto& symbolic = symbolic_lu_of<sparse::ring<32>>;
    CHECK(32 + symbolic.lower + symbolic.upper <= 200);
    CHECK(symbolic.updates <= 105);  // of 10 912 in a dense matrix; 182 is what a program written for it needs
    CHECK(jacobian_groups_of<sparse::ring<32>>.count <= 5);
}

TEST_CASE("few steps around a ring wait for each other") {
    // Half of the oscillators that are left do not meet, so that the chain has the logarithm of their number.
    CHECK(longest_chain<sparse::ring<8>>() == 4);
    CHECK(longest_chain<sparse::ring<32>>() == 6);
    CHECK(longest_chain<sparse::ring<64>>() == 7);
}

TEST_CASE("sparse factors solve their systems, in one lane and in packs") {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        check_solutions<sparse::arrow<9>, double>(seed);
        check_solutions<sparse::arrow<9>, pack<double, 1>>(seed);
        check_solutions<sparse::ring<8>, double>(seed);
        check_solutions<sparse::ring<32>, pack<double, 1>>(seed);
        check_solutions<sparse::ring<32>, float>(seed);
        check_solutions<sparse::ring<66>, pack<float, 1>>(seed);  // sets of more than one word
    }
}

TEST_CASE("factors are kept with their last values, each once") {
    using model = sparse::ring<32>;
    sparse_lu_factors<model, double> lu;
    for (int e = 0; e < decltype(lu)::tables::n_entry; ++e) lu.a[e] = 1.0 / (e + 2);
    for (int i = 0; i < n_state<model>; ++i) lu.size[i] = lu.a[lu_tables_of<model>.diagonal[i]] = 8 + i;
    std::vector<std::vector<double>> kept(decltype(lu)::tables::n_entry);
    CHECK(factorise(lu,
                    [&](auto entry, const double& value) { kept[static_cast<std::size_t>(entry)].push_back(value); }));
    for (std::size_t e = 0; e < kept.size(); ++e) CHECK(kept[e] == std::vector<double>{lu.a[e]});
}

TEST_CASE("a pivot that cancels is singular however its state is scaled, and a small one that does not is not") {
    using model = sparse::growth_among_decays;
    for (const double scale : {1.0, 1e-100, 1e100}) {
        sparse_lu_factors<model, double> lu;
        const auto& plan = lu_tables_of<model>;
        for (int i = 0; i < 8; ++i) {
            lu.a[plan.diagonal[i]] = 1e-8 * scale;
            lu.size[i] = 1e-8 * scale;
        }
        auto cancelled = lu;
        cancelled.size[3] = scale;  // 1e-8 is left of terms of size one
        CHECK(factorise(lu));
        CHECK_FALSE(factorise(cancelled));
    }
}

TEST_CASE("derivatives by groups of columns, and those written out, are those of the dense Jacobian") {
    check_derivatives<sparse::ring<8>>(0);
    check_derivatives<sparse::ring<32>>(0);
    check_derivatives<sparse::arrow<9>>(0);
    check_derivatives<sparse::plain_ring<8>>(0);
    check_derivatives<sparse::plain_ring<64>>(0);
    check_derivatives<problems::pollution>(0);
    check_derivatives<sparse::ring_with_jacobian<8>>(1e-14);
}
