// SPDX-License-Identifier: MIT
// What step-size control decides of a trial step.
#pragma once

#include "myriad/kernel/scalar/lanes.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// In the lanes that run; the loop carries it out.
template <class S>
struct step_decision {
    mask_of<S> accepted;  // the others are rejected
    S next;               // length of the next trial, signed; fixed steps keep theirs
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
