// SPDX-License-Identifier: MIT
// Which device of a study takes how much, by the rates that were measured, so that a slow one does not make it longer.
// Host code only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "myriad/host/backend/device.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// Rates of devices, and what follows from them. Devices are numbered as they were given; all functions may be called
/// by several threads. Where all devices are equal GPUs, or there is one, each takes chunk after chunk as a whole.
/// Otherwise a CPU integrates every chunk in parts, and a GPU beside one of another kind its first chunk, until its
/// rate is known. A CPU gives a chunk back as soon as the others would be done with all that is left before it. Beside
/// a GPU that is soon done it is not even tried, since it costs some milliseconds to find out its rate.
class work_sharing {
public:
    /// `tried_after`: seconds that the GPUs have taken, or have left, before a CPU beside them is tried.
    work_sharing(const std::vector<device>& devices, std::int64_t chunk, double tried_after = 0.25);

    /// Instances, of the rest of a chunk, that a device is to integrate before it asks again; `left`: all that are not
    /// done in the study.
    std::int64_t part(std::size_t number, std::int64_t rest, std::int64_t left) const;
    /// What a part took on a device, in seconds.
    void measured(std::size_t number, std::int64_t instances, double seconds);
    /// A device gave a chunk back, of which it had done so many instances in so many seconds.
    void gave_back(std::size_t number, std::int64_t instances, double seconds);
    /// A device takes no part any more.
    void drop(std::size_t number);

    /// Whether it is known how fast a device is, or need not be: otherwise it should have one chunk alone.
    bool is_known(std::size_t number) const;
    /// Whether a device should begin, or go on with, the `rest` of what it has, where `left` are not done in the study.
    /// `now`: seconds since the run began. Always true of the fastest one whose rate is known.
    bool is_worthwhile(std::size_t number, std::int64_t rest, std::int64_t left, double now) const;
    /// Whether a device that has nothing to do would be done with a whole chunk before another is with the rest of its
    /// own, of which it has done so many instances in so many seconds.
    bool is_better_off_with(std::size_t idle, std::size_t other, std::int64_t rest, std::int64_t done,
                            double seconds) const;

private:
    struct pace {
        bool is_cpu = false, is_dropped = false;
        std::int64_t first_part = 0, last_part = 0;
        double per_second = 0;  // 0: not known
        double at_least = 0;    // in the last call
        int calls = 0;
    };
    struct others {
        double together = 0, fastest = 0;
        bool are_known = true;  // otherwise they are faster
        bool any = false;
    };
    others without(std::size_t number) const;

    mutable std::mutex mutex_;
    std::vector<pace> paces_;
    std::int64_t chunk_;
    double tried_after_;
    bool is_mixed_ = false, has_gpu_ = false;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
