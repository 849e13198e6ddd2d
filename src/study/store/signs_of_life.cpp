// SPDX-License-Identifier: MIT
// The watch over signs of life.
#include "myriad/study/store/signs_of_life.hpp"

#include <algorithm>

namespace myriad::studies::inline MYRIAD_ABI {

bool signs_of_life::is_silent(const std::string& who, std::int64_t sign) {
    using std::chrono::nanoseconds;
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    const auto [place, is_new] = seen_.try_emplace(who, seen{sign, now, nanoseconds(0)});
    seen& other = place->second;
    if (other.sign != sign) other = {sign, now, nanoseconds(0)};
    other.unchanged += std::min<nanoseconds>(now - other.looked, expiry_ / 4);
    other.looked = now;
    return other.unchanged > expiry_;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
