// SPDX-License-Identifier: MIT
// Results in memory, and a store's behind the same interface.
#include "myriad/study/run/result_keeper.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <mutex>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/host/memory/memory_need.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

class memory_results final : public results {
public:
    explicit memory_results(layout content) : content_(std::move(content)) {
        content_.check();
        host::memory_need need;
        need.add("results", static_cast<double>(content_.bytes()));
        need.check(message("a study of ", content_.instances(), " instances"),
                   "give it a folder for its results, keep less, or reduce it");
        for (const variable& v : content_.variables) {
            auto& bytes = values_.emplace_back(static_cast<std::size_t>(content_.items(v) * v.item_bytes()));
            fill(v.type, bytes.data(), bytes.size() / size_of(v.type));
        }
        states_.resize(static_cast<std::size_t>(content_.chunks()));
    }

    const layout& content() const override { return content_; }
    bool done(std::int64_t chunk) const override {
        const std::lock_guard lock(mutex_);
        return states_[static_cast<std::size_t>(chunk)] == state::done;
    }
    bool written(std::string_view variable) const override {
        const std::lock_guard lock(mutex_);
        return std::find(written_.begin(), written_.end(), variable) != written_.end();
    }
    void read(std::string_view name, std::int64_t first, std::int64_t count, void* to) const override {
        const std::size_t number = content_.find(name);
        const variable& v = content_.variables[number];
        require(first >= 0 && count >= 0 && first <= content_.items(v) && count <= content_.items(v) - first, count,
                " items of ", name, " from item ", first, " on are asked for: there are ", content_.items(v));
        const std::lock_guard lock(mutex_);
        const auto size = static_cast<std::size_t>(v.item_bytes());
        const std::byte* const from = values_[number].data() + static_cast<std::size_t>(first) * size;
        std::copy_n(from, static_cast<std::size_t>(count) * size, static_cast<std::byte*>(to));
    }

    std::optional<std::int64_t> claim_next() {
        const std::lock_guard lock(mutex_);
        const auto found = std::find(states_.begin() + first_open_, states_.end(), state::open);
        first_open_ = found - states_.begin();
        if (found == states_.end()) return {};
        *found = state::claimed;
        return first_open_;
    }
    void set(std::int64_t chunk, bool is_done) {
        const std::lock_guard lock(mutex_);
        states_[static_cast<std::size_t>(chunk)] = is_done ? state::done : state::open;
        if (is_done) {
            ++chunks_done_;
            instances_done_ += range_of(content_, chunk).count;
        } else {
            first_open_ = std::min(first_open_, chunk);
        }
    }
    /// Without the lock, since nobody reads a chunk that is not done, nor writes one that is.
    void put(const column& values, std::int64_t first) {
        const std::size_t number = content_.find(values.variable);
        std::memcpy(&values_[number][static_cast<std::size_t>(first * content_.variables[number].item_bytes())],
                    values.bytes.data(), values.bytes.size());
    }
    void set_written(std::string_view variable) {
        const std::lock_guard lock(mutex_);
        written_.emplace_back(variable);
    }
    bool complete() const {
        const std::lock_guard lock(mutex_);
        return chunks_done_ == static_cast<std::int64_t>(states_.size());
    }
    std::int64_t instances_done() const {
        const std::lock_guard lock(mutex_);
        return instances_done_;
    }

private:
    enum class state : std::uint8_t { open, claimed, done };

    layout content_;
    std::vector<std::vector<std::byte>> values_;
    mutable std::mutex mutex_;
    std::vector<state> states_;
    std::vector<std::string> written_;
    std::int64_t first_open_ = 0;  // no chunk before it is open
    std::int64_t chunks_done_ = 0, instances_done_ = 0;
};

class memory_keeper final : public result_keeper {
public:
    explicit memory_keeper(const layout& content) : all_(std::make_shared<memory_results>(content)) {}

    const layout& content() const override { return all_->content(); }
    std::optional<std::int64_t> claim_next() override { return all_->claim_next(); }
    void commit(std::int64_t chunk, std::span<const column> columns, const chunk_record&) override {
        const layout& l = content();
        for (const column& c : columns) {
            const bool of_chunk = l.variables[l.find(c.variable)].extent == along::chunks;
            all_->put(c, of_chunk ? chunk : range_of(l, chunk).first);
        }
        all_->set(chunk, true);
    }
    void release(std::int64_t chunk) override { all_->set(chunk, false); }
    void write(const column& values) override {
        all_->put(values, 0);
        all_->set_written(values.variable);
    }
    bool complete() override { return all_->complete(); }
    std::int64_t instances_done() override { return all_->instances_done(); }
    std::shared_ptr<const results> kept() const override { return all_; }

private:
    std::shared_ptr<memory_results> all_;
};

class store_keeper final : public result_keeper {
public:
    store_keeper(const std::string& folder, const layout& content, const store_options& options,
                 std::function<std::int64_t()> counter)
        : store_(std::make_shared<store>(store::create_or_resume(folder, content, options))),
          counter_(std::move(counter)), counts_(counter_ != nullptr) {}

    const layout& content() const override { return store_->content(); }
    std::optional<std::int64_t> claim_next() override {
        while (counts_) {
            const std::int64_t chunk = counter_();
            if (chunk >= 0 && chunk < content().chunks()) {
                if (store_->claim(chunk)) return chunk;
            } else if (counts_.exchange(false)) {
                store_->refresh();  // what others have done meanwhile
            }
        }
        // What is left is with others, was given back, or lost with a process.
        return store_->claim_next();
    }
    void commit(std::int64_t chunk, std::span<const column> columns, const chunk_record& record) override {
        store_->commit(chunk, columns, record);
    }
    void release(std::int64_t chunk) override { store_->release(chunk); }
    void write(const column& values) override {
        if (!store_->written(values.variable)) store_->write(values);
    }
    std::vector<std::string> warnings() const override { return store_->warnings(); }
    bool complete() override {
        if (!store_->complete()) store_->refresh();
        return store_->complete();
    }
    std::int64_t instances_done() override { return store_->progress().instances; }
    std::shared_ptr<const results> kept() const override { return store_; }

private:
    std::shared_ptr<store> store_;
    std::function<std::int64_t()> counter_;
    std::atomic<bool> counts_;  // it is there and not at its end
};

}  // namespace

std::unique_ptr<result_keeper> keep_in_memory(const layout& content) {
    return std::make_unique<memory_keeper>(content);
}
std::unique_ptr<result_keeper> keep_in_store(const std::string& folder, const layout& content,
                                             const store_options& options, std::function<std::int64_t()> counter) {
    return std::make_unique<store_keeper>(folder, content, options, std::move(counter));
}

}  // namespace myriad::studies::inline MYRIAD_ABI
