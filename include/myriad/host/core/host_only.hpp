// SPDX-License-Identifier: MIT
// Refuses the host's headers in files that myriad_add_models compiles. Included before any header of Eigen.
#pragma once

#if defined(MYRIAD_MODEL_FILE)
#error \
    "This file is named in myriad_add_models and includes <myriad/myriad.hpp> or another header of the host, and \
Eigen with it. Model files get flags of their own, on which the memory layout of Eigen's objects depends: the \
program would end in a double free. In a model file include <myriad/model.hpp> and <myriad/instantiate.hpp>; \
name other files in add_executable"
#endif
