// SPDX-License-Identifier: MIT
// What a running study knows of each of its devices and threads, and what ends their work early.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/core/error.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

using clock = std::chrono::steady_clock;

inline double seconds_since(clock::time_point begin) {
    return std::chrono::duration<double>(clock::now() - begin).count();
}

/// A device, on which one thread integrates while another prepares the next chunk or stores the last one.
struct used_device {
    used_device(const device& d, std::size_t n) : where(d), number(n) {}

    const device where;
    const std::size_t number;
    std::mutex turn;  // of the thread that integrates
    std::atomic<bool> failed{false};
    statement why;                       // it failed
    std::atomic<bool> exploring{false};  // a thread has a CPU's first chunk, which shows how fast it is
};

/// What a thread has of a chunk.
struct thread_work {
    explicit thread_work(std::size_t d) : number(d) {}

    const std::size_t number;           // of its device
    std::atomic<std::int64_t> done{0};  // instances
    std::atomic<std::int64_t> rest{0};  // 0 if it has none
    std::atomic<clock::rep> begun{0};
    std::atomic<bool> is_wanted{false};  // by a device that is done with it earlier
};

/// Another thread has found that the device is lost.
class device_lost : public std::exception {};
/// The chunk under way is left, and the device has not failed.
class ended_early : public std::exception {};
/// The run is to end, and the chunk takes too long.
class given_up : public ended_early {};
/// Others are done with the chunk earlier.
class handed_back : public ended_early {};

}  // namespace myriad::studies::inline MYRIAD_ABI
