// SPDX-License-Identifier: MIT
// Robertson's chemical reaction, stiff.
#pragma once

#include <myriad/model.hpp>

#include "problems/robertson.hpp"

namespace validation {

/// Its first two rates differ between instances.
struct robertson : problems::robertson {
    enum parameter { k1, k2, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return slope<R>(y, p[k1], p[k2]);
    }
};

}  // namespace validation
