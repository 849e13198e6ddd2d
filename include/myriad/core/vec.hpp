// SPDX-License-Identifier: MIT
// A vector of compile-time length: states, slopes, parameters, event values of one lane or one pack.
#pragma once

#include "myriad/core/macros.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// `size` values of kind `S` (a real number, a pack or a dual number), an aggregate: `return {a, b};`. For a vector of
/// one component write the type, `return myriad::vec<S, 1>{a};`, since nvcc rejects the short form in templates.
template <class S, int size>
struct vec {
    S values[size];

    MYRIAD_FUNCTION constexpr S& operator[](int i) { return values[i]; }
    MYRIAD_FUNCTION constexpr const S& operator[](int i) const { return values[i]; }
};

/// Nothing: takes the place of parameters, accessories or events that a model does not have.
template <class S>
struct vec<S, 0> {
    // Named by loops over no components, never reached.
    MYRIAD_FUNCTION S& operator[](int i) const {
        S* nothing = nullptr;
        return nothing[i];
    }
};

}  // namespace myriad::inline MYRIAD_TARGET
