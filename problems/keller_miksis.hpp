// SPDX-License-Identifier: MIT
// The common parts of models of the Keller-Miksis bubble. Their right-hand sides round and cost differently, which
// those programs compare. examples/keller_miksis/constants.hpp has the sources and computes the constants.
#pragma once

#include <myriad/model.hpp>

namespace problems {

/// The dimensionless radius y and its slope v, over time in periods of the first forcing; C12 is the phase of the
/// second forcing in half turns.
struct keller_miksis {
    enum state { y, v, n_state };
    enum parameter { C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, n_parameter };
};

/// Stores the largest radius of each phase.
struct keller_miksis_with_peak : keller_miksis {
    static constexpr bool accessories_are_outputs = true;
    enum accessory { y_max, n_accessory };

    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[y_max] = lane.y[y]; }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[y_max] = myriad::max(lane.accessory[y_max], lane.y[y]);
    }
};

}  // namespace problems
