// SPDX-License-Identifier: MIT
// Things that are kept from one use to the next, since making them takes long. Host code only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace myriad::host {

/// Idle things of one kind, each with a key that says what it is good for. Threads may share it.
template <class Key, class T>
class kept {
public:
    /// The program's. Never destroyed: when a program ends, what they need, such as CUDA, may be gone first.
    static kept& all() {
        static kept* const one = new kept;
        return *one;
    }

    /// One with that key, no longer kept; null if there is none.
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
    /// Destroys the oldest one of those for which `concerns(key)` holds if there are more than `most` of them.
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

}  // namespace myriad::host
