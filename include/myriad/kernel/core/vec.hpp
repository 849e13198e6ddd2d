// SPDX-License-Identifier: MIT
// A vector of compile-time length: states, slopes, parameters, event values of one lane or one pack.
#pragma once

#include <type_traits>
#include <utility>

#include "myriad/kernel/core/macros.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

// A call that survives optimisation is a compile-time error. Not under nvcc, but the host compiler sees every model
// too.
#if !MYRIAD_FOR_GPU
// clang-format off
[[gnu::error("there is no component of this number: components are counted from 0 and named by the enumerators of "
             "their own enumeration")]] void no_such_component() noexcept;
// clang-format on
#endif

/// Returns the index. The compiler refuses an index that optimisation shows to be out of range; others are not checked.
template <extent size>
MYRIAD_FUNCTION int checked_index(int i) {
#if !MYRIAD_FOR_GPU
    if (__builtin_constant_p(i) && (i < 0 || i >= MYRIAD_LENGTH(size))) no_such_component();
#endif
    return i;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

// clang++ does not report where such a call was inlined; this makes it warn where the index is written.
#if defined(__clang__) && !MYRIAD_FOR_GPU
#define MYRIAD_WARN_OF_INDEX(i, size)                                                                             \
    _Pragma("clang diagnostic push") _Pragma("clang diagnostic ignored \"-Wgcc-compat\"")                         \
        __attribute__((diagnose_if((i) < 0 || (i) >= (size), "there is no component of this number", "warning"))) \
        _Pragma("clang diagnostic pop")
#else
#define MYRIAD_WARN_OF_INDEX(i, size)
#endif

namespace myriad::inline MYRIAD_TARGET {

/// The values that initialise a vector, one per component.
template <class S, class Components>
struct vec_values;
template <class S, int... c>
struct vec_values<S, std::integer_sequence<int, c...>> {
    template <int>
    using value = S;  // not a reference, as clang++ would then let a double become a float

    S values[sizeof...(c)];

    vec_values() = default;
    MYRIAD_FUNCTION vec_values(value<c>... v) : values{v...} {}
    // From an array, in a second pair of braces.
    template <int length>
    MYRIAD_FUNCTION vec_values(const S (&v)[length]) : values{v[c]...} {
        static_assert(
            length == sizeof...(c),
            "a vec is given as many values as it has components, a matrix as many rows: here are fewer, or more");
    }
};

/// `size` values of kind `S` (a real number, a pack or a dual number): `return {a, b};`, with one value per component,
/// or `{}` for zeros. Declared without braces, it is uninitialised. For a vector of one component write the type,
/// `return myriad::vec<S, 1>{a};`, as nvcc has rejected the short form in templates.
template <class S, detail::extent size>
struct vec : vec_values<S, std::make_integer_sequence<int, MYRIAD_LENGTH(size)>> {
    /// What holds the values.
    using base = vec_values<S, std::make_integer_sequence<int, MYRIAD_LENGTH(size)>>;
    using base::base;

    /// Uninitialised, or `size` values; any other number of values does not compile.
    vec() = default;
    // Selected for any other number of values, to give a readable error.
    template <class First, class... More>
    requires(1 + sizeof...(More) != size && std::is_convertible_v<First, S>)
        MYRIAD_FUNCTION vec(const First&, const More&...) {
        static_assert(
            1 + sizeof...(More) == size,
            "a vec is given as many values as it has components: rhs returns a slope for each state, events a "
            "value for each event, a matrix has a row in braces for each");
    }

    /// Component i, counted from 0. An index that is known to be out of range when the model is compiled is an error;
    /// others are not checked.
    MYRIAD_FUNCTION S& operator[](int i) MYRIAD_WARN_OF_INDEX(i, size) {
        return this->values[detail::checked_index<size>(i)];
    }
    MYRIAD_FUNCTION const S& operator[](int i) const MYRIAD_WARN_OF_INDEX(i, size) {
        return this->values[detail::checked_index<size>(i)];
    }
};

/// Empty: takes the place of parameters, accessories or events that a model does not have.
template <class S>
struct vec<S, 0> {
    // Needed to compile loops over no components; never called.
    /// Never called; an enumerator as index does not compile, with a message that names the missing enumeration.
    MYRIAD_FUNCTION S& operator[](int i) const {
        S* nothing = nullptr;
        return nothing[detail::checked_index<0>(i)];
    }
    template <class E>
    requires std::is_enum_v<E> MYRIAD_FUNCTION S& operator[](E) const {
        static_assert(
            !std::is_enum_v<E>,
            "the model has no components of this kind: end their enumeration with the enumerator that counts them, "
            "n_state, n_parameter, n_accessory, n_integer_accessory or n_event");
    }
};

}  // namespace myriad::inline MYRIAD_TARGET
