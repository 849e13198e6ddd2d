// SPDX-License-Identifier: MIT
// A number that records what it depends on instead of its value: a right-hand side called with it, in a constant
// expression, gives the entries of its Jacobian that may differ from zero.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/function_list.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::inline MYRIAD_TARGET {

template <int size>
struct dependence;

/// The result of comparing dependences: no value, so that what asks for one is no constant expression. What is selected
/// by it depends on both choices, and a derivative does not see the comparison itself.
template <int size>
struct unknown_truth {
    using value_type = bool;
    using lane_type = bool;
    using pack_type = dependence<size>;

    unknown_truth() = default;
    MYRIAD_FUNCTION unknown_truth(bool) {}

    // Not defined, and so not constant: whatever a value decides ends the evaluation.
    explicit operator bool() const;
    static bool any(const unknown_truth&);
    static bool all(const unknown_truth&);
    static std::uint64_t bits(const unknown_truth&);
    static bool get_lane(const unknown_truth&, int);
    static void set_lane(unknown_truth&, int, bool);
    static MYRIAD_FUNCTION unknown_truth blend(const unknown_truth&, const unknown_truth&, const unknown_truth&) {
        return {};
    }

#define MYRIAD_UNKNOWN_OPERATOR(symbol)                                                                             \
    friend MYRIAD_FUNCTION unknown_truth operator symbol(const unknown_truth&, const unknown_truth&) { return {}; } \
    friend MYRIAD_FUNCTION unknown_truth operator symbol(const unknown_truth&, bool) { return {}; }                 \
    friend MYRIAD_FUNCTION unknown_truth operator symbol(bool, const unknown_truth&) { return {}; }
    MYRIAD_UNKNOWN_OPERATOR(&)
    MYRIAD_UNKNOWN_OPERATOR(|)
    MYRIAD_UNKNOWN_OPERATOR(^)
    MYRIAD_UNKNOWN_OPERATOR(&&)
    MYRIAD_UNKNOWN_OPERATOR(||)
    MYRIAD_UNKNOWN_OPERATOR(!=)
    MYRIAD_UNKNOWN_OPERATOR(==)
#undef MYRIAD_UNKNOWN_OPERATOR
    friend MYRIAD_FUNCTION unknown_truth operator!(const unknown_truth&) { return {}; }
    MYRIAD_FUNCTION unknown_truth& operator&=(const unknown_truth&) { return *this; }
    MYRIAD_FUNCTION unknown_truth& operator|=(const unknown_truth&) { return *this; }
    MYRIAD_FUNCTION unknown_truth& operator^=(const unknown_truth&) { return *this; }
};

/// The set of the `size` independent quantities by which a result has a derivative that may differ from zero; plain
/// numbers are constants. It is used like a pack: a model that packs can integrate compiles with it.
template <int size>
struct dependence {
    using value_type = double;  // of constants
    using lane_type = dependence;
    static constexpr int words = (size + 63) / 64;

    std::uint64_t on[words]{};  // bit i % 64 of word i / 64 for quantity i

    dependence() = default;
    MYRIAD_FUNCTION dependence(double) {}

    /// Its value: not defined, and so not constant.
    template <detail::plain_number T>
    explicit operator T() const;

    /// Quantity i itself.
    static MYRIAD_FUNCTION dependence of(int i) {
        dependence itself;
        itself.on[i / 64] = std::uint64_t(1) << (i % 64);
        return itself;
    }
    MYRIAD_FUNCTION bool contains(int i) const { return (on[i / 64] >> (i % 64) & 1) != 0; }
    /// What depends on both.
    static MYRIAD_FUNCTION dependence join(const dependence& a, const dependence& b) {
        dependence both;
        for (int w = 0; w < words; ++w) both.on[w] = a.on[w] | b.on[w];
        return both;
    }

    friend MYRIAD_FUNCTION dependence operator+(const dependence& a) { return a; }
    friend MYRIAD_FUNCTION dependence operator-(const dependence& a) { return a; }
#define MYRIAD_DEPENDENCE_OPERATOR(symbol)                                                                             \
    friend MYRIAD_FUNCTION dependence operator symbol(const dependence& a, const dependence& b) { return join(a, b); } \
    MYRIAD_FUNCTION dependence& operator symbol##=(const dependence& b) { return *this = join(*this, b); }
    MYRIAD_DEPENDENCE_OPERATOR(+)
    MYRIAD_DEPENDENCE_OPERATOR(-)
    MYRIAD_DEPENDENCE_OPERATOR(*)
    MYRIAD_DEPENDENCE_OPERATOR(/)
#undef MYRIAD_DEPENDENCE_OPERATOR
#define MYRIAD_DEPENDENCE_COMPARISON(symbol) \
    friend MYRIAD_FUNCTION unknown_truth<size> operator symbol(const dependence&, const dependence&) { return {}; }
    MYRIAD_COMPARISONS(MYRIAD_DEPENDENCE_COMPARISON)
#undef MYRIAD_DEPENDENCE_COMPARISON

    static MYRIAD_FUNCTION dependence blend(const unknown_truth<size>&, const dependence& a, const dependence& b) {
        return join(a, b);
    }
    static MYRIAD_FUNCTION dependence get_lane(const dependence& a, int) { return a; }
    static MYRIAD_FUNCTION void set_lane(dependence& a, int, const dependence& value) { a = value; }
};

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

// Parameters and shared values are dependences too, which depend on nothing: their values are not known.
template <int size>
struct scalar_traits<dependence<size>> {
    using real = dependence<size>;
    using mask = unknown_truth<size>;
    using integer = std::int32_t;
    static constexpr int lanes = 1;
};

template <int size>
inline constexpr int kind_rank<dependence<size>> = 1;
template <int size>
inline constexpr int kind_rank<unknown_truth<size>> = 1;

/// Whether S is a dependence.
template <class S>
inline constexpr bool is_dependence = false;
template <int size>
inline constexpr bool is_dependence<dependence<size>> = true;

template <int size>
struct functions<dependence<size>> {
    using D = dependence<size>;

#define MYRIAD_SAME(name) \
    static MYRIAD_FUNCTION D name(const D& x) { return x; }
#define MYRIAD_CONSTANT(name) \
    static MYRIAD_FUNCTION D name(const D&) { return {}; }
#define MYRIAD_JOINED(name) \
    static MYRIAD_FUNCTION D name(const D& x, const D& y) { return D::join(x, y); }
    MYRIAD_SMOOTH_FUNCTIONS(MYRIAD_SAME)
    MYRIAD_STEP_FUNCTIONS(MYRIAD_CONSTANT)
    MYRIAD_FUNCTIONS_OF_TWO(MYRIAD_JOINED)
#undef MYRIAD_SAME
#undef MYRIAD_CONSTANT
#undef MYRIAD_JOINED

    static MYRIAD_FUNCTION void sincos(const D& x, D& sine, D& cosine) { sine = cosine = x; }
    static MYRIAD_FUNCTION void sincospi(const D& x, D& sine, D& cosine) { sine = cosine = x; }
    static MYRIAD_FUNCTION D copysign(const D& x, const D&) { return x; }
    static MYRIAD_FUNCTION D fma(const D& a, const D& b, const D& c) { return D::join(D::join(a, b), c); }
    static MYRIAD_FUNCTION unknown_truth<size> is_finite(const D&) { return {}; }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
