// SPDX-License-Identifier: MIT
// The OpenMP backend: the loop of the CPU, by teams of OpenMP.
#pragma once

#include <omp.h>

#include "myriad/host/backend/cpu_backend.hpp"
#include "myriad/openmp/packs.hpp"
#include "myriad/openmp/team.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Integrates the ensemble with packs of the given number of batches, by a team of OpenMP.
template <class Model, class Method, class R, int batches>
run_statistics run_packs(const any_arguments<R>& arguments, const run_options& options) {
    return run_packs<Model, Method, R, batches>(
        arguments, options, options.threads > 0 ? options.threads : omp_get_max_threads(), [](openmp::team& all) {
            openmp::in_parts(openmp::for_set<openmp::instruction_set::MYRIAD_INSTRUCTION_SET>{}, all);
        });
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::openmp {

template <class Model, class Method, class R, class Counts>
run_statistics run_on(for_set<instruction_set::MYRIAD_INSTRUCTION_SET>, const any_arguments<R>& arguments,
                      const run_options& options) {
    if (!computes_as_written()) return {.computed_as_written = false};
    return run_packs<Model, Method, R, default_batches<Model, Method>()>(arguments, options);
}

}  // namespace myriad::openmp

/// Compiles the kernel of one model, method and real type.
#define MYRIAD_BACKEND_KERNEL(Model, Method, R)                                           \
    template myriad::detail::run_statistics myriad::openmp::run_on<Model, Method, R>(     \
        myriad::openmp::for_set<myriad::openmp::instruction_set::MYRIAD_INSTRUCTION_SET>, \
        const myriad::detail::any_arguments<R>&, const myriad::detail::run_options&);

/// The same, and makes sure that no other file does so.
#define MYRIAD_BACKEND_INSTANTIATE(Model, Method, R)                                                             \
    template <>                                                                                                  \
    void myriad::detail::instantiated_in_one_file_alone<                                                         \
        myriad::openmp::for_set<myriad::openmp::instruction_set::MYRIAD_INSTRUCTION_SET>, Model, Method, R>() {} \
    MYRIAD_BACKEND_KERNEL(Model, Method, R)
