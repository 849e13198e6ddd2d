// SPDX-License-Identifier: MIT
// The argument of a trigger's condition: on which side of zero the event functions are.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// `positive[j]`: whether event function j is positive. At its event it is on the side to which it goes, however
/// closely it was located; at the start of the first phase, and where an action put it, zero counts as positive, until
/// nothing else is to be done at that instant. Then it is on the side to which it goes.
template <detail::extent events>
class event_signs {
public:
    /// Made by the library.
    MYRIAD_FUNCTION explicit event_signs(const detail::mask_set<bool, events>& positive) : positive_(positive) {}
    /// Whether event function j is positive.
    MYRIAD_FUNCTION bool operator[](int j) const { return positive_[j]; }

private:
    detail::mask_set<bool, events> positive_;
};

}  // namespace myriad::inline MYRIAD_TARGET
