// SPDX-License-Identifier: MIT
// Runs an ensemble with a given number of SIMD batches per pack; declared here for host files, instantiated in
// pack_sizes.cpp, whose flags the kernels need.
#pragma once

#include <myriad/host/backend/backend.hpp>

namespace properties {

/// Whether packs of three and four batches are compiled too. With events that takes minutes, so only nightly.
#if defined(MYRIAD_NIGHTLY)
template <class Model>
inline constexpr bool compiles_large_packs = true;
#else
template <class Model>
inline constexpr bool compiles_large_packs = !myriad::detail::has_events<Model>;
#endif

/// Like the backend, but with `batches` batches per pack; 0: one instance at a time.
template <class Model, class Method, class R>
myriad::detail::run_statistics run_with_packs(int batches, const myriad::detail::any_arguments<R>& arguments,
                                              const myriad::detail::run_options& options);

}  // namespace properties
