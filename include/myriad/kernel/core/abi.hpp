// SPDX-License-Identifier: MIT
// The version in the names of what the compiled library and its headers share.
#pragma once

/// An inline namespace, so that files of another version do not link with the library, and two versions can be in one
/// process. Changes with include/myriad/version.hpp, which scripts/version.py checks.
#define MYRIAD_ABI v0_1_0
