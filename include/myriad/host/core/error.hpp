// SPDX-License-Identifier: MIT
// The host side's exception. A message names the problem, why it is one, and what to do, and marks what it is about, so
// that a front end finds its subject and uses its own words. Parts of messages are joined in the library, since
// formatting each combination of types took a fifth of a program's compile time.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/ieee.hpp"

namespace myriad {

/// What a stretch of a message is. The first option or component that a message names is its subject.
enum class mark_role {
    option,     ///< the name of an option
    component,  ///< the name of a component of the model
    phrase      ///< words that suit C++ alone: other front ends have their own under the same key
};

/// A stretch of a message that has a role.
struct mark {
    std::size_t begin;  ///< where it begins in the text, in bytes
    std::size_t size;   ///< how long it is, in bytes
    mark_role what;     ///< what it is
    std::string key;    ///< of an option its full name, as in samples.capacity
};

/// A text with its marks.
class marked_text {
public:
    /// An empty text.
    marked_text() = default;
    /// A text, whose marks are in its order.
    marked_text(std::string text, std::vector<mark> marks = {}) : text_(std::move(text)), marks_(std::move(marks)) {}

    /// The text alone.
    const std::string& text() const { return text_; }
    /// Its stretches with a role.
    const std::vector<mark>& marks() const { return marks_; }

private:
    std::string text_;
    std::vector<mark> marks_;
};

/// Thrown by every check on the host before any work is done.
class error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
    /// With the marks of its text.
    explicit error(const marked_text& text)
        : std::runtime_error(text.text()), marks_(std::make_shared<std::vector<mark>>(text.marks())) {}

    /// The marks of `what()`, in its order.
    const std::vector<mark>& marks() const {
        static const std::vector<mark> none;
        return marks_ ? *marks_ : none;
    }

private:
    std::shared_ptr<const std::vector<mark>> marks_;  // shared, as copies of exceptions must not throw
};

/// Thrown where there is too little memory, on the host or on a GPU: fewer instances at a time may fit.
class out_of_memory : public error {
public:
    using error::error;  ///< constructed as `error`
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
    /// It keeps its marks.
    message_part(const marked_text& text) : kind_(kind::marked) { value_.marked = &text; }
    /// A part with a role, under a key.
    message_part(const message_part& part, mark_role what, std::string_view key) : message_part(part) {
        has_role_ = true;
        role_ = what;
        key_ = key;
    }

private:
    friend marked_text join(std::initializer_list<message_part> parts);
    void print(std::ostream& out) const;

    enum class kind { character, integer, natural, real, text, marked, other } kind_;
    bool has_role_ = false;
    mark_role role_{};
    std::string_view key_;
    union {
        char character;
        std::int64_t integer;
        std::uint64_t natural;
        double real;
        struct {
            const char* begin;
            std::size_t size;
        } text;
        const marked_text* marked;
        struct {
            const void* value;
            void (*print)(std::ostream&, const void*);
        } other;
    } value_;
};

marked_text join(std::initializer_list<message_part> parts);
[[noreturn, gnu::cold]] void refuse(std::initializer_list<message_part> parts);

/// The name of an option, which messages may call otherwise than its key.
inline message_part named_option(std::string_view key, const message_part& name) {
    return {name, mark_role::option, key};
}
inline message_part named_option(std::string_view key) { return named_option(key, key); }
/// The name of a component.
inline message_part named_component(std::string_view name) { return {name, mark_role::component, name}; }
/// Words for which other front ends have their own.
inline message_part phrase(std::string_view key, const message_part& words) { return {words, mark_role::phrase, key}; }

}  // namespace host::inline MYRIAD_ABI

/// Joins its arguments into one message, independently of the program's locale, since device names are parsed again.
template <class... Parts>
std::string message(const Parts&... parts) {
    return host::join({host::message_part(parts)...}).text();
}
/// The same with the marks of its parts, for another message or an error.
template <class... Parts>
marked_text marked_message(const Parts&... parts) {
    return host::join({host::message_part(parts)...});
}

/// Throws an error of the joined parts unless the condition holds.
template <class... Parts>
void require(bool condition, const Parts&... parts) {
    if (!condition) [[unlikely]]
        host::refuse({host::message_part(parts)...});
}

}  // namespace myriad
