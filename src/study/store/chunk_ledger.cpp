// SPDX-License-Identifier: MIT
// Counts chunks and what their records say.
#include "chunk_ledger.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "myriad/study/store/file_system.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

std::size_t place(std::int64_t chunk) { return static_cast<std::size_t>(chunk); }

}  // namespace

chunk_ledger::chunk_ledger(const layout& content) : content_(content) {
    finished_.assign(place(content.chunks()), false);
    spoiled_ = counted_ = finished_;
}

bool chunk_ledger::is_finished(std::int64_t chunk) const {
    const std::lock_guard lock(mutex_);
    return finished_[place(chunk)];
}

std::int64_t chunk_ledger::finished() const {
    const std::lock_guard lock(mutex_);
    return finished_count_;
}

bool chunk_ledger::complete() const { return finished() == content_.chunks(); }

void chunk_ledger::begin_look() {
    const std::lock_guard lock(mutex_);
    committed_.clear();
}

void chunk_ledger::end_look(const std::vector<std::string>& names) {
    std::vector<bool> now(finished_.size(), false);
    for (const std::string& name : names) {
        const std::optional<std::int64_t> chunk = number_in(name, ".json");
        if (chunk && *chunk >= 0 && *chunk < content_.chunks()) now[place(*chunk)] = true;
    }
    const std::lock_guard lock(mutex_);
    spoiled_.assign(spoiled_.size(), false);
    for (const std::int64_t chunk : committed_) now[place(chunk)] = true;
    bool lost = false;  // put back by another process
    for (std::size_t i = 0; i < now.size() && !lost; ++i) lost = counted_[i] && !now[i];
    if (lost) forget_counts();
    finished_ = std::move(now);
    finished_count_ = std::count(finished_.begin(), finished_.end(), true);
}

void chunk_ledger::finish(std::int64_t chunk, const chunk_record* record) {
    const std::lock_guard lock(mutex_);
    if (!finished_[place(chunk)]) ++finished_count_;
    finished_[place(chunk)] = true;
    committed_.push_back(chunk);
    if (record != nullptr) add(chunk, *record);
}

void chunk_ledger::count(std::int64_t chunk, const chunk_record& record) {
    const std::lock_guard lock(mutex_);
    add(chunk, record);
}

void chunk_ledger::add(std::int64_t chunk, const chunk_record& record) {
    if (counted_[place(chunk)]) return;
    counted_[place(chunk)] = true;
    counted_instances_ += range_of(content_, chunk).count;
    for (const auto& [name, number] : record.statuses) statuses_[name] += number;
    if (!record.device.empty()) device_names_.insert(record.device);
    const arithmetic& by = record.computed_by;
    if (!by.library.empty()) computed_by_.emplace(by.host + '\n' + by.text(), by);
    seconds_ += record.seconds;
}

void chunk_ledger::forget_counts() {
    counted_.assign(counted_.size(), false);
    counted_instances_ = 0;
    statuses_.clear();
    device_names_.clear();
    computed_by_.clear();
    seconds_ = 0.0;
}

void chunk_ledger::put_back(std::int64_t chunk) {
    const std::lock_guard lock(mutex_);
    if (finished_[place(chunk)]) --finished_count_;
    finished_[place(chunk)] = false;
    if (counted_[place(chunk)]) forget_counts();
}

void chunk_ledger::spoil(std::int64_t chunk) {
    const std::lock_guard lock(mutex_);
    spoiled_[place(chunk)] = true;
}

std::vector<std::int64_t> chunk_ledger::uncounted() const {
    std::vector<std::int64_t> missing;
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < finished_.size(); ++i)
        if (finished_[i] && !counted_[i] && !spoiled_[i]) missing.push_back(static_cast<std::int64_t>(i));
    return missing;
}

store_progress chunk_ledger::progress() const {
    const std::lock_guard lock(mutex_);
    return {.chunks = finished_count_,
            .all_chunks = content_.chunks(),
            .instances = counted_instances_,
            .all_instances = content_.instances(),
            .seconds = seconds_,
            .statuses = {statuses_.begin(), statuses_.end()},
            .damaged = std::count(spoiled_.begin(), spoiled_.end(), true)};
}

std::vector<std::string> chunk_ledger::devices() const {
    const std::lock_guard lock(mutex_);
    return {device_names_.begin(), device_names_.end()};
}

std::vector<arithmetic> chunk_ledger::arithmetics() const {
    const std::lock_guard lock(mutex_);
    std::vector<arithmetic> all;
    for (const auto& [key, by] : computed_by_) all.push_back(by);
    return all;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
