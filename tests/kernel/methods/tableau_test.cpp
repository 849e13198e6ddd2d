// SPDX-License-Identifier: MIT
// The tableaux against the rooted-tree order conditions, generated here and not taken from tableau.hpp's own check, and
// against the published rational numbers.
#include "myriad/kernel/methods/tableau.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <vector>

#include "myriad/kernel/stepper/dense_output.hpp"
#include "myriad/methods.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::cash_karp;
using myriad::dormand_prince_5;
using myriad::dormand_prince_8;
using myriad::runge_kutta_4;
using myriad::tsitouras_5;
using myriad::verner_7;
using myriad::verner_9;

// A rooted tree is the sorted list of the trees that hang on its root (Hairer, Norsett, Wanner, Solving ODE I, II.2).
struct tree {
    std::vector<tree> children;
    friend bool operator<(const tree& a, const tree& b) { return a.children < b.children; }
};

int order_of(const tree& t) {
    int nodes = 1;
    for (const tree& child : t.children) nodes += order_of(child);
    return nodes;
}

double density(const tree& t) {
    double gamma = order_of(t);
    for (const tree& child : t.children) gamma *= density(child);
    return gamma;
}

// All trees with one more leaf, attached to any node.
void grow(const tree& t, std::set<tree>& grown) {
    tree with_leaf = t;
    with_leaf.children.push_back({});
    std::sort(with_leaf.children.begin(), with_leaf.children.end());
    grown.insert(with_leaf);
    for (std::size_t i = 0; i < t.children.size(); ++i) {
        std::set<tree> branches;
        grow(t.children[i], branches);
        for (const tree& branch : branches) {
            tree changed = t;
            changed.children[i] = branch;
            std::sort(changed.children.begin(), changed.children.end());
            grown.insert(changed);
        }
    }
}

std::vector<tree> trees_of_order(int order) {
    std::set<tree> trees{tree{}};
    for (int n = 1; n < order; ++n) {
        std::set<tree> grown;
        for (const tree& t : trees) grow(t, grown);
        trees = grown;
    }
    return {trees.begin(), trees.end()};
}

using weights = std::vector<long double>;

// The stages' elementary weights of a tree, with the tableau's matrix or with its absolute values.
template <int stages>
weights elementary_weights(const myriad::explicit_tableau<stages>& t, const tree& root, bool absolute) {
    weights product(stages, 1.0L);
    for (const tree& child : root.children) {
        const weights below = elementary_weights(t, child, absolute);
        for (std::size_t i = 0; i < product.size(); ++i) {
            long double sum = 0;
            for (std::size_t j = 0; j < i; ++j) sum += (absolute ? std::abs(t.a[i][j]) : t.a[i][j]) * below[j];
            product[i] *= sum;
        }
    }
    return product;
}

long double dot(const weights& a, const weights& b) {
    long double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

struct residual {
    long double size = 0;      // largest |sum_i w_i Phi_i - theta^order / gamma| over the trees of one order
    long double rounding = 0;  // the largest value that rounding the coefficients to double may give instead of zero
    long double excess = 0;    // largest size / rounding of one tree
};

/// `absolute` holds the magnitudes of the numbers from which the weights were summed.
template <int stages>
residual condition(const myriad::explicit_tableau<stages>& t, const weights& w, const weights& absolute, int order,
                   long double theta = 1) {
    residual worst;
    for (const tree& root : trees_of_order(order)) {
        const long double value = dot(w, elementary_weights(t, root, false));
        const long double miss = std::abs(value - std::pow(theta, static_cast<long double>(order)) / density(root));
        // A tree of n nodes is a sum of products of n coefficients, each with a relative rounding of at most eps/2.
        const long double rounding = 0.5L * std::numeric_limits<double>::epsilon() * (order + 0.01L) *
                                     dot(absolute, elementary_weights(t, root, true));
        worst.size = std::max(worst.size, miss);
        worst.rounding = std::max(worst.rounding, rounding);
        worst.excess = std::max(worst.excess, miss / rounding);
    }
    return worst;
}

template <class Row>
weights solution_weights(const Row& b) {
    return {b.begin(), b.end()};
}
template <class Row>
weights absolute_of(const Row& b) {
    weights w(b.begin(), b.end());
    for (auto& x : w) x = std::abs(x);
    return w;
}

template <class Method>
void check_solution_order(int order) {
    constexpr auto t = Method::tableau();
    REQUIRE(Method::order == order);
    for (int q = 1; q <= order; ++q) {
        INFO("order " << q);
        CHECK(condition(t, solution_weights(t.b), absolute_of(t.b), q).excess <= 1);
    }
    // and no more: some condition of the next order is missed by far
    CHECK(condition(t, solution_weights(t.b), absolute_of(t.b), order + 1).excess > 1e6L);
}

template <class Method>
void check_embedded_order(int order) {
    constexpr auto t = Method::tableau();
    REQUIRE(Method::embedded_order == order);
    weights w = solution_weights(t.b), absolute = absolute_of(t.b);
    for (std::size_t i = 0; i < w.size(); ++i) {
        w[i] -= t.e[i];
        absolute[i] += std::abs(t.e[i]);
    }
    for (int q = 1; q <= order; ++q) {
        INFO("order " << q);
        CHECK(condition(t, w, absolute, q).excess <= 1);
    }
    CHECK(condition(t, w, absolute, order + 1).excess > 1e6L);
}

template <class Method>
void check_row_sums() {
    constexpr auto t = Method::tableau();
    for (std::size_t i = 0; i < t.c.size(); ++i) {
        long double sum = 0, size = std::abs(t.c[i]);
        for (std::size_t j = 0; j < i; ++j) {
            sum += t.a[i][j];
            size += std::abs(t.a[i][j]);
        }
        INFO("stage " << i);
        // every coefficient is rounded by half an ulp
        CHECK(std::abs(sum - t.c[i]) <= 0.5L * std::numeric_limits<double>::epsilon() * size);
        for (std::size_t j = i; j < t.c.size(); ++j) CHECK(t.a[i][j] == 0.0);  // explicit
    }
}

/// The tableau with the interpolant's own stages: the slope at the end of the step and those after it.
template <class Method>
auto extended_tableau() {
    constexpr int stages = Method::stages, all = myriad::detail::interpolant_stages<Method>;
    constexpr auto step = Method::tableau();
    myriad::explicit_tableau<all> t{};
    for (std::size_t i = 0; i < stages; ++i) {
        t.c[i] = step.c[i];
        for (std::size_t j = 0; j < i; ++j) t.a[i][j] = step.a[i][j];
    }
    if constexpr (all > stages) {
        t.c[stages] = 1;
        for (std::size_t j = 0; j < stages; ++j) t.a[stages][j] = step.b[j];
        for (int i = 0; i < Method::extra_stages; ++i) {
            const auto row = static_cast<std::size_t>(stages + 1 + i);
            t.c[row] = Method::extra_node(i);
            for (int j = 0; j <= stages + i; ++j) t.a[row][static_cast<std::size_t>(j)] = Method::extra_weight(i, j);
        }
    }
    return t;
}

/// Inside the step the interpolant is a method whose weights depend on theta.
template <class Method>
void check_interpolant_conditions(int order) {
    REQUIRE(Method::interpolant_order == order);
    const auto t = extended_tableau<Method>();
    const std::size_t stages = t.c.size();
    for (const long double theta : {0.1L, 1.0L / 3, 0.5L, 0.875L}) {
        weights w(stages, 0.0L), absolute(stages, 0.0L);
        for (std::size_t i = 0; i < stages; ++i) {
            long double power = 1;
            for (int k = 0; k < Method::interpolant_degree; ++k) {
                power *= theta;
                const long double term = Method::interpolant_weight(static_cast<int>(i), k) * power;
                w[i] += term;
                absolute[i] += std::abs(term);
            }
        }
        for (int q = 1; q <= order; ++q) {
            INFO("theta " << static_cast<double>(theta) << ", order " << q);
            CHECK(condition(t, w, absolute, q, theta).excess <= 1);
        }
        CHECK(condition(t, w, absolute, order + 1, theta).excess > 1e3L);
    }
}

/// At theta = 1 the interpolant is the step, and its slopes are those at both ends.
template <class Method>
void check_interpolant_ends() {
    constexpr int stages = myriad::detail::interpolant_stages<Method>;
    constexpr int slope_end = Method::first_same_as_last ? Method::stages - 1 : Method::stages;
    constexpr auto t = Method::tableau();
    for (int i = 0; i < stages; ++i) {
        double end = 0, end_slope = 0, size = 0;
        for (int k = 0; k < Method::interpolant_degree; ++k) {
            end += Method::interpolant_weight(i, k);
            end_slope += (k + 1) * Method::interpolant_weight(i, k);
            size += (k + 1) * std::abs(Method::interpolant_weight(i, k));
        }
        INFO("stage " << i);
        // the coefficients and their sums are rounded: half an ulp each
        const double rounding = Method::interpolant_degree * std::numeric_limits<double>::epsilon() * size;
        const double weight = i < Method::stages ? t.b[static_cast<std::size_t>(i)] : 0.0;
        CHECK(std::abs(end - weight) <= rounding);
        CHECK(std::abs(end_slope - (i == slope_end ? 1.0 : 0.0)) <= rounding);
        CHECK(Method::interpolant_weight(i, 0) == (i == 0 ? 1.0 : 0.0));  // slope at the start
    }
}

double rational(double numerator, double denominator) { return numerator / denominator; }

constexpr double eps = std::numeric_limits<double>::epsilon();

}  // namespace

TEST_CASE("there are 1, 1, 2, 4, 9, 20, 48, 115 and 286 rooted trees of orders one to nine") {
    const std::size_t counts[] = {1, 1, 2, 4, 9, 20, 48, 115, 286};
    for (int order = 1; order <= 9; ++order) CHECK(trees_of_order(order).size() == counts[order - 1]);
}

TEST_CASE("runge_kutta_4 satisfies the order conditions to four and not to five") {
    check_solution_order<runge_kutta_4>(4);
}
TEST_CASE("cash_karp satisfies the order conditions to five and not to six") { check_solution_order<cash_karp>(5); }
TEST_CASE("tsitouras_5 satisfies the order conditions to five and not to six") { check_solution_order<tsitouras_5>(5); }
TEST_CASE("dormand_prince_5 satisfies the order conditions to five and not to six") {
    check_solution_order<dormand_prince_5>(5);
}
TEST_CASE("verner_7 satisfies the order conditions to seven and not to eight") { check_solution_order<verner_7>(7); }
TEST_CASE("dormand_prince_8 satisfies the order conditions to eight and not to nine") {
    check_solution_order<dormand_prince_8>(8);
}
TEST_CASE("verner_9 satisfies the order conditions to nine and not to ten") { check_solution_order<verner_9>(9); }

TEST_CASE("the embedded solution of cash_karp satisfies the order conditions to four and not to five") {
    check_embedded_order<cash_karp>(4);
}
TEST_CASE("the embedded solution of tsitouras_5 satisfies the order conditions to four and not to five") {
    check_embedded_order<tsitouras_5>(4);
}
TEST_CASE("the embedded solution of dormand_prince_5 satisfies the order conditions to four and not to five") {
    check_embedded_order<dormand_prince_5>(4);
}
TEST_CASE("the embedded solution of verner_7 satisfies the order conditions to six and not to seven") {
    check_embedded_order<verner_7>(6);
}
TEST_CASE("the embedded solution of verner_9 satisfies the order conditions to eight and not to nine") {
    check_embedded_order<verner_9>(8);
}
TEST_CASE("the embedded solutions of dormand_prince_8 satisfy the order conditions to five and three and not to more") {
    check_embedded_order<dormand_prince_8>(5);
    constexpr auto t = dormand_prince_8::tableau();
    weights w = solution_weights(t.b), absolute = absolute_of(t.b);
    for (std::size_t i = 0; i < w.size(); ++i) {
        w[i] -= dormand_prince_8::coarse_error_weight(static_cast<int>(i));
        absolute[i] += std::abs(dormand_prince_8::coarse_error_weight(static_cast<int>(i)));
    }
    for (int q = 1; q <= 3; ++q) CHECK(condition(t, w, absolute, q).excess <= 1);
    CHECK(condition(t, w, absolute, 4).excess > 1e6L);
}

TEST_CASE("the row sums of runge_kutta_4 are its nodes") { check_row_sums<runge_kutta_4>(); }
TEST_CASE("the row sums of cash_karp are its nodes") { check_row_sums<cash_karp>(); }
TEST_CASE("the row sums of tsitouras_5 are its nodes") { check_row_sums<tsitouras_5>(); }
TEST_CASE("the row sums of dormand_prince_5 are its nodes") { check_row_sums<dormand_prince_5>(); }
TEST_CASE("the row sums of verner_7 are its nodes") { check_row_sums<verner_7>(); }
TEST_CASE("the row sums of dormand_prince_8 are its nodes") { check_row_sums<dormand_prince_8>(); }
TEST_CASE("the row sums of verner_9 are its nodes") { check_row_sums<verner_9>(); }

TEST_CASE("runge_kutta_4 has no error estimate") {
    CHECK(runge_kutta_4::embedded_order == 0);
    for (const double e : runge_kutta_4::tableau().e) CHECK(e == 0.0);
}

TEST_CASE("the last stage of tsitouras_5 is the slope at its new state") {
    constexpr auto t = tsitouras_5::tableau();
    REQUIRE(tsitouras_5::first_same_as_last);
    CHECK(t.a[6] == t.b);
    CHECK(t.b[6] == 0.0);
    CHECK(t.c[6] == 1.0);
}

TEST_CASE("the last stage of dormand_prince_5 is the slope at its new state") {
    constexpr auto t = dormand_prince_5::tableau();
    REQUIRE(dormand_prince_5::first_same_as_last);
    CHECK(t.a[6] == t.b);
    CHECK(t.b[6] == 0.0);
    CHECK(t.c[6] == 1.0);
}

TEST_CASE("runge_kutta_4 and cash_karp do not claim that their last stage is the first of the next step") {
    CHECK_FALSE(runge_kutta_4::first_same_as_last);
    CHECK_FALSE(cash_karp::first_same_as_last);
    CHECK(cash_karp::tableau().c[5] == 0.875);
}

TEST_CASE("the weights of runge_kutta_4 are those of Simpson's rule") {
    constexpr auto t = runge_kutta_4::tableau();
    // two midpoints share Simpson's 4/6
    CHECK(t.b[0] == rational(1, 6));
    CHECK(t.b[1] + t.b[2] == rational(4, 6));
    CHECK(t.b[1] == t.b[2]);
    CHECK(t.b[3] == rational(1, 6));
}

TEST_CASE("the embedded weights of cash_karp are the published rationals") {
    const auto w = myriad::embedded_weights(cash_karp::tableau());
    const double published[] = {
        rational(2825, 27648), 0, rational(18575, 48384), rational(13525, 55296), rational(277, 14336), rational(1, 4)};
    // b and e are rounded to double and then subtracted: three roundings of numbers below 0.5
    for (std::size_t i = 0; i < w.size(); ++i) CHECK(std::abs(w[i] - published[i]) <= 1.5 * 0.5 * eps);
}

TEST_CASE("the weights of cash_karp are the published rationals") {
    constexpr auto t = cash_karp::tableau();
    // Over a common denominator the paper's numbers are integers: 37/378 + 250/621 + 125/594 + 512/1771 = 1.
    const double denominator = 378.0 * 23.0 * 11.0;  // lcm of 378 = 2 27 7, 621 = 27 23, 594 = 2 27 11, 1771 = 7 11 23
    const double numerators[] = {37.0 * 253.0, 0.0, 250.0 * 154.0, 125.0 * 161.0, 0.0, 512.0 * 54.0};
    CHECK(numerators[0] + numerators[2] + numerators[3] + numerators[5] == denominator);
    for (std::size_t i = 0; i < t.b.size(); ++i) CHECK(t.b[i] == rational(numerators[i], denominator));
    CHECK(t.a[5][0] == rational(1631, 55296));
    CHECK(t.a[5][1] == rational(175, 512));
    CHECK(t.a[5][2] == rational(575, 13824));
    CHECK(t.a[5][3] == rational(44275, 110592));
    CHECK(t.a[5][4] == rational(253, 4096));
}

TEST_CASE("the free parameters of tsitouras_5 are the published decimals") {
    constexpr auto t = tsitouras_5::tableau();
    CHECK(t.c[1] == rational(161, 1000));
    CHECK(t.c[2] == rational(327, 1000));
    CHECK(t.c[3] == rational(9, 10));
    CHECK(t.b[1] == rational(1, 100));
    CHECK(t.e[6] == rational(1, 66));
}

TEST_CASE("tsitouras_5 satisfies its only simplifying assumption, that of the first column") {
    // sum_i b_i a_ij = b_j (1 - c_j), the title of Tsitouras' paper
    constexpr auto t = tsitouras_5::tableau();
    for (std::size_t j = 0; j < t.b.size(); ++j) {
        long double sum = -t.b[j] * (1.0L - t.c[j]), size = 2 * std::abs(t.b[j]);
        for (std::size_t i = j + 1; i < t.b.size(); ++i) {
            sum += static_cast<long double>(t.b[i]) * t.a[i][j];
            size += std::abs(t.b[i] * t.a[i][j]);
        }
        INFO("stage " << j);
        CHECK(std::abs(sum) <= eps * size);  // two factors, each rounded by half an ulp
    }
}

TEST_CASE("the interpolant of tsitouras_5 satisfies the order conditions to four and not to five") {
    check_interpolant_conditions<tsitouras_5>(4);
}
TEST_CASE("the interpolant of dormand_prince_5 satisfies the order conditions to four and not to five") {
    check_interpolant_conditions<dormand_prince_5>(4);
}
TEST_CASE("the interpolant of verner_7 satisfies the order conditions to six and not to seven") {
    check_interpolant_conditions<verner_7>(6);
}
TEST_CASE("the interpolant of dormand_prince_8 satisfies the order conditions to seven and not to eight") {
    check_interpolant_conditions<dormand_prince_8>(7);
}
TEST_CASE("the interpolant of verner_9 satisfies the order conditions to nine and not to ten") {
    check_interpolant_conditions<verner_9>(9);
}

TEST_CASE("the interpolant of tsitouras_5 ends with the weights of the step and the slopes of both ends") {
    check_interpolant_ends<tsitouras_5>();
}
TEST_CASE("the interpolant of dormand_prince_5 ends with the weights of the step and the slopes of both ends") {
    check_interpolant_ends<dormand_prince_5>();
}
TEST_CASE("the interpolant of verner_7 ends with the weights of the step and the slopes of both ends") {
    check_interpolant_ends<verner_7>();
}
TEST_CASE("the interpolant of dormand_prince_8 ends with the weights of the step and the slopes of both ends") {
    check_interpolant_ends<dormand_prince_8>();
}
TEST_CASE("the interpolant of verner_9 ends with the weights of the step and the slopes of both ends") {
    check_interpolant_ends<verner_9>();
}
