// SPDX-License-Identifier: MIT
// The part of the C++ standard library that kernels and models use, for NVRTC, which has none: it includes this file
// for each of the library's headers (myriad/kernels/nvrtc.py).
#pragma once

#include <myriad/python/standard_types.hpp>

#define M_PI 3.14159265358979323846
#define M_PI_2 1.57079632679489661923
#define M_E 2.7182818284590452354

namespace std {

// <utility>

template <class T>
constexpr T&& forward(remove_reference_t<T>& t) noexcept {
    return static_cast<T&&>(t);
}
template <class T>
constexpr T&& forward(remove_reference_t<T>&& t) noexcept {
    return static_cast<T&&>(t);
}
template <class T>
constexpr remove_reference_t<T>&& move(T&& t) noexcept {
    return static_cast<remove_reference_t<T>&&>(t);
}
template <class T>
constexpr void swap(T& a, T& b) {
    T kept = std::move(a);
    a = std::move(b);
    b = std::move(kept);
}
template <class T, class U = T>
constexpr T exchange(T& object, U&& value) {
    T kept = std::move(object);
    object = std::forward<U>(value);
    return kept;
}
template <class T, T... numbers>
struct integer_sequence {
    using value_type = T;
    static constexpr size_t size() noexcept { return sizeof...(numbers); }
};
template <class, class>
struct myriad_joined;
template <class T, T... a, T... b>
struct myriad_joined<integer_sequence<T, a...>, integer_sequence<T, b...>>
    : type_identity<integer_sequence<T, a..., (static_cast<T>(sizeof...(a)) + b)...>> {};
template <class T, size_t n>
struct myriad_below : myriad_joined<typename myriad_below<T, n / 2>::type, typename myriad_below<T, n - n / 2>::type> {
};
template <class T>
struct myriad_below<T, 0> : type_identity<integer_sequence<T>> {};
template <class T>
struct myriad_below<T, 1> : type_identity<integer_sequence<T, T(0)>> {};
template <class T, T n>
using make_integer_sequence = typename myriad_below<T, static_cast<size_t>(n)>::type;
template <size_t... numbers>
using index_sequence = integer_sequence<size_t, numbers...>;
template <size_t n>
using make_index_sequence = make_integer_sequence<size_t, n>;
template <class... T>
using index_sequence_for = make_index_sequence<sizeof...(T)>;
template <class First, class Second>
struct pair {
    First first;
    Second second;
};

// <array>, <iterator>

template <class T, size_t n>
struct array {
    using value_type = T;
    constexpr T& operator[](size_t i) { return values[i]; }
    constexpr const T& operator[](size_t i) const { return values[i]; }
    static constexpr size_t size() { return n; }
    constexpr T& back() { return values[n - 1]; }
    constexpr const T& back() const { return values[n - 1]; }
    constexpr T* begin() { return values; }
    constexpr const T* begin() const { return values; }
    constexpr T* end() { return values + n; }
    constexpr const T* end() const { return values + n; }
    constexpr T* data() { return values; }
    constexpr const T* data() const { return values; }
    constexpr void fill(const T& value) {
        for (size_t i = 0; i < n; ++i) values[i] = value;
    }
    constexpr bool operator==(const array&) const = default;

    T values[n > 0 ? n : 1];
};
template <class T, class... More>
array(T, More...) -> array<T, 1 + sizeof...(More)>;

template <class T, size_t n>
constexpr size_t size(const T (&)[n]) {
    return n;
}
template <class Container>
constexpr auto size(const Container& c) -> decltype(c.size()) {
    return c.size();
}
template <class T, size_t n>
constexpr T* begin(T (&values)[n]) {
    return values;
}
template <class T, size_t n>
constexpr T* end(T (&values)[n]) {
    return values + n;
}
template <class Container>
constexpr auto begin(Container& c) -> decltype(c.begin()) {
    return c.begin();
}
template <class Container>
constexpr auto end(Container& c) -> decltype(c.end()) {
    return c.end();
}

// <algorithm>

template <class T>
constexpr const T& min(const T& a, const T& b) {
    return b < a ? b : a;
}
template <class T>
constexpr const T& max(const T& a, const T& b) {
    return a < b ? b : a;
}
template <class T>
constexpr const T& clamp(const T& value, const T& least, const T& most) {
    return value < least ? least : most < value ? most : value;
}
template <class In, class Out>
constexpr Out copy(In first, In last, Out to) {
    for (; first != last; ++first, ++to) *to = *first;
    return to;
}
template <class In, class Out>
constexpr Out copy_n(In from, size_t count, Out to) {
    for (size_t i = 0; i < count; ++i, ++from, ++to) *to = *from;
    return to;
}
template <class In, class T>
constexpr void fill(In first, In last, const T& value) {
    for (; first != last; ++first) *first = value;
}

// <limits>

template <class T>
struct numeric_limits {
    static constexpr bool is_specialized = is_integral_v<T>, is_integer = is_specialized, is_signed = is_signed_v<T>;
    static constexpr int digits = 8 * static_cast<int>(sizeof(T)) - (is_signed ? 1 : 0);
    static constexpr T max() noexcept { return static_cast<T>(~0ull >> (64 - digits)); }
    static constexpr T min() noexcept { return is_signed ? static_cast<T>(-max() - 1) : T(0); }
    static constexpr T lowest() noexcept { return min(); }
};
template <>
struct numeric_limits<double> {
    static constexpr bool is_specialized = true, is_integer = false, is_signed = true, has_infinity = true,
                          has_quiet_NaN = true, is_iec559 = true;
    static constexpr int digits = 53, digits10 = 15, max_digits10 = 17, radix = 2, max_exponent = 1024,
                         min_exponent = -1021;
    static constexpr double max() noexcept { return 0x1.fffffffffffffp1023; }
    static constexpr double min() noexcept { return 0x1p-1022; }
    static constexpr double lowest() noexcept { return -max(); }
    static constexpr double epsilon() noexcept { return 0x1p-52; }
    static constexpr double denorm_min() noexcept { return 0x1p-1074; }
    static constexpr double infinity() noexcept { return __builtin_bit_cast(double, 0x7ff0000000000000ul); }
    static constexpr double quiet_NaN() noexcept { return __builtin_bit_cast(double, 0x7ff8000000000000ul); }
};
template <>
struct numeric_limits<float> {
    static constexpr bool is_specialized = true, is_integer = false, is_signed = true, has_infinity = true,
                          has_quiet_NaN = true, is_iec559 = true;
    static constexpr int digits = 24, digits10 = 6, max_digits10 = 9, radix = 2, max_exponent = 128,
                         min_exponent = -125;
    static constexpr float max() noexcept { return 0x1.fffffep127f; }
    static constexpr float min() noexcept { return 0x1p-126f; }
    static constexpr float lowest() noexcept { return -max(); }
    static constexpr float epsilon() noexcept { return 0x1p-23f; }
    static constexpr float denorm_min() noexcept { return 0x1p-149f; }
    static constexpr float infinity() noexcept { return __builtin_bit_cast(float, 0x7f800000u); }
    static constexpr float quiet_NaN() noexcept { return __builtin_bit_cast(float, 0x7fc00000u); }
};

// <string_view>, of which the kernels take the names of their types apart

class string_view {
public:
    static constexpr size_t npos = ~size_t(0);
    constexpr string_view(const char* text) : text_(text) {
        while (text[size_] != 0) ++size_;
    }
    constexpr string_view(const char* text, size_t size) : text_(text), size_(size) {}
    constexpr size_t size() const { return size_; }
    constexpr const char* data() const { return text_; }
    constexpr const char* begin() const { return text_; }
    constexpr const char* end() const { return text_ + size_; }
    constexpr char operator[](size_t i) const { return text_[i]; }
    constexpr size_t find(string_view what, size_t from = 0) const {
        for (size_t i = from; i + what.size_ <= size_; ++i) {
            size_t same = 0;
            while (same < what.size_ && text_[i + same] == what.text_[same]) ++same;
            if (same == what.size_) return i;
        }
        return npos;
    }

private:
    const char* text_;
    size_t size_ = 0;
};

// <bit>

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}

// <cmath>, whose functions NVRTC has at global scope

#define MYRIAD_FUNCTION_OF_ONE(name)                    \
    inline double name(double x) { return ::name(x); }  \
    inline float name(float x) { return ::name##f(x); } \
    template <class T>                                  \
    requires is_integral_v<T>                           \
    inline double name(T x) { return ::name(static_cast<double>(x)); }
#define MYRIAD_FUNCTION_OF_TWO(name)                                \
    inline double name(double x, double y) { return ::name(x, y); } \
    inline float name(float x, float y) { return ::name##f(x, y); } \
    template <class A, class B>                                     \
    requires is_arithmetic_v<A> && is_arithmetic_v<B>               \
    inline double name(A x, B y) { return ::name(static_cast<double>(x), static_cast<double>(y)); }
#define MYRIAD_FUNCTIONS_OF_ONE(of)                                                                              \
    of(acos) of(acosh) of(asin) of(asinh) of(atan) of(atanh) of(cbrt) of(ceil) of(cos) of(cosh) of(erf) of(erfc) \
        of(exp) of(exp2) of(expm1) of(fabs) of(floor) of(lgamma) of(log) of(log10) of(log1p) of(log2) of(rint)   \
            of(round) of(sin) of(sinh) of(sqrt) of(tan) of(tanh) of(tgamma) of(trunc)
#define MYRIAD_FUNCTIONS_OF_TWO(of) of(atan2) of(copysign) of(fdim) of(fmax) of(fmin) of(fmod) of(hypot) of(pow)
MYRIAD_FUNCTIONS_OF_ONE(MYRIAD_FUNCTION_OF_ONE)
MYRIAD_FUNCTIONS_OF_TWO(MYRIAD_FUNCTION_OF_TWO)
#undef MYRIAD_FUNCTIONS_OF_ONE
#undef MYRIAD_FUNCTIONS_OF_TWO
#undef MYRIAD_FUNCTION_OF_ONE
#undef MYRIAD_FUNCTION_OF_TWO
inline double abs(double x) { return ::fabs(x); }
inline float abs(float x) { return ::fabsf(x); }
inline int abs(int x) { return x < 0 ? -x : x; }
inline long abs(long x) { return x < 0 ? -x : x; }
inline double fma(double a, double b, double c) { return ::fma(a, b, c); }
inline float fma(float a, float b, float c) { return ::fmaf(a, b, c); }
inline double frexp(double x, int* exponent) { return ::frexp(x, exponent); }
inline float frexp(float x, int* exponent) { return ::frexpf(x, exponent); }
inline double ldexp(double x, int exponent) { return ::ldexp(x, exponent); }
inline float ldexp(float x, int exponent) { return ::ldexpf(x, exponent); }
inline bool isnan(double x) { return x != x; }
inline bool isnan(float x) { return x != x; }
inline bool isfinite(double x) { return ::fabs(x) <= numeric_limits<double>::max(); }
inline bool isfinite(float x) { return ::fabsf(x) <= numeric_limits<float>::max(); }
inline bool isinf(double x) { return ::fabs(x) == numeric_limits<double>::infinity(); }
inline bool isinf(float x) { return ::fabsf(x) == numeric_limits<float>::infinity(); }
inline bool signbit(double x) { return __builtin_bit_cast(int64_t, x) < 0; }
inline bool signbit(float x) { return __builtin_bit_cast(int32_t, x) < 0; }

// <numbers>

namespace numbers {
template <class T>
inline constexpr T pi_v = T(3.141592653589793238462643383279502884L);
template <class T>
inline constexpr T e_v = T(2.718281828459045235360287471352662498L);
template <class T>
inline constexpr T sqrt2_v = T(1.414213562373095048801688724209698079L);
template <class T>
inline constexpr T ln2_v = T(0.693147180559945309417232121458176568L);
inline constexpr double pi = pi_v<double>, e = e_v<double>, sqrt2 = sqrt2_v<double>, ln2 = ln2_v<double>;
}  // namespace numbers

}  // namespace std
