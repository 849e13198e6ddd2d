// SPDX-License-Identifier: MIT
// Which chunks of a store are done, as far as this process has seen, and what their records say together.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "myriad/study/plan/layout.hpp"
#include "myriad/study/store/store.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

// Functions may be called by several threads at a time.
class chunk_ledger {
public:
    explicit chunk_ledger(const layout& content);

    bool is_finished(std::int64_t chunk) const;
    std::int64_t finished() const;  // how many
    bool complete() const;

    // Before and after a look at the folder, which found the records of some chunks by these names.
    void begin_look();
    void end_look(const std::vector<std::string>& names);
    // A chunk is done; by this process, if there is a record.
    void finish(std::int64_t chunk, const chunk_record* record = nullptr);
    void count(std::int64_t chunk, const chunk_record& record);
    // It is not done any more.
    void put_back(std::int64_t chunk);
    // Its record is damaged, and stays.
    void spoil(std::int64_t chunk);
    // Those of which no record was counted.
    std::vector<std::int64_t> uncounted() const;

    store_progress progress() const;
    std::vector<std::string> devices() const;
    std::vector<arithmetic> arithmetics() const;

private:
    void add(std::int64_t chunk, const chunk_record& record);
    void forget_counts();

    const layout& content_;
    mutable std::mutex mutex_;
    std::vector<bool> finished_, counted_, spoiled_;  // spoiled: with a damaged record
    std::int64_t finished_count_ = 0, counted_instances_ = 0;
    std::map<std::string, std::int64_t> statuses_;
    std::set<std::string> device_names_;
    std::map<std::string, arithmetic> computed_by_;  // by host and arithmetic
    double seconds_ = 0.0;
    std::vector<std::int64_t> committed_;  // by this process, since the last look at the folder began
};

}  // namespace myriad::studies::inline MYRIAD_ABI
