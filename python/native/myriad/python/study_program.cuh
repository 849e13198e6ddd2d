// SPDX-License-Identifier: MIT
// What NVRTC compiles for studies of all models: the kernels that set instances along axes, and reduce what is kept.
#pragma once

#include "myriad/cuda/study_kernels.cuh"
