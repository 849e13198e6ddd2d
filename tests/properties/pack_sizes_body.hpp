// SPDX-License-Identifier: MIT
// The body of run_with_packs, for the files that instantiate it, one per model so that they compile side by side.
#pragma once

#include "tests/properties/pack_sizes.hpp"

#include <myriad/instantiate.hpp>

#include "tests/properties/models.hpp"

namespace properties {

template <class Model, class Method, class R>
myriad::run_statistics run_with_packs(int batches, const myriad::kernel_arguments<Model, R>& arguments,
                                      const myriad::run_options& options) {
    if (batches == 0) return myriad::run_packs<Model, Method, R, 0>(arguments, options);
    if (batches == 1) return myriad::run_packs<Model, Method, R, 1>(arguments, options);
    if constexpr (compiles_large_packs<Model>) {
        if (batches == 3) return myriad::run_packs<Model, Method, R, 3>(arguments, options);
        if (batches == 4) return myriad::run_packs<Model, Method, R, 4>(arguments, options);
    }
    return myriad::run_packs<Model, Method, R, 2>(arguments, options);
}

}  // namespace properties

#define RUN_WITH_PACKS(Model, Method, R)                                                  \
    template myriad::run_statistics properties::run_with_packs<Model, Method, R>(         \
        int, const myriad::kernel_arguments<Model, R>&, const myriad::run_options&);
