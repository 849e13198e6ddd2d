// SPDX-License-Identifier: MIT
// The host side's exception. A message names the problem, why it is one, and what to do. Parts of messages are joined
// in the library, since formatting each combination of types took a fifth of a program's compile time.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/ieee.hpp"

namespace myriad {

/// Thrown by every check on the host before any work is done.
class error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Thrown where there is too little memory, on the host or on a GPU: fewer instances at a time may fit.
class out_of_memory : public error {
public:
    using error::error;
};

namespace host::inline MYRIAD_ABI {

/// A part of a message: a number, text, or what else a stream prints. It refers to the value.
class message_part {
public:
    message_part(char c) : kind_(kind::character) { value_.character = c; }
    message_part(std::string_view text) : kind_(kind::text) { value_.text = {text.data(), text.size()}; }
    message_part(const char* text) : message_part(std::string_view(text)) {}
    message_part(const std::string& text) : message_part(std::string_view(text)) {}
    template <std::integral T>
    message_part(T number) : kind_(std::is_signed_v<T> ? kind::integer : kind::natural) {
        if constexpr (std::is_signed_v<T>) {
            value_.integer = number;
        } else {
            value_.natural = number;
        }
    }
    template <std::floating_point T>
    message_part(T number) : kind_(kind::real) {
        value_.real = static_cast<double>(number);
    }
    template <class T>
    requires(!std::is_arithmetic_v<T> && !std::is_convertible_v<const T&, std::string_view>)
        message_part(const T& printed)
        : kind_(kind::other) {
        value_.other = {&printed, [](std::ostream& out, const void* value) { out << *static_cast<const T*>(value); }};
    }
    friend std::ostream& operator<<(std::ostream& out, const message_part& part);

private:
    enum class kind { character, integer, natural, real, text, other } kind_;
    union {
        char character;
        std::int64_t integer;
        std::uint64_t natural;
        double real;
        struct {
            const char* begin;
            std::size_t size;
        } text;
        struct {
            const void* value;
            void (*print)(std::ostream&, const void*);
        } other;
    } value_;
};

std::string join(std::initializer_list<message_part> parts);
[[noreturn, gnu::cold]] void refuse(std::initializer_list<message_part> parts);

}  // namespace host::inline MYRIAD_ABI

/// Joins its arguments into one message, independently of the program's locale, since device names are parsed again.
template <class... Parts>
std::string message(const Parts&... parts) {
    return host::join({host::message_part(parts)...});
}

/// Throws an error of the joined parts unless the condition holds.
template <class... Parts>
void require(bool condition, const Parts&... parts) {
    if (!condition) [[unlikely]]
        host::refuse({host::message_part(parts)...});
}

}  // namespace myriad
