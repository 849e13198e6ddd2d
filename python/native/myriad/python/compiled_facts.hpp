// SPDX-License-Identifier: MIT
// What a model that was compiled at run time tells of itself: plain data, the same for kernels of CPUs and GPUs.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/facts_of.hpp"
#include "myriad/kernel/stepper/matrix_facts_of.hpp"

namespace myriad::python {

/// Changes with what the core and compiled models exchange.
inline constexpr std::uint32_t interface_version = 11;

struct compiled_facts {
    std::uint32_t interface_version;
    std::int32_t real_bytes;  ///< of its real type: 8 or 4
    detail::model_numbers model;
    detail::call_facts call;
    matrix_facts matrix;
};

}  // namespace myriad::python

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class R>
inline constexpr python::compiled_facts compiled_facts_of{python::interface_version, sizeof(R), numbers_of<Model>,
                                                          facts_of<Model, Method, R>,
                                                          matrix_facts_of<Model, Method, R>};

}  // namespace myriad::detail::inline MYRIAD_TARGET
