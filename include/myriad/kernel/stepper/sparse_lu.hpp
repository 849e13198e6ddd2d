// SPDX-License-Identifier: MIT
// LU factorisation of a matrix whose pattern is known at compile time: pivots on the diagonal, in an order that keeps
// the factors sparse, and no operation with an entry that is always zero.
#pragma once

#include "myriad/kernel/core/table_loop.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"
#include "myriad/kernel/model/mass_matrix.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail {

/// Most updates for which a GPU's code is written out.
inline constexpr int most_updates = 4096;

/// The pattern of the factors of a matrix with the given entries and a full diagonal, and the order of its pivots: in
/// each step the one of least Markowitz count, (entries of its row - 1) (entries of its column - 1), among those left
/// (Markowitz, Management Science 3, 1957, 255; Duff, Erisman and Reid, Direct Methods for Sparse Matrices, 7.2). Of
/// several, the one that has to wait for the fewest steps before it: then many steps do not depend on each other, and a
/// processor overlaps them. In a ring of 32 states the longest chain has 6 steps instead of 17; a solve with a ring of
/// 64 has 28 instead of 122 operations in a row.
template <int n>
struct symbolic_lu {
    int pivot[n]{};          // the row and column that are eliminated in each step
    number_set<n> right[n];  // of each step: the columns right of the pivot
    number_set<n> below[n];  // and the rows below it
    int lower = 0;           // entries below the diagonal of the factors
    int upper = 0;           // and above it
    int updates = 0;         // multiplications and subtractions of the factorisation

    template <class Entries>
    constexpr symbolic_lu(const Entries& entries, int length) {
        number_set<n> row[n]{}, column[n]{};
        for (int e = 0; e < length; ++e) {
            if (entries[e].row == entries[e].column) continue;
            row[entries[e].row].insert(entries[e].column);
            column[entries[e].column].insert(entries[e].row);
        }
        bool done[n]{};
        int depth[n]{};  // of each row: the number of steps before it that follow on each other
        for (int step = 0; step < n; ++step) {
            int best = -1, least = 0;
            for (int k = 0; k < n; ++k) {
                if (done[k]) continue;
                const int count = row[k].size() * column[k].size();
                if (best < 0 || count < least || (count == least && depth[k] < depth[best])) best = k, least = count;
            }
            done[best] = true;
            pivot[step] = best;
            right[step] = row[best];
            below[step] = column[best];
            lower += below[step].size();
            upper += right[step].size();
            updates += least;
            if (updates > most_updates) return;  // the factors will be dense; a compiler may not have the patience
            for (int k = 0; k < n; ++k) {
                if ((below[step].contains(k) || right[step].contains(k)) && depth[k] <= depth[best])
                    depth[k] = depth[best] + 1;
                if (below[step].contains(k)) {
                    row[k].insert(row[best]);
                    row[k].erase(k), row[k].erase(best);
                }
                if (right[step].contains(k)) {
                    column[k].insert(column[best]);
                    column[k].erase(k), column[k].erase(best);
                }
            }
        }
    }
};

/// What a factorisation and its solves do, as tables. Entries of the factors are numbered in the order in which a solve
/// reads them, so that a GPU's thread loads several at a time: those below the pivots from the first step on, then
/// those right of the pivots and the pivots themselves from the last step back. An update subtracts from an entry the
/// product of one below a pivot and one right of it.
template <int n, int n_lower, int n_upper, int n_update, int n_given>
struct lu_tables {
    static constexpr int n_entry = n + n_lower + n_upper;
    int pivot[n]{};                                  // the row of each step
    int diagonal[n]{};                               // the entry of each row's pivot
    int lower_begin[n + 1]{}, upper_begin[n + 1]{};  // of each step, in the following
    int lower_entry[n_lower + 1]{}, lower_row[n_lower + 1]{};
    int upper_entry[n_upper + 1]{}, upper_column[n_upper + 1]{};
    int first_update[n_lower + 1]{};  // of each lower entry, less the number of its step's first upper one
    int target[n_update + 1]{};       // the entry that each update changes
    int target_row[n_update + 1]{};   // its row if it is a pivot, else -1
    int position[n_given]{};          // of the entries that are given
    int pivot_row[n_given]{};         // the row of a pivot on the diagonal, else -1

    template <class Entries>
    constexpr lu_tables(const symbolic_lu<n>& symbolic, const Entries& entries) {
        short number[n][n]{};
        int next = 0;
        for (int s = 0; s < n; ++s) {
            const int k = symbolic.pivot[s];
            pivot[s] = k;
            lower_begin[s + 1] = lower_begin[s];
            for (int i = 0; i < n; ++i) {
                if (!symbolic.below[s].contains(i)) continue;
                lower_row[lower_begin[s + 1]] = i;
                lower_entry[lower_begin[s + 1]++] = number[i][k] = static_cast<short>(next++);
            }
            upper_begin[s + 1] = upper_begin[s] + symbolic.right[s].size();
        }
        for (int s = n - 1; s >= 0; --s) {
            const int k = pivot[s];
            int u = upper_begin[s];
            for (int j = 0; j < n; ++j) {
                if (!symbolic.right[s].contains(j)) continue;
                upper_column[u] = j;
                upper_entry[u++] = number[k][j] = static_cast<short>(next++);
            }
            diagonal[k] = number[k][k] = static_cast<short>(next++);
        }
        int q = 0;
        for (int s = 0; s < n; ++s) {
            for (int l = lower_begin[s]; l < lower_begin[s + 1]; ++l) {
                first_update[l] = q - upper_begin[s];
                for (int u = upper_begin[s]; u < upper_begin[s + 1]; ++u, ++q) {
                    target[q] = number[lower_row[l]][upper_column[u]];
                    target_row[q] = lower_row[l] == upper_column[u] ? lower_row[l] : -1;
                }
            }
        }
        for (int e = 0; e < n_given; ++e) {
            position[e] = number[entries[e].row][entries[e].column];
            pivot_row[e] = entries[e].row == entries[e].column ? entries[e].row : -1;
        }
    }
};

template <class Model>
inline constexpr symbolic_lu<n_state<Model>> symbolic_lu_of{matrix_entries_of<Model>, n_matrix_entry<Model>};
template <class Model>
inline constexpr lu_tables<n_state<Model>, symbolic_lu_of<Model>.lower, symbolic_lu_of<Model>.upper,
                           symbolic_lu_of<Model>.updates, n_matrix_entry<Model>>
    lu_tables_of{symbolic_lu_of<Model>, matrix_entries_of<Model>};

/// Whether no entry on the diagonal of a stiff method's matrix is always zero. With a mass matrix there may be one, if
/// an algebraic equation does not contain the state of its own number.
template <class Model>
constexpr bool has_full_diagonal() {
    if constexpr (has_mass_matrix<Model>) {
        number_set<n_state<Model>> diagonal;
        for (const jacobian_entry& e : matrix_entries_of<Model>.entry)
            if (e.row == e.column) diagonal.insert(e.row);
        return diagonal.size() == n_state<Model>;
    } else {
        return true;
    }
}

/// Whether stiff methods use the pattern of the Jacobian: beyond the sizes whose dense, pivoted factors stay in
/// registers, and as long as the code that is written out does not become too long.
template <class Model>
constexpr bool factorises_sparsely_of() {
    if constexpr (n_state < Model >> 6) {
        if constexpr (n_jacobian_entry < Model >> 0)
            return has_full_diagonal<Model>() && symbolic_lu_of<Model>.updates <= most_updates;
    }
    return false;
}
template <class Model>
inline constexpr bool factorises_sparsely = factorises_sparsely_of<Model>();

template <class Model>
constexpr int n_factor_entry_of() {
    constexpr int n = n_state<Model>;
    if constexpr (factorises_sparsely<Model>) {
        return n + symbolic_lu_of<Model>.lower + symbolic_lu_of<Model>.upper;
    } else {
        return n * n;
    }
}
/// Number of entries of a stiff method's factors.
template <class Model>
inline constexpr int n_factor_entry = n_factor_entry_of<Model>();

}  // namespace myriad::detail

namespace myriad::detail::inline MYRIAD_TARGET {

// What packs write out: loops through tables wait for each sum, which is stored and read again. Longer code than this
// takes a compiler too long.

/// Most operations of a factorisation and a solve.
inline constexpr int most_pack_operations = 1024;
/// Most slopes, of all evaluations of rhs for the Jacobian.
inline constexpr int most_pack_slopes = 512;

/// Whether the code of factorisation and solves is written out. That for one lane always is: its numbers lie in
/// registers or at fixed places of a GPU's local memory.
template <class Model, class S>
inline constexpr bool writes_out_factors =
    lanes_of<S> == 1 || symbolic_lu_of<Model>.updates + n_factor_entry<Model> <= most_pack_operations;
/// Whether that of the Jacobian is.
template <class Model, class S>
inline constexpr bool writes_out_jacobian =
    lanes_of<S> == 1 || jacobian_groups_of<Model>.count* n_state<Model> <= most_pack_slopes;

/// The matrix, replaced by its factors in `factorise`: the multipliers below the pivots, the reciprocals of the pivots,
/// and what is right of them.
template <class Model, class S>
struct sparse_lu_factors {
    using tables = std::remove_cv_t<decltype(lu_tables_of<Model>)>;
    using loop = table_loop<writes_out_factors<Model, S>>;
    /// Element i of a table.
    template <auto table, class I>
    static MYRIAD_FUNCTION auto at(I i) {
        return loop::template at<lu_tables_of<Model>, table>(i);
    }
    /// The elements of step s in a table.
    template <auto begin, class I, class F>
    static MYRIAD_FUNCTION void of_step(I s, F&& f) {
        loop::template between<lu_tables_of<Model>, begin>(s, f);
    }

    S a[tables::n_entry];
    S size[n_state<Model>];  // of each pivot's row: the sum of the sizes of the terms that add up to the pivot
};

/// The part of its terms that must be left of a pivot: with less, rounding errors of the terms are a larger part of the
/// pivot than the root of the resolution.
template <class R>
inline constexpr R least_pivot = std::is_same_v<R, float> ? R(0x1p-11) : R(0x1p-26);

/// For factors that are used where they were made.
struct keep_nothing {
    template <class I, class S>
    MYRIAD_FUNCTION void operator()(I, const S&) const {}
};

/// Factorises `lu.a`, and calls `keep(entry, value)` as soon as an entry has its last value. Returns false in lanes
/// with a pivot that is not finite or that cancellation has made too small: a test that scaling a state does not
/// change.
template <class Model, class S, class Keep = keep_nothing>
MYRIAD_FUNCTION mask_of<S> factorise(sparse_lu_factors<Model, S>& lu, Keep&& keep = {}) {
    using R = real_of<S>;
    using lu_type = sparse_lu_factors<Model, S>;
    using tables = typename lu_type::tables;
    using loop = typename lu_type::loop;
    auto& a = lu.a;
    mask_of<S> regular = mask_of<S>(true);
    loop::template range<0, n_state<Model>>([&](auto s) MYRIAD_LAMBDA {
        const auto row = lu_type::template at<&tables::pivot>(s);
        const auto d = lu_type::template at<&tables::diagonal>(row);
        const S pivot_size = abs(a[d]);
        // Not a division, whose branch for extreme numbers would keep a GPU from overlapping steps.
        const S inverse = reciprocal(a[d]);
        regular = regular & (pivot_size > S(least_pivot<R>) * lu.size[row]) & (abs(inverse) > S(R(0)));
        a[d] = inverse;
        keep(d, inverse);
        if constexpr (!std::is_same_v<std::remove_cvref_t<Keep>, keep_nothing>) {
            lu_type::template of_step<&tables::upper_begin>(s, [&](auto u) MYRIAD_LAMBDA {
                const auto entry = lu_type::template at<&tables::upper_entry>(u);
                keep(entry, a[entry]);
            });
        }
        lu_type::template of_step<&tables::lower_begin>(s, [&](auto l) MYRIAD_LAMBDA {
            const auto entry = lu_type::template at<&tables::lower_entry>(l);
            const S multiplier = a[entry] * inverse;
            a[entry] = multiplier;
            keep(entry, multiplier);
            lu_type::template of_step<&tables::upper_begin>(s, [&](auto u) MYRIAD_LAMBDA {
                const auto update = loop::sum(lu_type::template at<&tables::first_update>(l), u);
                const auto target = lu_type::template at<&tables::target>(update);
                const auto target_row = lu_type::template at<&tables::target_row>(update);
                const S right = a[lu_type::template at<&tables::upper_entry>(u)];
                a[target] = fma(-multiplier, right, a[target]);
                if (target_row >= 0) lu.size[target_row] = fma(abs(multiplier), abs(right), lu.size[target_row]);
            });
        });
    });
    return regular;
}

/// Solves A x = b with the entries of A's factors; x replaces b.
template <class Model, class S>
MYRIAD_FUNCTION void solve_in_place(const S* a, vec<S, n_state<Model>>& b) {
    using lu_type = sparse_lu_factors<Model, S>;
    using tables = typename lu_type::tables;
    using loop = typename lu_type::loop;
    loop::template range<0, n_state<Model>>([&](auto s) MYRIAD_LAMBDA {
        const S x = b[lu_type::template at<&tables::pivot>(s)];
        lu_type::template of_step<&tables::lower_begin>(s, [&](auto l) MYRIAD_LAMBDA {
            const auto row = lu_type::template at<&tables::lower_row>(l);
            b[row] = fma(-a[lu_type::template at<&tables::lower_entry>(l)], x, b[row]);
        });
    });
    loop::template range_backwards<0, n_state<Model>>([&](auto s) MYRIAD_LAMBDA {
        const auto row = lu_type::template at<&tables::pivot>(s);
        S x = b[row];
        lu_type::template of_step<&tables::upper_begin>(s, [&](auto u) MYRIAD_LAMBDA {
            const auto column = lu_type::template at<&tables::upper_column>(u);
            x = fma(-a[lu_type::template at<&tables::upper_entry>(u)], b[column], x);
        });
        b[row] = x * a[lu_type::template at<&tables::diagonal>(row)];
    });
}
/// The same out of line, as it is called in each stage. All of x stays in registers.
template <class Model, class S>
MYRIAD_LARGE_FUNCTION void solve_out_of_line(const S* a, vec<S, n_state<Model>>& b) {
    auto x = b;
    solve_in_place<Model>(a, x);
    b = x;
}
template <class Model, class S>
MYRIAD_FUNCTION void solve_factorised(const S* a, vec<S, n_state<Model>>& b) {
    if constexpr (lanes_of < S >> 1 && writes_out_factors<Model, S>) {
        solve_out_of_line<Model>(a, b);
    } else {
        solve_in_place<Model>(a, b);
    }
}
template <class Model, class S>
MYRIAD_FUNCTION void solve_factorised(const sparse_lu_factors<Model, S>& lu, vec<S, n_state<Model>>& b) {
    solve_factorised<Model>(lu.a, b);
}
/// Solves A^T x = b with the factors of A; x replaces b.
template <class Model, class S>
MYRIAD_LARGE_FUNCTION void solve_transposed(const sparse_lu_factors<Model, S>& lu, vec<S, n_state<Model>>& b) {
    using lu_type = sparse_lu_factors<Model, S>;
    using tables = typename lu_type::tables;
    using loop = typename lu_type::loop;
    loop::template range<0, n_state<Model>>([&](auto s) MYRIAD_LAMBDA {
        const auto row = lu_type::template at<&tables::pivot>(s);
        const S x = b[row] * lu.a[lu_type::template at<&tables::diagonal>(row)];
        lu_type::template of_step<&tables::upper_begin>(s, [&](auto u) MYRIAD_LAMBDA {
            const auto column = lu_type::template at<&tables::upper_column>(u);
            b[column] = fma(-lu.a[lu_type::template at<&tables::upper_entry>(u)], x, b[column]);
        });
        b[row] = x;
    });
    loop::template range_backwards<0, n_state<Model>>([&](auto s) MYRIAD_LAMBDA {
        const auto row = lu_type::template at<&tables::pivot>(s);
        S x = b[row];
        lu_type::template of_step<&tables::lower_begin>(s, [&](auto l) MYRIAD_LAMBDA {
            x = fma(-lu.a[lu_type::template at<&tables::lower_entry>(l)],
                    b[lu_type::template at<&tables::lower_row>(l)], x);
        });
        b[row] = x;
    });
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
