// SPDX-License-Identifier: MIT
// <cstdint>, <cstddef>, <type_traits> and <concepts> for NVRTC; see standard_library.hpp.
#pragma once

using int8_t = signed char;
using int16_t = short;
using int32_t = int;
using int64_t = long;
using uint8_t = unsigned char;
using uint16_t = unsigned short;
using uint32_t = unsigned int;
using uint64_t = unsigned long;
using intptr_t = long;
using uintptr_t = unsigned long;

namespace std {

using ::int8_t, ::int16_t, ::int32_t, ::int64_t, ::uint8_t, ::uint16_t, ::uint32_t, ::uint64_t;
using ::intptr_t, ::uintptr_t;
using size_t = decltype(sizeof(0));
using ptrdiff_t = long;
using nullptr_t = decltype(nullptr);
enum class byte : unsigned char {};

// <type_traits>

template <class T, T v>
struct integral_constant {
    static constexpr T value = v;
    using value_type = T;
    using type = integral_constant;
    constexpr operator T() const { return v; }
    constexpr T operator()() const { return v; }
};
template <bool b>
using bool_constant = integral_constant<bool, b>;
using true_type = bool_constant<true>;
using false_type = bool_constant<false>;

template <class T>
struct type_identity {
    using type = T;
};
template <class T>
using type_identity_t = typename type_identity<T>::type;
template <class...>
using void_t = void;

template <class T>
struct remove_reference : type_identity<T> {};
template <class T>
struct remove_reference<T&> : type_identity<T> {};
template <class T>
struct remove_reference<T&&> : type_identity<T> {};
template <class T>
struct remove_const : type_identity<T> {};
template <class T>
struct remove_const<const T> : type_identity<T> {};
template <class T>
struct remove_volatile : type_identity<T> {};
template <class T>
struct remove_volatile<volatile T> : type_identity<T> {};
template <class T>
using remove_reference_t = typename remove_reference<T>::type;
template <class T>
using remove_const_t = typename remove_const<T>::type;
template <class T>
using remove_cv_t = typename remove_volatile<remove_const_t<T>>::type;
template <class T>
using remove_cvref_t = remove_cv_t<remove_reference_t<T>>;
template <class T>
struct remove_cv : type_identity<remove_cv_t<T>> {};
template <class T>
struct remove_cvref : type_identity<remove_cvref_t<T>> {};
template <class T>
struct remove_pointer : type_identity<T> {};
template <class T>
struct remove_pointer<T*> : type_identity<T> {};
template <class T>
using remove_pointer_t = typename remove_pointer<T>::type;
template <class T>
struct remove_extent : type_identity<T> {};
template <class T, size_t n>
struct remove_extent<T[n]> : type_identity<T> {};
template <class T>
using remove_extent_t = typename remove_extent<T>::type;

template <class, class>
inline constexpr bool is_same_v = false;
template <class T>
inline constexpr bool is_same_v<T, T> = true;
template <class A, class B>
struct is_same : bool_constant<is_same_v<A, B>> {};

template <bool, class T = void>
struct enable_if {};
template <class T>
struct enable_if<true, T> : type_identity<T> {};
template <bool b, class T = void>
using enable_if_t = typename enable_if<b, T>::type;
template <bool, class A, class>
struct conditional : type_identity<A> {};
template <class A, class B>
struct conditional<false, A, B> : type_identity<B> {};
template <bool b, class A, class B>
using conditional_t = typename conditional<b, A, B>::type;

template <class T, class... Several>
inline constexpr bool myriad_is_any_of = (is_same_v<remove_cv_t<T>, Several> || ...);
template <class T>
inline constexpr bool is_void_v = is_same_v<remove_cv_t<T>, void>;
template <class T>
inline constexpr bool is_integral_v =
    myriad_is_any_of<T, bool, char, wchar_t, char8_t, char16_t, char32_t, signed char, unsigned char, short,
                     unsigned short, int, unsigned, long, unsigned long, long long, unsigned long long>;
template <class T>
inline constexpr bool is_floating_point_v = myriad_is_any_of<T, float, double, long double>;
template <class T>
inline constexpr bool is_arithmetic_v = is_integral_v<T> || is_floating_point_v<T>;
template <class T>
inline constexpr bool is_signed_v = [] {
    if constexpr (is_arithmetic_v<T>) {
        return T(-1) < T(0);
    } else {
        return false;
    }
}();
template <class T>
inline constexpr bool is_unsigned_v = is_integral_v<T> && !is_signed_v<T>;
template <class T>
struct make_unsigned {};
#define MYRIAD_UNSIGNED(name) \
    template <>               \
    struct make_unsigned<name> : type_identity<unsigned name> {};
MYRIAD_UNSIGNED(short)
MYRIAD_UNSIGNED(int)
MYRIAD_UNSIGNED(long)
MYRIAD_UNSIGNED(long long)
#undef MYRIAD_UNSIGNED
template <class T>
using make_unsigned_t = typename make_unsigned<T>::type;
template <class T>
inline constexpr bool is_const_v = false;
template <class T>
inline constexpr bool is_const_v<const T> = true;
template <class T>
inline constexpr bool is_pointer_v = false;
template <class T>
inline constexpr bool is_pointer_v<T*> = true;
template <class T>
inline constexpr bool is_reference_v = false;
template <class T>
inline constexpr bool is_reference_v<T&> = true;
template <class T>
inline constexpr bool is_reference_v<T&&> = true;
template <class T>
inline constexpr bool is_array_v = false;
template <class T, size_t n>
inline constexpr bool is_array_v<T[n]> = true;
template <class T>
inline constexpr bool is_enum_v = __is_enum(T);
template <class T>
inline constexpr bool is_class_v = __is_class(T);
template <class T>
inline constexpr bool is_empty_v = __is_empty(T);
template <class T>
inline constexpr bool is_final_v = __is_final(T);
template <class T>
inline constexpr bool is_trivially_copyable_v = __is_trivially_copyable(T);
template <class Base, class Derived>
inline constexpr bool is_base_of_v = __is_base_of(Base, Derived);
template <class From, class To>
inline constexpr bool is_convertible_v = __is_convertible_to(From, To);

#define MYRIAD_AS_TYPE(name) \
    template <class T>       \
    struct name : bool_constant<name##_v<T>> {};
MYRIAD_AS_TYPE(is_void)
MYRIAD_AS_TYPE(is_integral)
MYRIAD_AS_TYPE(is_floating_point)
MYRIAD_AS_TYPE(is_arithmetic)
MYRIAD_AS_TYPE(is_signed)
MYRIAD_AS_TYPE(is_unsigned)
MYRIAD_AS_TYPE(is_const)
MYRIAD_AS_TYPE(is_pointer)
MYRIAD_AS_TYPE(is_reference)
MYRIAD_AS_TYPE(is_enum)
MYRIAD_AS_TYPE(is_class)
#undef MYRIAD_AS_TYPE

template <class T>
T&& declval() noexcept;
constexpr bool is_constant_evaluated() noexcept { return __builtin_is_constant_evaluated(); }

template <class T>
struct underlying_type : type_identity<__underlying_type(T)> {};
template <class T>
using underlying_type_t = typename underlying_type<T>::type;
template <class T>
struct decay {
    using bare = remove_reference_t<T>;
    using type = conditional_t<is_array_v<bare>, remove_extent_t<bare>*, remove_cv_t<bare>>;
};
template <class T>
using decay_t = typename decay<T>::type;
template <class A, class B>
using myriad_common = decay_t<decltype(false ? declval<decay_t<A>>() : declval<decay_t<B>>())>;
template <class...>
struct common_type {};
template <class T>
struct common_type<T> : type_identity<decay_t<T>> {};
template <class A, class B>
requires requires { typename type_identity<myriad_common<A, B>>; }
struct common_type<A, B> : type_identity<myriad_common<A, B>> {};
template <class A, class B, class... More>
requires(sizeof...(More) > 0) && requires { typename common_type<A, B>::type; }
struct common_type<A, B, More...> : common_type<typename common_type<A, B>::type, More...> {};
template <class... T>
using common_type_t = typename common_type<T...>::type;

// <concepts>

template <class A, class B>
concept same_as = is_same_v<A, B> && is_same_v<B, A>;
template <class From, class To>
concept convertible_to = is_convertible_v<From, To> && requires {
    static_cast<To>(declval<From>());
};
template <class Derived, class Base>
concept derived_from = is_base_of_v<Base, Derived>;
template <class T>
concept integral = is_integral_v<T>;
template <class T>
concept signed_integral = integral<T> && is_signed_v<T>;
template <class T>
concept unsigned_integral = integral<T> && !signed_integral<T>;
template <class T>
concept floating_point = is_floating_point_v<T>;
template <class F, class... Arguments>
concept invocable = requires(F&& f, Arguments&&... a) {
    static_cast<F&&>(f)(static_cast<Arguments&&>(a)...);
};

}  // namespace std
