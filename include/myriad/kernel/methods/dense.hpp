// SPDX-License-Identifier: MIT
// A method with dense output. A type of its own, so that kernels without dense output contain no code for it.
#pragma once

namespace myriad {

/// `Method` with samples along the trajectory, chosen by `options::samples`. Instantiate it where needed:
/// `MYRIAD_INSTANTIATE(duffing, myriad::dense<myriad::cash_karp>)`.
template <class Method>
struct dense : Method {
    /// How a method with dense output is recognised.
    static constexpr bool samples = true;
};

}  // namespace myriad

namespace myriad::detail {

/// Whether a method's kernels take samples.
template <class Method>
inline constexpr bool samples_trajectory = requires {
    Method::samples;
};

/// Whether a method has an interpolant of its own; for others it is the cubic Hermite polynomial.
template <class Method>
inline constexpr bool has_own_interpolant = requires {
    Method::interpolant_degree;
};

}  // namespace myriad::detail
