// SPDX-License-Identifier: MIT
// The floating-point environment in which everything is computed, whatever the caller's is.
#pragma once

#include <cfenv>

#include "myriad/kernel/core/macros.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// During its lifetime the thread rounds to nearest, keeps subnormal numbers and does not trap: idle lanes compute with
/// arbitrary values, and a result must not depend on the caller. The destructor restores the previous environment,
/// flags included.
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

}  // namespace myriad::detail::inline MYRIAD_TARGET
