// SPDX-License-Identifier: MIT
// Asks whether a weak function was linked: what a backend provides is there only in programs built with it.
#pragma once

namespace myriad::host {

/// A weak function's address, which is null if nobody has defined it. (g++ takes the address of any function for not null.)
template <class F>
F* if_defined(F* function) {
    asm("" : "+r"(function));
    return function;
}

}  // namespace myriad::host
