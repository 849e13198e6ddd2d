// SPDX-License-Identifier: MIT
// The methods with chosen step-size controls that the tests run.
#pragma once

#include <myriad/methods.hpp>

namespace choices {

using pi = myriad::dense<myriad::controlled<myriad::cash_karp, myriad::pi_control>>;
using pid =
    myriad::dense<myriad::controlled<myriad::cash_karp, myriad::pid_control, myriad::rms_norm, myriad::mixed_scale>>;
using averaged = myriad::dense<myriad::controlled<myriad::dormand_prince_5, myriad::rms_norm>>;
using automatic = myriad::dense<myriad::controlled<myriad::dormand_prince_5, myriad::automatic_first_step>>;
using high_order =
    myriad::dense<myriad::controlled<myriad::dormand_prince_8, myriad::pi_control, myriad::automatic_first_step>>;

using plain = myriad::controlled<myriad::dormand_prince_8, myriad::automatic_first_step>;
using scaled =
    myriad::controlled<myriad::dormand_prince_8, myriad::tolerance_per_instance, myriad::automatic_first_step>;

}  // namespace choices
