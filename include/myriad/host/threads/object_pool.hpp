// SPDX-License-Identifier: MIT
// A pool of idle objects that are expensive to create. Host code only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Idle objects of one type, each with a key that says what it can be used for. Thread-safe.
template <class Key, class T>
class object_pool {
public:
    /// The program's pool. Never destroyed: at exit, what the objects need, such as CUDA, may be gone first.
    static object_pool& all() {
        static object_pool* const one = new object_pool;
        return *one;
    }

    /// Removes and returns an object with that key; null if there is none.
    std::unique_ptr<T> take(const Key& key) {
        const std::lock_guard lock(mutex_);
        const auto place = std::find_if(idle_.begin(), idle_.end(), [&](const entry& e) { return e.first == key; });
        if (place == idle_.end()) return nullptr;
        std::unique_ptr<T> taken = std::move(place->second);
        idle_.erase(place);
        return taken;
    }
    void give(const Key& key, std::unique_ptr<T> thing) {
        const std::lock_guard lock(mutex_);
        idle_.emplace_back(key, std::move(thing));
    }
    /// Destroys the oldest object for which `concerns(key)` holds if there are more than `most` of them.
    template <class Concerns>
    void keep_at_most(std::size_t most, Concerns&& concerns) {
        const std::lock_guard lock(mutex_);
        const auto of_these = [&](const entry& e) { return concerns(e.first); };
        if (static_cast<std::size_t>(std::count_if(idle_.begin(), idle_.end(), of_these)) > most)
            idle_.erase(std::find_if(idle_.begin(), idle_.end(), of_these));
    }

private:
    using entry = std::pair<Key, std::unique_ptr<T>>;

    std::mutex mutex_;
    std::vector<entry> idle_;
};

}  // namespace myriad::host::inline MYRIAD_ABI
