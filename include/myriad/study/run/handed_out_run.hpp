// SPDX-License-Identifier: MIT
// A run whose chunks are computed elsewhere, as in other processes: what goes there and back. Host code only.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/study_plan.hpp"
#include "myriad/study/run/chunk_solver.hpp"
#include "myriad/study/run/result_keeper.hpp"
#include "myriad/study/store/store.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The values of a chunk before they are stored: plain bytes.
struct computed_chunk {
    std::vector<std::pair<std::string, std::vector<std::byte>>> columns;  ///< by variable, as a store takes them
    chunk_record record;
    std::vector<statement> notes;  ///< of the report of `solve`
};

/// Hands out chunks and keeps what comes back, by `any_study::hand_out`. One thread uses it at a time.
class handed_out_run {
public:
    handed_out_run(study_plan plan, std::unique_ptr<result_keeper> keeper);

    /// What is in the results, with the size of chunks.
    const layout& content() const { return keeper_->content(); }
    /// The next chunk that is neither done nor claimed: `store::claim_next`.
    std::optional<std::int64_t> claim_next() { return keeper_->claim_next(); }
    /// Keeps a chunk that was claimed. Throws `error` if it is of another study, or if the store fails.
    void commit(std::int64_t chunk, const computed_chunk& values);
    /// Gives a claimed chunk back.
    void release(std::int64_t chunk) { keeper_->release(chunk); }
    /// Whether all chunks are done.
    bool complete() { return keeper_->complete(); }
    /// Instances whose chunks are done, by any process.
    std::int64_t instances_done() { return keeper_->instances_done(); }

    // For `any_study`.
    const study_plan& plan() const { return *plan_; }
    result_keeper& keeper() { return *keeper_; }
    std::int64_t instances() const { return instances_; }
    const solved& how() const { return how_; }

private:
    std::unique_ptr<const study_plan> plan_;
    std::unique_ptr<result_keeper> keeper_;
    std::int64_t instances_ = 0;  // committed
    solved how_;                  // of these
};

/// Keeps the values of one chunk in memory, and hands out no other.
class one_chunk_keeper final : public result_keeper {
public:
    one_chunk_keeper(const layout& content, std::int64_t chunk) : content_(content), chunk_(chunk) {}

    const layout& content() const override { return content_; }
    std::optional<std::int64_t> claim_next() override;
    void commit(std::int64_t chunk, std::span<const column> columns, const chunk_record& record) override;
    void release(std::int64_t) override {}
    void write(const column&) override {}
    bool complete() override { return false; }  // reductions need the other chunks
    std::int64_t instances_done() override { return 0; }
    std::shared_ptr<const results> kept() const override { return nullptr; }

    /// Whether it was committed; called by all threads.
    bool done() const { return done_; }
    computed_chunk values;  ///< once it is done

private:
    layout content_;
    std::int64_t chunk_;
    std::atomic<bool> claimed_{false}, done_{false};
};

}  // namespace myriad::studies::inline MYRIAD_ABI
