// SPDX-License-Identifier: MIT
// Gathers the pieces of a chunk.
#include "chunk_values.hpp"

#include <deque>
#include <span>
#include <string>
#include <utility>

#include "myriad/host/report/status_names.hpp"
#include "study_reductions.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

chunk_values::chunk_values(const study_plan& plan, const std::vector<bool>& wanted)
    : plan_(plan), wanted_(wanted), values_(plan.quantities.size()), reduced_(plan.reductions.size()) {}

void chunk_values::make_room(std::int64_t all, std::int64_t count) {
    // Written for no more than this part: a slow device may give the rest back.
    for (std::size_t q = 0; q < wanted_.size(); ++q) {
        if (!wanted_[q]) continue;
        const std::int64_t bytes = plan_.quantities[q].as.item_bytes();
        values_[q].reserve(static_cast<std::size_t>(all * bytes));
        values_[q].resize(static_cast<std::size_t>(count * bytes));
    }
}

void chunk_values::take(chunk_solver& solver, std::int64_t at, const solved& piece) {
    solved how = how_;
    how.add(piece);
    for (std::size_t q = 0; q < wanted_.size(); ++q)
        if (wanted_[q])
            solver.copy(plan_.quantities[q],
                        &values_[q][static_cast<std::size_t>(at * plan_.quantities[q].as.item_bytes())]);
    // Beside what there is, which takes their place when nothing can fail any more.
    std::vector<std::unique_ptr<reduction_state>> reduced(plan_.reductions.size());
    for (std::size_t r = 0; r < reduced.size(); ++r) {
        auto sum = plan_.reductions[r].start();
        if (!solver.reduce(r, *sum)) continue;
        if (reduced_[r] != nullptr) sum->add(std::span<const double>(reduced_[r]->partial()));
        reduced[r] = std::move(sum);
    }
    for (std::size_t r = 0; r < reduced.size(); ++r)
        if (reduced[r] != nullptr) std::swap(reduced_[r], reduced[r]);
    std::swap(how_, how);
}

void chunk_values::commit(result_keeper& keeper, std::int64_t chunk, chunk_record record) const {
    const chunk_range range = range_of(keeper.content(), chunk);
    std::vector<column> columns;
    std::vector<chunk_columns::column> all;
    for (std::size_t q = 0; q < values_.size(); ++q) {
        const quantity& is = plan_.quantities[q];
        if (values_[q].empty()) continue;
        all.push_back({&is.as, values_[q]});
        if (is.stored) columns.push_back({is.as.name, is.as.type, values_[q]});
    }
    std::deque<std::vector<double>> partial;
    std::deque<std::string> names;  // which columns refer to
    for (std::size_t r = 0; r < plan_.reductions.size(); ++r) {
        auto& found = partial.emplace_back(reduced_[r] != nullptr ? reduced_[r]->partial()
                                                                  : reduced_on_host(plan_.reductions[r], range, all));
        columns.push_back(column_of(names.emplace_back(partial_name(plan_.asked.reductions[r])), found));
    }
    for (std::size_t s = 0; s < how_.by_status.size(); ++s)
        if (how_.by_status[s] > 0)
            record.statuses.emplace_back(myriad::name_of(static_cast<myriad::status>(s)), how_.by_status[s]);
    keeper.commit(chunk, columns, record);
}

}  // namespace myriad::studies::inline MYRIAD_ABI
