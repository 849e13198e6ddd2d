// SPDX-License-Identifier: MIT
// Where the chunks of a running study are handed out and their results kept: in memory, or in a store. Host code only.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/layout.hpp"
#include "myriad/study/store/store.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// All functions may be called by several threads; they do what the functions of `store` do.
class result_keeper {
public:
    virtual ~result_keeper() = default;
    virtual const layout& content() const = 0;
    virtual std::optional<std::int64_t> claim_next() = 0;
    virtual void commit(std::int64_t chunk, std::span<const column> columns, const chunk_record& record) = 0;
    virtual void release(std::int64_t chunk) = 0;
    virtual void write(const column& values) = 0;
    virtual bool complete() = 0;
    /// What may be wrong with what is there.
    virtual std::vector<std::string> warnings() const { return {}; }
    /// Instances whose chunks are done, by any process.
    virtual std::int64_t instances_done() = 0;
    /// The results; the keeper need not outlive them.
    virtual std::shared_ptr<const results> kept() const = 0;
};

/// Throws `error` if there is not enough memory.
std::unique_ptr<result_keeper> keep_in_memory(const layout& content);
/// Throws `error` as `store::create_or_resume`. With a counter, it says which chunk is claimed next: see
/// `any_study::chunk_counter`.
std::unique_ptr<result_keeper> keep_in_store(const std::string& folder, const layout& content,
                                             const store_options& options, std::function<std::int64_t()> counter = {});

}  // namespace myriad::studies::inline MYRIAD_ABI
