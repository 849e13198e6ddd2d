// SPDX-License-Identifier: MIT
// LU with partial pivoting against Eigen's, for sizes up to 32, in one lane and in packs whose lanes need different
// pivots; singular matrices; lanes that do not disturb each other.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <Eigen/Dense>

#include "tests/catch.hpp"
#include "tests/kernel/stepper/lu_lanes.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using lu_lanes::kind;
using lu_lanes::largest_system;
using lu_lanes::systems;

constexpr kind all_kinds[] = {kind::one_double, kind::one_float, kind::pack_of_double, kind::pack_of_float};

double eps_of(kind which) {
    const bool narrow = which == kind::one_float || which == kind::pack_of_float;
    return narrow ? static_cast<double>(std::numeric_limits<float>::epsilon()) : std::numeric_limits<double>::epsilon();
}

MatrixXd matrix_of(const systems& s, int lane) {
    MatrixXd a(s.n, s.n);
    for (int i = 0; i < s.n; ++i)
        for (int j = 0; j < s.n; ++j) a(i, j) = s.matrix[static_cast<std::size_t>((lane * s.n + i) * s.n + j)];
    return a;
}
VectorXd vector_of(const std::vector<double>& values, int n, int lane) {
    return Eigen::Map<const VectorXd>(values.data() + lane * n, n);
}

/// Calls test(which, n) for every kind of number and every size that is compiled for it.
template <class Test>
void each_system(Test test) {
    for (const kind which : all_kinds)
        for (int n = 1; n <= largest_system; ++n)
            if (lu_lanes::is_compiled(which, n)) test(which, n);
}

/// One system per lane, with a matrix and a right-hand side set by `fill(lane, a, b)`; rounded to single precision, so
/// that every kind of number holds the same matrix.
template <class Fill>
systems make(kind which, int n, Fill fill) {
    systems s;
    s.n = n;
    for (int lane = 0; lane < lu_lanes::lanes(which); ++lane) {
        MatrixXd a(n, n);
        VectorXd b(n);
        fill(lane, a, b);
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) s.matrix.push_back(static_cast<double>(static_cast<float>(a(i, j))));
            s.right.push_back(static_cast<double>(static_cast<float>(b(i))));
        }
    }
    return s;
}

struct random_systems {
    std::mt19937 generator{7};
    std::uniform_real_distribution<double> uniform{-1, 1};
    void operator()(int, MatrixXd& a, VectorXd& b) {
        for (Eigen::Index i = 0; i < a.rows(); ++i) {
            for (Eigen::Index j = 0; j < a.cols(); ++j) a(i, j) = uniform(generator);
            b(i) = uniform(generator);
        }
    }
};

/// The residual of Gaussian elimination with partial pivoting: |A x - b| <= 3 n eps |L| |U| |x| (Higham, Accuracy and
/// Stability of Numerical Algorithms, theorem 9.4, with eps twice the unit roundoff), with Eigen's factors, whose
/// pivots are of the same size; Eigen's solution has a residual of that size too.
void check_against_eigen(kind which, const systems& s) {
    const auto found = lu_lanes::solve(which, s);
    for (int lane = 0; lane < lu_lanes::lanes(which); ++lane) {
        CAPTURE(s.n, lane, static_cast<int>(which));
        REQUIRE(found.regular[static_cast<std::size_t>(lane)]);
        const MatrixXd a = matrix_of(s, lane);
        const VectorXd x = vector_of(found.x, s.n, lane), b = vector_of(s.right, s.n, lane);
        const Eigen::PartialPivLU<MatrixXd> lu(a);
        const MatrixXd l = lu.matrixLU().triangularView<Eigen::UnitLower>();
        const MatrixXd u = lu.matrixLU().triangularView<Eigen::Upper>();
        const VectorXd residual = lu.permutationP() * (a * x - b);
        const VectorXd bound = 3 * s.n * eps_of(which) * (l.cwiseAbs() * (u.cwiseAbs() * x.cwiseAbs()));
        for (int i = 0; i < s.n; ++i) {
            CAPTURE(i, residual(i), bound(i));
            CHECK(std::abs(residual(i)) <= bound(i));
        }
        // two solutions with such residuals differ by A^-1 of both
        const VectorXd apart = lu.inverse().cwiseAbs() * (lu.permutationP().transpose() * (2 * bound));
        const VectorXd eigen = lu.solve(b);
        for (int i = 0; i < s.n; ++i) CHECK(std::abs(x(i) - eigen(i)) <= apart(i));
    }
}

}  // namespace

TEST_CASE("LU solves random systems of every size as Eigen does") {
    each_system([](kind which, int n) { check_against_eigen(which, make(which, n, random_systems{})); });
}

TEST_CASE("LU finds another pivot in each lane") {
    each_system([](kind which, int n) {
        std::mt19937 generator(3);
        // a permutation of the rows of a triangular matrix: without the right exchanges a pivot is zero
        const systems s = make(which, n, [&](int lane, MatrixXd& a, VectorXd& b) {
            random_systems{}(lane, a, b);
            a = MatrixXd(a.triangularView<Eigen::Upper>());
            for (int i = 0; i < n; ++i) a(i, i) = i % 2 == 0 ? 1 : -2;
            Eigen::PermutationMatrix<Eigen::Dynamic> order(n);
            order.setIdentity();
            std::shuffle(order.indices().data(), order.indices().data() + n, generator);
            a = order * a;
        });
        check_against_eigen(which, s);
    });
}

TEST_CASE("LU chooses the largest pivot, and not the first") {
    // 1e-7 x + y = 1, x + y = 2: with the first pivot x is lost in single precision, or has seven digits in double
    for (const kind which : all_kinds) {
        const systems s = make(which, 2, [](int, MatrixXd& a, VectorXd& b) { a << 1e-7, 1, 1, 1, b << 1, 2; });
        const auto found = lu_lanes::solve(which, s);
        const double tiny = s.matrix[0], y = (1 - 2 * tiny) / (1 - tiny), x = 2 - y;
        CHECK(std::abs(found.x[0] - x) <= 4 * eps_of(which));  // a handful of roundings of numbers up to two
        CHECK(std::abs(found.x[1] - y) <= 4 * eps_of(which));
    }
}

TEST_CASE("a singular matrix is reported, in its lane alone") {
    each_system([](kind which, int n) {
        for (const double flaw : {0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
            const int bad_lane = lu_lanes::lanes(which) / 2;
            const systems good = make(which, n, random_systems{});
            systems s = good;
            // a column of zeros stays zero to the last bit; NaN and infinity reach a pivot from any position
            const int column = n / 2;
            for (int i = 0; i < n; ++i)
                if (flaw == 0 || i == n / 3) s.matrix[static_cast<std::size_t>((bad_lane * n + i) * n + column)] = flaw;
            const auto found = lu_lanes::solve(which, s), expected = lu_lanes::solve(which, good);
            for (int lane = 0; lane < lu_lanes::lanes(which); ++lane) {
                CAPTURE(n, lane, flaw, static_cast<int>(which));
                CHECK(found.regular[static_cast<std::size_t>(lane)] == (lane != bad_lane));
                if (lane == bad_lane) continue;
                for (int i = 0; i < n; ++i)  // the neighbour changes no bit
                    CHECK(found.x[static_cast<std::size_t>(lane * n + i)] ==
                          expected.x[static_cast<std::size_t>(lane * n + i)]);
            }
        }
    });
}

TEST_CASE("a pack solves each lane as one lane alone does, to the last bit") {
    for (const auto& [pack, one] :
         {std::pair{kind::pack_of_double, kind::one_double}, {kind::pack_of_float, kind::one_float}}) {
        for (int n = 1; n <= largest_system; ++n) {
            if (!lu_lanes::is_compiled(pack, n)) continue;
            const systems all = make(pack, n, random_systems{});
            const auto found = lu_lanes::solve(pack, all);
            for (int lane = 0; lane < lu_lanes::lanes(pack); ++lane) {
                const auto at = [&](const std::vector<double>& v, int size) {
                    return std::vector<double>(v.begin() + lane * size, v.begin() + (lane + 1) * size);
                };
                const auto alone = lu_lanes::solve(one, {n, at(all.matrix, n * n), at(all.right, n)});
                CAPTURE(n, lane);
                CHECK(alone.x == at(found.x, n));
            }
        }
    }
}
