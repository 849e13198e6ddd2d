// SPDX-License-Identifier: MIT
// The interpreters, for all methods.
#include "tape_kernel.hpp"
#include "tape_model.hpp"

namespace myriad::python {

#define MYRIAD_TAPE_KERNEL(name, kind)                                                          \
    tape_kernel tape_##name##_##kind() {                                                        \
        using model = tape_models::kind;                                                        \
        using method = myriad::dense<myriad::name>;                                             \
        return {detail::facts_of<model, method, double>, detail::solves_linear_systems<method>, \
                &detail::run_library<model, method, double>,                                    \
                static_cast<std::int32_t>(openmp::instruction_set::MYRIAD_INSTRUCTION_SET)};    \
    }
#define MYRIAD_TAPE_KERNELS(kind) MYRIAD_TAPE_METHODS(MYRIAD_TAPE_KERNEL, kind)
MYRIAD_TAPE_KINDS(MYRIAD_TAPE_KERNELS)
#undef MYRIAD_TAPE_KERNELS
#undef MYRIAD_TAPE_KERNEL

}  // namespace myriad::python
