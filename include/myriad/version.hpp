// SPDX-License-Identifier: MIT
// The version, for programs and for the build, which reads it here.
#pragma once

#define MYRIAD_VERSION_MAJOR 0
#define MYRIAD_VERSION_MINOR 1
#define MYRIAD_VERSION_PATCH 0
#define MYRIAD_VERSION "0.1.0"
