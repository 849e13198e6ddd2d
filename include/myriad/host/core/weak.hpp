// SPDX-License-Identifier: MIT
// Tests whether a weak function was linked: a backend's functions exist only in programs built with it.
#pragma once

#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// A weak function's address, null if it is not defined. (g++ assumes that the address of a function is never null.)
template <class F>
F* if_defined(F* function) {
    asm("" : "+r"(function));
    return function;
}

}  // namespace myriad::host::inline MYRIAD_ABI
