// SPDX-License-Identifier: MIT
// A number that records what it depends on instead of its value: a right-hand side called with it, in a constant
// expression, gives the entries of its Jacobian that may differ from zero, and about how many instructions it takes.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/function_list.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail {

/// About how many instructions of a processor functions take; operators, and functions that are not named, take one.
/// For Python, the same are in symbolic/operations.py.
struct instructions {
    static constexpr int divide = 8, sqrt = 8, reciprocal = 8, rsqrt = 8, fmod = 10, sincos = 20, sincospi = 20;
    static constexpr int sin = 15, cos = 15, sinpi = 15, cospi = 15, asin = 15, acos = 15, atan = 15;
    static constexpr int sinh = 15, cosh = 15, tanh = 15, cbrt = 15, hypot = 15, tan = 25, atan2 = 25;
    static constexpr int exp = 15, exp2 = 15, expm1 = 15, log = 15, log2 = 15, log10 = 15, log1p = 15;
    static constexpr int pow = 40, powr = 40;
    static constexpr int abs = 1, floor = 1, round = 1, rint = 1, min = 1, max = 1;
};

}  // namespace myriad::detail

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
    int* work = nullptr;        // counts the instructions of what is computed from it, if there is a counter

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
    /// What depends on both, computed from them by so many instructions.
    static MYRIAD_FUNCTION dependence join(const dependence& a, const dependence& b, int instructions = 1) {
        dependence both;
        for (int w = 0; w < words; ++w) both.on[w] = a.on[w] | b.on[w];
        both.work = a.work != nullptr ? a.work : b.work;
        if (both.work != nullptr) *both.work += instructions;
        return both;
    }
    /// What has been computed from it by so many instructions.
    MYRIAD_FUNCTION dependence after(int instructions) const {
        if (work != nullptr) *work += instructions;
        return *this;
    }
    /// The same with no derivative.
    MYRIAD_FUNCTION dependence step_after(int instructions) const {
        dependence constant;
        constant.work = after(instructions).work;
        return constant;
    }

    friend MYRIAD_FUNCTION dependence operator+(const dependence& a) { return a; }
    friend MYRIAD_FUNCTION dependence operator-(const dependence& a) { return a.after(1); }
#define MYRIAD_DEPENDENCE_OPERATOR(symbol, instructions)                                          \
    friend MYRIAD_FUNCTION dependence operator symbol(const dependence& a, const dependence& b) { \
        return join(a, b, instructions);                                                          \
    }                                                                                             \
    MYRIAD_FUNCTION dependence& operator symbol##=(const dependence& b) { return *this = join(*this, b, instructions); }
    MYRIAD_DEPENDENCE_OPERATOR(+, 1)
    MYRIAD_DEPENDENCE_OPERATOR(-, 1)
    MYRIAD_DEPENDENCE_OPERATOR(*, 1)
    MYRIAD_DEPENDENCE_OPERATOR(/, detail::instructions::divide)
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
    static MYRIAD_FUNCTION D name(const D& x) { return x.after(instructions::name); }
#define MYRIAD_CONSTANT(name) \
    static MYRIAD_FUNCTION D name(const D& x) { return x.step_after(instructions::name); }
#define MYRIAD_JOINED(name) \
    static MYRIAD_FUNCTION D name(const D& x, const D& y) { return D::join(x, y, instructions::name); }
    MYRIAD_SMOOTH_FUNCTIONS(MYRIAD_SAME)
    MYRIAD_STEP_FUNCTIONS(MYRIAD_CONSTANT)
    MYRIAD_FUNCTIONS_OF_TWO(MYRIAD_JOINED)
#undef MYRIAD_SAME
#undef MYRIAD_CONSTANT
#undef MYRIAD_JOINED

    static MYRIAD_FUNCTION void sincos(const D& x, D& sine, D& cosine) {
        sine = cosine = x.after(instructions::sincos);
    }
    static MYRIAD_FUNCTION void sincospi(const D& x, D& sine, D& cosine) {
        sine = cosine = x.after(instructions::sincospi);
    }
    static MYRIAD_FUNCTION D copysign(const D& x, const D&) { return x.after(1); }
    static MYRIAD_FUNCTION D fma(const D& a, const D& b, const D& c) { return D::join(D::join(a, b, 0), c); }
    static MYRIAD_FUNCTION unknown_truth<size> is_finite(const D&) { return {}; }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
