// SPDX-License-Identifier: MIT
// What host code that is compiled once, for all models, has to know of one. Host code only.
#pragma once

#include "myriad/host/model/numbering.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/model_facts.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// How many components of each kind a model has, and how messages name them.
struct model_shape : model_numbers {
#define MYRIAD_DECLARE_LABEL(kind, ...) component_label (*kind)(const model_shape&, int);
    MYRIAD_VALUE_KINDS(MYRIAD_DECLARE_LABEL)
#undef MYRIAD_DECLARE_LABEL
};
/// What a numbering calls component c of any model of that shape.
template <class Numbering>
component_label label_of(const model_shape&, int c) {
    return Numbering::label(c);
}
template <class Model>
inline constexpr model_shape shape_of{numbers_of<Model>,
#define MYRIAD_LABEL_OF(kind, ...) &label_of<kind##_numbering<Model>>,
                                      MYRIAD_VALUE_KINDS(MYRIAD_LABEL_OF)
#undef MYRIAD_LABEL_OF
};

}  // namespace myriad::host::inline MYRIAD_ABI
