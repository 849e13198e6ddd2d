// SPDX-License-Identifier: MIT
// The body of run_with_packs, for the files that instantiate it: one per model, so that they compile in parallel.
#pragma once

#include <myriad/instantiate.hpp>

#include "tests/properties/models.hpp"
#include "tests/properties/pack_sizes.hpp"

namespace properties {

/// The backend's default size has its own kernel, compiled elsewhere.
template <class Model, class Method, class R, int batches>
myriad::detail::run_statistics run_with(const myriad::detail::any_arguments<R>& arguments,
                                        const myriad::detail::run_options& options) {
    if constexpr (batches == myriad::detail::default_batches<Model, Method>()) {
        using namespace myriad::openmp;
        return run_on<Model, Method, R>(for_set<instruction_set::MYRIAD_INSTRUCTION_SET>{}, arguments, options);
    } else {
        return myriad::detail::run_packs<Model, Method, R, batches>(arguments, options);
    }
}

template <class Model, class Method, class R>
myriad::detail::run_statistics run_with_packs(int batches, const myriad::detail::any_arguments<R>& arguments,
                                              const myriad::detail::run_options& options) {
    if (batches == 0) return run_with<Model, Method, R, 0>(arguments, options);
    if (batches == 1) return run_with<Model, Method, R, 1>(arguments, options);
    if constexpr (compiles_large_packs<Model>) {
        if (batches == 3) return run_with<Model, Method, R, 3>(arguments, options);
        if (batches == 4) return run_with<Model, Method, R, 4>(arguments, options);
    }
    return run_with<Model, Method, R, 2>(arguments, options);
}

}  // namespace properties

#define RUN_WITH_PACKS(Model, Method, R)                                                       \
    extern MYRIAD_BACKEND_KERNEL(Model, Method, R) template myriad::detail::run_statistics     \
    properties::run_with_packs<Model, Method, R>(int, const myriad::detail::any_arguments<R>&, \
                                                 const myriad::detail::run_options&);
