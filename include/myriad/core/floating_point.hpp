// SPDX-License-Identifier: MIT
// The floating-point environment in which everything is computed, whatever that of the caller is.
#pragma once

#include <cfenv>

#include "myriad/core/macros.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// As long as it lives, the thread rounds to nearest, keeps subnormal numbers and traps at nothing: idle lanes compute with
/// whatever they hold, and a result must not depend on who calls. What it finds, flags included, it puts back.
class default_arithmetic {
public:
    default_arithmetic() {
        std::fegetenv(&before_);
        std::fesetenv(FE_DFL_ENV);
    }
    default_arithmetic(const default_arithmetic&) = delete;
    default_arithmetic& operator=(const default_arithmetic&) = delete;
    ~default_arithmetic() { std::fesetenv(&before_); }

private:
    std::fenv_t before_;
};

}  // namespace myriad::inline MYRIAD_TARGET
