// SPDX-License-Identifier: MIT
// The note on phases that are too long for the smallest Lyapunov exponent. Compiled in the library. Host code only.
#pragma once

#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/model_facts.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Adds a note if the growth of tangents within a phase differs so much that the steps' errors, amplified along the
/// fastest, may be visible in the slowest: from a thousand or so instances. In measurements (docs/numerics/tangents.md)
/// exponents were right where the product is below the limit, and above it off by ten to a hundred times the product,
/// if at all: the product uses mean growth, and local growth may exceed it.
template <class R>
void note_exponents(report_of<R>& r, const ensemble_data<R>& e, const options& o, const call_facts& facts);

}  // namespace myriad::host::inline MYRIAD_ABI
