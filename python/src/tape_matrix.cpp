// SPDX-License-Identifier: MIT
// The pattern of a tape's matrix, its groups of columns, and the order and tables of its factors.
#include "tape_matrix.hpp"

#include <algorithm>
#include <cstddef>
#include <set>

namespace myriad::python {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// How many multiplications sparse factors may take: as many as those of a model that is compiled, and of larger
/// matrices, whose tables no compiler has to make, a tenth of the n^3 / 3 that dense ones take.
std::size_t most_updates_of(int n) {
    const std::size_t size = at(n), dense = size * size * size / 3;
    return std::max(static_cast<std::size_t>(most_matrix_updates), dense / 10);
}

}  // namespace

stored_matrix::stored_matrix(int states, const tape_entries& entries) {
    for (const auto& [row, column] : entries) {
        row_.push_back(row);
        column_.push_back(column);
    }
    tables_.entries = static_cast<std::int32_t>(entries.size());
    tables_.row = row_.data(), tables_.column = column_.data();
    if (entries.empty()) return;
    group_columns(states);
    if (states > largest_dense_matrix) factorise(states);
}

/// Each column joins the first group with none of its rows (see `jacobian_groups`).
void stored_matrix::group_columns(int n) {
    std::vector<std::vector<int>> rows(at(n));
    for (std::size_t e = 0; e < row_.size(); ++e) rows[at(column_[e])].push_back(row_[e]);
    std::vector<std::vector<bool>> taken;
    for (int j = 0; j < n; ++j) {
        const auto meets = [&](const std::vector<bool>& group) {
            return std::any_of(rows[at(j)].begin(), rows[at(j)].end(), [&](int row) { return group[at(row)]; });
        };
        const auto found = std::find_if_not(taken.begin(), taken.end(), meets);
        const auto g = found - taken.begin();
        if (found == taken.end()) taken.emplace_back(at(n));
        for (const int row : rows[at(j)]) taken[static_cast<std::size_t>(g)][at(row)] = true;
        group_of_column_.push_back(static_cast<std::int32_t>(g));
    }
    begin_.push_back(0);
    for (std::size_t g = 0; g < taken.size(); ++g) {
        for (std::size_t e = 0; e < row_.size(); ++e)
            if (at(group_of_column_[at(column_[e])]) == g) in_group_.push_back(static_cast<std::int32_t>(e));
        begin_.push_back(static_cast<std::int32_t>(in_group_.size()));
    }
    tables_.groups = static_cast<std::int32_t>(taken.size());
    tables_.group_of_column = group_of_column_.data();
    tables_.begin = begin_.data(), tables_.in_group = in_group_.data();
}

/// The order of pivots of `symbolic_lu`, and the tables of `lu_tables`.
void stored_matrix::factorise(int n) {
    using places = std::set<int>;
    std::vector<places> row(at(n)), column(at(n)), right(at(n)), below(at(n));
    for (std::size_t e = 0; e < row_.size(); ++e) {
        if (row_[e] == column_[e]) continue;
        row[at(row_[e])].insert(column_[e]);
        column[at(column_[e])].insert(row_[e]);
    }
    numbers pivots;
    std::vector<bool> done(at(n));
    std::vector<int> depth(at(n));
    std::size_t updates = 0;
    const auto join = [](places& to, const places& from, int itself, int best) {
        to.insert(from.begin(), from.end());
        to.erase(itself), to.erase(best);
    };
    for (int step = 0; step < n; ++step) {
        int best = -1;
        std::size_t least = 0;
        for (int k = 0; k < n; ++k) {
            if (done[at(k)]) continue;
            const std::size_t count = row[at(k)].size() * column[at(k)].size();
            if (best < 0 || count < least || (count == least && depth[at(k)] < depth[at(best)]))
                best = k, least = count;
        }
        done[at(best)] = true;
        pivots.push_back(best);
        const places& its_row = right[at(step)] = row[at(best)];
        const places& its_column = below[at(step)] = column[at(best)];
        updates += least;
        if (updates > most_updates_of(n)) return;  // dense
        for (const places* of : {&its_row, &its_column})
            for (const int k : *of) depth[at(k)] = std::max(depth[at(k)], depth[at(best)] + 1);
        for (const int k : its_column) join(row[at(k)], its_row, k, best);
        for (const int k : its_row) join(column[at(k)], its_column, k, best);
    }
    std::vector<numbers> number(at(n), numbers(at(n)));
    std::int32_t next = 0;
    pivot_ = pivots;
    diagonal_.resize(at(n));
    lower_begin_.assign(1, 0), upper_begin_.assign(1, 0);
    for (int s = 0; s < n; ++s) {
        for (const int i : below[at(s)]) {
            lower_row_.push_back(i);
            lower_entry_.push_back(number[at(i)][at(pivots[at(s)])] = next++);
        }
        lower_begin_.push_back(static_cast<std::int32_t>(lower_row_.size()));
        upper_begin_.push_back(upper_begin_.back() + static_cast<std::int32_t>(right[at(s)].size()));
    }
    upper_entry_.resize(at(upper_begin_.back())), upper_column_.resize(at(upper_begin_.back()));
    for (int s = n - 1; s >= 0; --s) {
        const int k = pivots[at(s)];
        int u = upper_begin_[at(s)];
        for (const int j : right[at(s)]) {
            upper_column_[at(u)] = j;
            upper_entry_[at(u++)] = number[at(k)][at(j)] = next++;
        }
        diagonal_[at(k)] = number[at(k)][at(k)] = next++;
    }
    for (int s = 0; s < n; ++s) {
        for (int l = lower_begin_[at(s)]; l < lower_begin_[at(s + 1)]; ++l) {
            first_update_.push_back(static_cast<std::int32_t>(target_.size()) - upper_begin_[at(s)]);
            for (int u = upper_begin_[at(s)]; u < upper_begin_[at(s + 1)]; ++u) {
                const int i = lower_row_[at(l)], j = upper_column_[at(u)];
                target_.push_back(number[at(i)][at(j)]);
                target_row_.push_back(i == j ? i : -1);
            }
        }
    }
    for (std::size_t e = 0; e < row_.size(); ++e) {
        position_.push_back(number[at(row_[e])][at(column_[e])]);
        pivot_row_.push_back(row_[e] == column_[e] ? row_[e] : -1);
    }
    tables_.factor_entries = next;
    tables_.pivot = pivot_.data(), tables_.diagonal = diagonal_.data();
    tables_.lower_begin = lower_begin_.data(), tables_.upper_begin = upper_begin_.data();
    tables_.lower_entry = lower_entry_.data(), tables_.lower_row = lower_row_.data();
    tables_.upper_entry = upper_entry_.data(), tables_.upper_column = upper_column_.data();
    tables_.first_update = first_update_.data(), tables_.target = target_.data();
    tables_.target_row = target_row_.data(), tables_.position = position_.data();
    tables_.pivot_row = pivot_row_.data();
}

}  // namespace myriad::python
