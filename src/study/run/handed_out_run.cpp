// SPDX-License-Identifier: MIT
// Takes chunks back that others have computed.
#include "myriad/study/run/handed_out_run.hpp"

#include <algorithm>

#include "myriad/host/core/error.hpp"
#include "myriad/host/report/status_names.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

handed_out_run::handed_out_run(study_plan plan, std::unique_ptr<result_keeper> keeper)
    : plan_(std::make_unique<const study_plan>(std::move(plan))), keeper_(std::move(keeper)) {}

void handed_out_run::commit(std::int64_t chunk, const computed_chunk& values) {
    const layout& l = content();
    require(chunk >= 0 && chunk < l.chunks(), "there is no chunk ", chunk, " in a study of ", l.chunks());
    const chunk_range range = range_of(l, chunk);
    std::vector<column> columns;
    for (const auto& [name, bytes] : values.columns) {
        const variable& v = l.variables[l.find(name)];
        const std::int64_t items = v.extent == along::instances ? range.count : 1;
        const auto size = static_cast<std::size_t>(items * v.item_bytes());
        require(v.extent != along::nothing && bytes.size() == size, "the values of ", name, " in chunk ", chunk,
                " take ", bytes.size(), " bytes, not ", size, ": they are of another study");
        columns.push_back({v.name, v.type, bytes});
    }
    const auto of_chunks = [](const variable& v) { return v.extent != along::nothing; };
    require(std::cmp_equal(columns.size(), std::count_if(l.variables.begin(), l.variables.end(), of_chunks)), "chunk ",
            chunk, " has values of ", columns.size(), " variables: they are of another study");
    keeper_->commit(chunk, columns, values.record);
    instances_ += range.count;
    solved how{{}, values.notes};
    for (const auto& [name, count] : values.record.statuses)
        for (int s = 0; s < status_count; ++s)
            if (name == myriad::name_of(static_cast<status>(s))) how.by_status[static_cast<std::size_t>(s)] += count;
    how_.add(how);
}

std::optional<std::int64_t> one_chunk_keeper::claim_next() {
    if (claimed_.exchange(true)) return {};
    return chunk_;
}
void one_chunk_keeper::commit(std::int64_t, std::span<const column> columns, const chunk_record& record) {
    for (const column& c : columns)
        values.columns.emplace_back(c.variable, std::vector<std::byte>(c.bytes.begin(), c.bytes.end()));
    values.record = record;
    done_ = true;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
