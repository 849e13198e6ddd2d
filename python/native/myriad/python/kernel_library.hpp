// SPDX-License-Identifier: MIT
// What a file that the Python package compiles includes after its model: MYRIAD_KERNEL_LIBRARY, which makes the shared
// object's one exported function.
#pragma once

#include "myriad/python/kernel_interface.hpp"
// after the interface, which needs no packs
#include "myriad/host/checks/behaviour.hpp"
#include "myriad/host/report/functions_of.hpp"
#include "myriad/kernel/stepper/method_check.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"
#include "myriad/openmp/packs.hpp"
#include "myriad/random.hpp"
#include "myriad/sensitivity.hpp"
#include "myriad/tangent.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class R>
void run_library(const void* arguments, const run_options* options, int most_threads, python::team_starter start,
                 run_statistics* result) {
    if (!computes_as_written()) {
        *result = {.computed_as_written = false};
        return;
    }
    *result = detail::run_packs<Model, Method, R, default_batches<Model, Method>()>(
        *static_cast<const any_arguments<R>*>(arguments), *options, most_threads,
        [start](openmp::team& all) { start(&all); });
}

template <class Model, class Method, class R>
inline constexpr instance_functions<R> functions_in_library = functions_of<Model, Method, R>();

template <class Model, class R>
inline constexpr behaviour_function<R> behaviour_in_library = &show_behaviour<Model, R>;

template <class Model, class Method, class R>
inline constexpr python::kernel_library library_of{
    .facts = compiled_facts_of<Model, Method, R>,
    .instruction_set = static_cast<std::int32_t>(openmp::instruction_set::MYRIAD_INSTRUCTION_SET),
    .run = &run_library<Model, Method, R>,
    .functions = &functions_in_library<Model, Method, R>,
    .behaviour = &behaviour_in_library<Model, R>,
};

}  // namespace myriad::detail::inline MYRIAD_TARGET

/// Makes the kernel of a model, a method and a real type the shared object's. The arguments may not contain commas.
#define MYRIAD_KERNEL_LIBRARY(Model, Method, R)                                                                       \
    static_assert(myriad::detail::check_linkage<Model, Method>());                                                    \
    static_assert(myriad::detail::check_method<Method>());                                                            \
    extern "C" __attribute__((visibility("default"))) const myriad::python::kernel_library* myriad_kernel_library() { \
        return &myriad::detail::library_of<Model, Method, R>;                                                         \
    }
