// SPDX-License-Identifier: MIT
// The version, for programs and for the build, which reads it here.
#pragma once

/// First number of the version.
#define MYRIAD_VERSION_MAJOR 0
/// Second number of the version.
#define MYRIAD_VERSION_MINOR 1
/// Third number of the version.
#define MYRIAD_VERSION_PATCH 0
/// The version as text, its three numbers separated by points.
#define MYRIAD_VERSION "0.1.0"
