// SPDX-License-Identifier: MIT
// What instances that take no further part were given when they ended, so that later calls can tell whether someone has
// set them anew since, who will want them integrated. Host code only.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// A digest of numbers by their bits.
class digest {
public:
    template <class R>
    void add(R value) {
        using bits = std::conditional_t<sizeof(R) == 8, std::uint64_t, std::uint32_t>;
        value_ = (value_ ^ std::bit_cast<bits>(value)) * 0x9e3779b97f4a7c15u;
        value_ ^= value_ >> 29;
    }
    bool operator==(const digest&) const = default;

private:
    std::uint64_t value_ = 0;
};

/// An instance that has ended, with its time domain then and a digest of its states and parameters.
template <class R>
struct ended_instance {
    std::int64_t index;
    digest inputs;
    R t_begin, t_end;
};

/// Those of an ensemble, in the order of their indices.
template <class R>
class ended_instances {
public:
    void clear() { all_.clear(); }
    /// Adds those for which `ended[i]` is 1 and that are not there yet; `make(i)` makes one.
    template <class Make>
    void add(const std::uint8_t* ended, std::int64_t size, Make&& make) {
        const auto there = static_cast<std::ptrdiff_t>(all_.size());
        std::ptrdiff_t next = 0;
        for (std::int64_t i = 0; i < size; ++i) {
            const void* const found = std::memchr(ended + i, 1, static_cast<std::size_t>(size - i));
            if (found == nullptr) break;
            i = static_cast<const std::uint8_t*>(found) - ended;
            while (next < there && all_[static_cast<std::size_t>(next)].index < i) ++next;
            if (next == there || all_[static_cast<std::size_t>(next)].index != i) all_.push_back(make(i));
        }
        std::inplace_merge(all_.begin(), all_.begin() + there, all_.end(),
                           [](const auto& a, const auto& b) { return a.index < b.index; });
    }
    /// The one with index i, or null.
    const ended_instance<R>* find(std::int64_t i) const {
        const auto at = std::lower_bound(all_.begin(), all_.end(), i,
                                         [](const auto& e, std::int64_t index) { return e.index < index; });
        return at != all_.end() && at->index == i ? &*at : nullptr;
    }
    auto begin() const { return all_.begin(); }
    auto end() const { return all_.end(); }

private:
    std::vector<ended_instance<R>> all_;
};

}  // namespace myriad::host::inline MYRIAD_ABI
