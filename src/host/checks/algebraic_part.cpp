// SPDX-License-Identifier: MIT
// The algebraic equations of M y' = f, by elimination with full pivoting.
#include "myriad/host/checks/algebraic_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <utility>

namespace myriad::host::inline MYRIAD_ABI {

namespace {

/// Reduces a matrix of `rows` rows to the identity in `rank` of its columns, by full pivoting; `order` has the columns
/// in the order of their pivots, then the others. Returns the rank: entries below 1e-12 of the largest count as
/// rounding.
std::size_t reduce(std::vector<double>& a, std::size_t rows, std::size_t columns, std::vector<std::size_t>& order) {
    order.resize(columns);
    for (std::size_t j = 0; j < columns; ++j) order[j] = j;
    double largest = 0;
    for (const double x : a) largest = std::max(largest, std::abs(x));
    std::size_t rank = 0;
    for (; rank < std::min(rows, columns); ++rank) {
        std::size_t row = rank, place = rank;
        double best = 0;
        for (std::size_t i = rank; i < rows; ++i)
            for (std::size_t j = rank; j < columns; ++j)
                if (const double size = std::abs(a[i * columns + order[j]]); size > best)
                    best = size, row = i, place = j;
        if (!(best > 1e-12 * largest)) break;
        std::swap(order[rank], order[place]);
        for (std::size_t j = 0; j < columns; ++j) std::swap(a[rank * columns + j], a[row * columns + j]);
        const std::size_t pivot = order[rank];
        const double reciprocal = 1 / a[rank * columns + pivot];
        for (std::size_t j = 0; j < columns; ++j) a[rank * columns + j] *= reciprocal;
        for (std::size_t i = 0; i < rows; ++i) {
            const double factor = a[i * columns + pivot];
            if (i == rank || factor == 0) continue;
            for (std::size_t j = 0; j < columns; ++j) a[i * columns + j] -= factor * a[rank * columns + j];
            a[i * columns + pivot] = 0;
        }
    }
    return rank;
}

/// Vectors w with a w = 0, n each.
std::vector<double> null_space(std::vector<double> a, std::size_t n) {
    std::vector<std::size_t> order;
    const std::size_t rank = reduce(a, n, n, order);
    std::vector<double> all;
    for (std::size_t free = rank; free < n; ++free) {
        std::vector<double> w(n);
        w[order[free]] = 1;
        for (std::size_t i = 0; i < rank; ++i) w[order[i]] = -a[i * n + order[free]];
        all.insert(all.end(), w.begin(), w.end());
    }
    return all;
}

}  // namespace

algebraic_part::algebraic_part(int size, const std::vector<double>& mass) : n(size) {
    const auto columns = static_cast<std::size_t>(n);
    std::vector<double> transposed(mass.size());
    for (std::size_t i = 0; i < columns; ++i)
        for (std::size_t j = 0; j < columns; ++j) transposed[j * columns + i] = mass[i * columns + j];
    left = null_space(std::move(transposed), columns);
    right = null_space(mass, columns);
    count = static_cast<int>(left.size() / columns);
}

algebraic_equations::algebraic_equations(const algebraic_part& part, const std::vector<double>& f,
                                         const std::vector<double>& jacobian)
    : of(part) {
    const auto n = static_cast<std::size_t>(of.n), count = static_cast<std::size_t>(of.count);
    residual.assign(count, 0);
    slope.assign(count * n, 0);
    for (std::size_t k = 0; k < count; ++k) {
        for (std::size_t i = 0; i < n; ++i) {
            const double v = of.left[k * n + i];
            if (v == 0) continue;  // also where f or its derivative is not finite
            residual[k] += v * f[i];
            for (std::size_t j = 0; j < n; ++j) slope[k * n + j] += v * jacobian[i * n + j];
        }
    }
}

bool algebraic_equations::solve(std::vector<double>& change) const {
    const auto n = static_cast<std::size_t>(of.n), count = static_cast<std::size_t>(of.count);
    // Equations by unknowns, and the residuals, which no pivot is taken from.
    std::vector<double> a(count * count), b = residual;
    for (std::size_t k = 0; k < count; ++k) {
        double scale = 0;
        for (std::size_t m = 0; m < count; ++m) {
            for (std::size_t j = 0; j < n; ++j) a[k * count + m] += slope[k * n + j] * of.right[m * n + j];
            scale = std::max(scale, std::abs(a[k * count + m]));
        }
        if (!(scale > 0) || !std::isfinite(scale)) return false;
        for (std::size_t m = 0; m < count; ++m) a[k * count + m] /= scale;
        b[k] /= scale;
    }
    std::vector<std::size_t> order;
    if (std::vector<double> square = a; reduce(square, count, count, order) < count) return false;
    std::vector<double> unknown(count);
    for (std::size_t step = 0; step < count; ++step) {
        std::size_t row = step;
        for (std::size_t k = step; k < count; ++k)
            if (std::abs(a[k * count + step]) > std::abs(a[row * count + step])) row = k;
        for (std::size_t m = 0; m < count; ++m) std::swap(a[step * count + m], a[row * count + m]);
        std::swap(b[step], b[row]);
        for (std::size_t k = step + 1; k < count; ++k) {
            const double factor = a[k * count + step] / a[step * count + step];
            for (std::size_t m = step; m < count; ++m) a[k * count + m] -= factor * a[step * count + m];
            b[k] -= factor * b[step];
        }
    }
    for (std::size_t step = count; step-- > 0;) {
        double sum = -b[step];
        for (std::size_t m = step + 1; m < count; ++m) sum -= a[step * count + m] * unknown[m];
        unknown[step] = sum / a[step * count + step];
    }
    change.assign(n, 0);
    for (std::size_t m = 0; m < count; ++m)
        for (std::size_t j = 0; j < n; ++j) change[j] += unknown[m] * of.right[m * n + j];
    return true;
}

std::string algebraic_equations::text(int k, const std::function<std::string(int)>& name_of) const {
    const auto n = static_cast<std::size_t>(of.n);
    std::ostringstream out;
    out << "0 =";
    bool first = true;
    for (std::size_t i = 0; i < n; ++i) {
        const double v = of.left[static_cast<std::size_t>(k) * n + i];
        if (v == 0) continue;
        out << (v < 0 ? " - " : first ? " " : " + ");
        if (std::abs(v) != 1) out << std::abs(v) << ' ';
        out << "f_" << name_of(static_cast<int>(i));
        first = false;
    }
    return out.str();
}

}  // namespace myriad::host::inline MYRIAD_ABI
