// SPDX-License-Identifier: MIT
// Five problems of the validation with their sensitivities.
#pragma once

#include <myriad/sensitivity.hpp>

#include "validation/problems/hires.hpp"
#include "validation/problems/lorenz.hpp"
#include "validation/problems/pollution.hpp"
#include "validation/problems/robertson.hpp"
#include "validation/problems/van_der_pol.hpp"

namespace validation {

using robertson_by = myriad::with_sensitivities<robertson, robertson::k1, robertson::k2, robertson::a>;
using pollution_by = myriad::with_sensitivities<pollution, pollution::k1>;
using hires_by = myriad::with_sensitivities<hires, hires::first>;
using van_der_pol_by = myriad::with_sensitivities<van_der_pol, van_der_pol::mu, van_der_pol::x>;
using lorenz_by = myriad::with_sensitivities<lorenz, lorenz::rho, lorenz::x>;

}  // namespace validation
