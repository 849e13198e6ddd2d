// SPDX-License-Identifier: MIT
// What moved-from objects are left with: members that by default would be copied are zero or free there. Host code only.
#pragma once

#include <atomic>
#include <utility>

#include "myriad/core/error.hpp"

namespace myriad::host {

/// A number that is zero in what it was moved out of.
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

/// Whether a thread is at work with an object, of which there may be one. What was moved is free.
class occupancy {
public:
    occupancy() = default;
    occupancy(occupancy&&) noexcept {}
    occupancy& operator=(occupancy&&) noexcept { return *this; }

    /// One thread's turn, which ends with it.
    class turn {
    public:
        turn(const turn&) = delete;
        turn& operator=(const turn&) = delete;
        ~turn() { taken_.store(false, std::memory_order_release); }

    private:
        friend occupancy;
        explicit turn(std::atomic<bool>& taken) : taken_(taken) {}
        std::atomic<bool>& taken_;
    };
    /// Throws `error` with the message unless it is free.
    [[nodiscard]] turn take(const char* refusal) {
        require(!taken_.exchange(true, std::memory_order_acquire), refusal);
        return turn(taken_);
    }

private:
    std::atomic<bool> taken_{false};
};

}  // namespace myriad::host
