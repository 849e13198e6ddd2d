// SPDX-License-Identifier: MIT
// The note on phases that are too long for the smallest Lyapunov exponent. Compiled in the library. Host code only.
#pragma once

#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Where a model with tangents has what, and how it is integrated.
struct tangent_places {
    int n_original;        ///< states of the model without tangents, which are the first
    int n_vectors;         ///< tangent vectors
    int first_growth;      ///< the accessory with the growth of the first; the others follow
    int transient_phases;  ///< the shared integer with the number of phases that do not count
    bool adaptive;         ///< whether steps follow tolerances
};

/// Adds a note if the growth of tangents within a phase differs so much that the steps' errors, amplified along the
/// fastest, may be visible in the slowest: from a thousand or so instances. In measurements (docs/numerics.md)
/// exponents were right where the product is below the limit, and above it off by ten to a hundred times the product,
/// if at all: the product uses mean growth, and local growth may exceed it.
template <class R>
void note_exponents(report_of<R>& r, const ensemble_data<R>& e, const options& o, const tangent_places& in);

extern template void note_exponents(report_of<double>&, const ensemble_data<double>&, const options&,
                                    const tangent_places&);
extern template void note_exponents(report_of<float>&, const ensemble_data<float>&, const options&,
                                    const tangent_places&);

}  // namespace myriad::host::inline MYRIAD_ABI
