// SPDX-License-Identifier: MIT
// The algebraic equations of a model with a singular mass matrix, found when it is compiled: combinations of rows that
// have no derivatives, and directions in which the state may jump without changing M y.
#pragma once

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/model/mass_matrix.hpp"

namespace myriad::detail {

/// Of n equations M y' = f: each row v of `left`, v M = 0, gives an equation v f = 0; each row w of `right`, M w = 0,
/// is a direction.
template <int n>
struct null_spaces {
    int count = 0, left_entries = 0, right_entries = 0;
    double left[n][n]{}, right[n][n]{};

    /// By Gauss-Jordan elimination with partial pivoting. Entries below 1e-12 of the largest count as rounding.
    template <class Entries>
    explicit constexpr null_spaces(const Entries& mass) {
        double a[n][n]{}, rows[n][n]{};  // the reduced matrix, and the rows of M that it is made of
        double largest = 0;
        for (int i = 0; i < n; ++i) rows[i][i] = 1;
        for (const mass_entry& e : mass) a[e.row][e.column] += e.value;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) largest = size_of(a[i][j]) > largest ? size_of(a[i][j]) : largest;
        int pivot[n]{}, row_of[n]{};  // of each row its column, and of each column its row; -1: none
        for (int i = 0; i < n; ++i) pivot[i] = row_of[i] = -1;
        for (int j = 0; j < n; ++j) {
            int row = -1;
            double best = 1e-12 * largest;
            for (int i = 0; i < n; ++i)
                if (pivot[i] < 0 && size_of(a[i][j]) > best) row = i, best = size_of(a[i][j]);
            if (row < 0) continue;
            pivot[row] = j, row_of[j] = row;
            const double reciprocal = 1 / a[row][j];
            scale(a[row], reciprocal);
            scale(rows[row], reciprocal);
            for (int i = 0; i < n; ++i) {
                const double factor = a[i][j];
                if (i == row || factor == 0) continue;
                subtract(a[i], factor, a[row]);
                subtract(rows[i], factor, rows[row]);
                a[i][j] = 0;
            }
        }
        for (int i = 0, k = 0; i < n; ++i) {
            if (pivot[i] >= 0) continue;
            for (int j = 0; j < n; ++j) left_entries += (left[k][j] = rows[i][j]) != 0;
            ++k;
        }
        for (int j = 0; j < n; ++j) {
            if (row_of[j] >= 0) continue;
            for (int c = 0; c < n; ++c) {
                right[count][c] = c == j ? 1 : row_of[c] >= 0 ? -a[row_of[c]][j] : 0;
                right_entries += right[count][c] != 0;
            }
            ++count;
        }
    }

private:
    static constexpr double size_of(double x) { return x < 0 ? -x : x; }
    static constexpr void scale(double (&row)[n], double factor) {
        for (int j = 0; j < n; ++j) row[j] *= factor;
    }
    static constexpr void subtract(double (&from)[n], double factor, const double (&row)[n]) {
        for (int j = 0; j < n; ++j) from[j] -= factor * row[j];
    }
};
template <class Model>
inline constexpr null_spaces<n_state<Model>> null_spaces_of{Model::mass_matrix};

template <class Model>
constexpr int n_algebraic_of() {
    if constexpr (has_mass_matrix<Model>) {
        return null_spaces_of<Model>.count;
    } else {
        return 0;
    }
}
/// Number of algebraic equations.
template <class Model>
inline constexpr int n_algebraic = n_algebraic_of<Model>();

/// Entries other than zero of these rows, each with its row and place.
template <int length>
struct null_space_entries {
    int row[length]{}, place[length]{};
    double value[length]{};

    template <int n>
    constexpr null_space_entries(const double (&rows)[n][n], int count) {
        int next = 0;
        for (int k = 0; k < count; ++k)
            for (int j = 0; j < n; ++j)
                if (rows[k][j] != 0) row[next] = k, place[next] = j, value[next++] = rows[k][j];
    }
};
/// The algebraic equations, as combinations of the model's, and the directions in which states are made consistent.
/// Each entry is a constant of its own, as device code must not read the table.
template <class Model>
struct algebraic_equations {
    static constexpr int length = null_spaces_of<Model>.left_entries;
    static constexpr null_space_entries<length> entries{null_spaces_of<Model>.left, n_algebraic<Model>};
};
template <class Model>
struct algebraic_directions {
    static constexpr int length = null_spaces_of<Model>.right_entries;
    static constexpr null_space_entries<length> entries{null_spaces_of<Model>.right, n_algebraic<Model>};
};
template <class Table, int e>
inline constexpr int null_space_row = Table::entries.row[e];
template <class Table, int e>
inline constexpr int null_space_place = Table::entries.place[e];
template <class Table, int e, class R>
inline constexpr R null_space_value = static_cast<R>(Table::entries.value[e]);

}  // namespace myriad::detail

namespace myriad::detail::inline MYRIAD_TARGET {

/// Calls `visit(row, place, value)` for each entry, as constants.
template <class Table, class R, class Visit>
MYRIAD_FUNCTION void for_each_null_space_entry(Visit&& visit) {
    static_for<0, Table::length>([&](auto e) MYRIAD_LAMBDA {
        constexpr int i = decltype(e)::value;
        visit(constant_index<null_space_row<Table, i>>{}, constant_index<null_space_place<Table, i>>{},
              null_space_value<Table, i, R>);
    });
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
