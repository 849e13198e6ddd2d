// SPDX-License-Identifier: MIT
// The version, for programs and for the build, which reads it here.
#pragma once

#define MYRIAD_VERSION_MAJOR 0
#define MYRIAD_VERSION_MINOR 1
#define MYRIAD_VERSION_PATCH 0
#define MYRIAD_VERSION "0.1.0"

/// The inline namespace of what the compiled library and its headers share, so that files of another version do not
/// link with it, and two versions can be in one process.
#define MYRIAD_ABI v0_1_0
