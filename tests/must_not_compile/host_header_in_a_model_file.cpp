// expect: This file is named in myriad_add_models and includes <myriad/myriad.hpp>
// flags: -DMYRIAD_MODEL_FILE
// SPDX-License-Identifier: MIT
// main.cpp named in myriad_add_models, which defines MYRIAD_MODEL_FILE: Eigen comes with the header of the host.
#include "myriad/myriad.hpp"

int main() {}
