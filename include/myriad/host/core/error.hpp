// SPDX-License-Identifier: MIT
// The host side's exception. A message names the problem, why it is one, and what to do. It is kept in parts, so that
// front ends find its subject and say it in their own words. Parts are joined in the library, since formatting each
// combination of types took a fifth of a program's compile time.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "myriad/host/core/cures.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/ieee.hpp"

namespace myriad {

/// What a part of a statement is. Front ends have their own words for options, components, events and cures.
enum class part_kind {
    text,       ///< words that are the same everywhere
    option,     ///< the name of an option
    component,  ///< a component of the model
    event,      ///< an event of the model
    separator,  ///< what is between the problem and the cure
    cure        ///< what to do, by the name that it has in the table of cures
};

/// A part of a statement.
struct statement_part {
    part_kind kind = part_kind::text;  ///< what it is
    std::string words;                 ///< in C++
    std::string key;  ///< of an option its full name, as samples.capacity; of a component its kind, or kind and name,
                      ///< as parameter.k; of a cure its name
    std::int64_t number = -1;  ///< of a component of a kind, of an event, or of a cure that needs one

    /// Whether all of them are equal.
    bool operator==(const statement_part&) const = default;
};

/// What an error or a note of a report says: the problem, and then, after a separator, what to do.
struct statement {
    std::vector<statement_part> parts;  ///< in their order

    /// Nothing.
    statement() = default;
    /// A text without further parts.
    explicit statement(std::string text) { parts.push_back({.words = std::move(text), .key = {}}); }

    /// The option, the component or the event that it names first; null if there is none.
    const statement_part* subject() const;
    /// What is wrong.
    std::span<const statement_part> problem() const;
    /// What to do; empty if it does not say so.
    std::span<const statement_part> cure() const;

    /// In the words that a function has for each part; by default those of C++.
    template <class Words = const std::string& (*)(const statement_part&)>
    std::string text(Words&& words_for = [](const statement_part& p) -> const std::string& { return p.words; }) const {
        std::string all;
        for (const statement_part& p : parts) all += words_for(p);
        return all;
    }
    /// The same.
    operator std::string() const { return text(); }
    /// Whether all parts are equal.
    bool operator==(const statement&) const = default;
    /// Prints it in C++'s words.
    friend std::ostream& operator<<(std::ostream& out, const statement& s);
};

/// Thrown by every check on the host before any work is done.
class error : public std::runtime_error {
public:
    /// `what()` has C++'s words.
    explicit error(statement said)
        : std::runtime_error(said.text()), said_(std::make_shared<const statement>(std::move(said))) {}
    /// Of text alone.
    explicit error(std::string text) : error(statement(std::move(text))) {}

    /// What it says, in parts.
    const statement& said() const { return *said_; }

private:
    std::shared_ptr<const statement> said_;  // shared, as copies of exceptions must not throw
};

/// Thrown where there is too little memory, on the host or on a GPU: fewer instances at a time may fit.
class out_of_memory : public error {
public:
    using error::error;  ///< constructed as `error`
};

namespace host::inline MYRIAD_ABI {

/// Begins the cure in a message.
struct cure_begins {
    std::string_view separator = ": ";
};
inline constexpr cure_begins cure;

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
        if constexpr (requires { T::part; }) {
            is_ = T::part;
            key_ = printed.what;
            number_ = printed.number;
        }
    }
    /// All its parts.
    message_part(const statement& said) : kind_(kind::said) { value_.said = &said; }
    message_part(const cure_begins& begins) : message_part(part_kind::separator, begins.separator, {}) {}
    /// In the words of the table of cures.
    message_part(cures known) : message_part(known, row_of(known).words) {}
    /// In words of its own, maybe with a number for other front ends.
    message_part(cures known, const message_part& words, std::int64_t number = -1)
        : message_part(part_kind::cure, words, row_of(known).name, number) {}
    message_part(part_kind is, const message_part& words, std::string_view key, std::int64_t number = -1)
        : message_part(words) {
        is_ = is;
        key_ = key;
        number_ = number;
    }

private:
    friend statement join(std::initializer_list<message_part> parts);
    void print(std::ostream& out) const;

    enum class kind { character, integer, natural, real, text, other, said } kind_;
    part_kind is_ = part_kind::text;
    std::string_view key_;
    std::int64_t number_ = -1;
    union {
        char character;
        std::int64_t integer;
        std::uint64_t natural;
        double real;
        struct {
            const char* begin;
            std::size_t size;
        } text;
        const statement* said;
        struct {
            const void* value;
            void (*print)(std::ostream&, const void*);
        } other;
    } value_;
};

statement join(std::initializer_list<message_part> parts);
[[noreturn, gnu::cold]] void refuse(std::initializer_list<message_part> parts);

/// The name of an option, which messages may call otherwise than its key.
inline message_part named_option(std::string_view key, const message_part& name) {
    return {part_kind::option, name, key};
}
inline message_part named_option(std::string_view key) { return named_option(key, key); }
/// A component, by its kind and name as in parameter.k, which messages may call otherwise.
inline message_part named_component(std::string_view key, const message_part& name) {
    return {part_kind::component, name, key};
}
inline message_part named_component(std::string_view key) { return named_component(key, key); }

}  // namespace host::inline MYRIAD_ABI

/// Joins its arguments into one message, independently of the program's locale, since device names are parsed again.
template <class... Parts>
std::string message(const Parts&... parts) {
    return host::join({host::message_part(parts)...}).text();
}
/// The same in parts, for another message, an error or a note.
template <class... Parts>
statement statement_of(const Parts&... parts) {
    return host::join({host::message_part(parts)...});
}

/// Throws an error of the joined parts unless the condition holds.
template <class... Parts>
void require(bool condition, const Parts&... parts) {
    if (!condition) [[unlikely]]
        host::refuse({host::message_part(parts)...});
}

}  // namespace myriad
