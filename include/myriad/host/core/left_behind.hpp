// SPDX-License-Identifier: MIT
// Members of moved-from objects: those that would be copied by default become zero or free. Host code only.
#pragma once

#include <atomic>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// A number that is zero after it was moved from.
template <class T>
class moved_number {
public:
    moved_number(T value = {}) : value_(value) {}
    moved_number(moved_number&& other) noexcept : value_(std::exchange(other.value_, T{})) {}
    moved_number& operator=(moved_number&& other) noexcept {
        value_ = std::exchange(other.value_, T{});
        return *this;
    }
    operator T() const { return value_; }

private:
    T value_;
};

/// Whether a thread is using an object, which only one may do. A moved object is free.
class occupancy {
public:
    occupancy() = default;
    occupancy(occupancy&&) noexcept {}
    occupancy& operator=(occupancy&&) noexcept { return *this; }

    /// One thread's claim on the object, which ends with it.
    class claim {
    public:
        claim(const claim&) = delete;
        claim& operator=(const claim&) = delete;
        ~claim() { taken_.store(false, std::memory_order_release); }

    private:
        friend occupancy;
        explicit claim(std::atomic<bool>& taken) : taken_(taken) {}
        std::atomic<bool>& taken_;
    };
    /// Throws `error` with the message unless it is free.
    [[nodiscard]] claim take(const char* refusal) {
        require(!taken_.exchange(true, std::memory_order_acquire), refusal);
        return claim(taken_);
    }

private:
    std::atomic<bool> taken_{false};
};

}  // namespace myriad::host::inline MYRIAD_ABI
