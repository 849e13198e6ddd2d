// SPDX-License-Identifier: MIT
// JSON (RFC 8259) as values: read from a text, changed, compared and written. Of our own, since the libraries that do
// much more take longer to compile than all else of studies.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// A text is no JSON, a value is of another kind than the one asked for, or a string is not in UTF-8.
struct json_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// One value, with all that is in it.
class json_value {
public:
    struct member;
    using list = std::vector<json_value>;
    using object = std::vector<member>;  ///< in the order in which they are written

    json_value() = default;  ///< null
    json_value(std::integral auto value) {
        if constexpr (std::same_as<decltype(value), bool>) {
            value_ = value;
        } else if (std::in_range<std::int64_t>(value)) {
            value_ = static_cast<std::int64_t>(value);
        } else {
            value_ = static_cast<std::uint64_t>(value);
        }
    }
    json_value(double value) : value_(value) {}  ///< finite
    json_value(std::string_view text) : value_(std::string(text)) {}
    json_value(const char* text) : value_(std::string(text)) {}
    json_value(std::string text) : value_(std::move(text)) {}
    json_value(list items) : value_(std::move(items)) {}
    json_value(object members) : value_(std::move(members)) {}
    template <class T>
    requires std::convertible_to<T, json_value> json_value(const std::vector<T>& items)
        : value_(list(items.begin(), items.end())) {}

    /// The value that a text describes. Throws `json_error` that says where it is wrong.
    static json_value parse(std::string_view text);
    /// The text in one line, or with every value in a line of its own, indented by so many blanks. Throws `json_error`
    /// if a string is not in UTF-8.
    std::string text_of(int indent = 0) const;

    bool is_null() const { return std::holds_alternative<std::monostate>(value_); }
    bool is_bool() const { return std::holds_alternative<bool>(value_); }
    bool is_string() const { return std::holds_alternative<std::string>(value_); }
    bool is_list() const { return std::holds_alternative<list>(value_); }
    bool is_object() const { return std::holds_alternative<object>(value_); }
    bool is_integer() const { return std::holds_alternative<std::int64_t>(value_); }
    bool is_large() const { return std::holds_alternative<std::uint64_t>(value_); }  ///< an integer beyond that type
    bool is_number() const { return is_integer() || is_large() || is_real(); }

    /// Throw `json_error` if it is of another kind.
    bool boolean() const { return get<bool>("a truth value"); }
    std::int64_t integer() const { return get<std::int64_t>("an integer"); }
    double number() const;
    const std::string& string() const { return get<std::string>("a string"); }
    const list& items() const { return get<list>("a list"); }
    const object& members() const { return get<object>("an object"); }

    /// What an object has under a key, or nullptr.
    const json_value* find(std::string_view key) const;
    /// Throw `json_error` if an object, or a list, has nothing there.
    const json_value& at(std::string_view key) const;
    const json_value& at(std::size_t place) const;
    /// A new null if it has nothing there.
    json_value& operator[](std::string_view key);
    /// The same with the members of every object in the order of their keys.
    json_value sorted() const;

    /// Numbers are equal if they are the same number, objects if their members are in the same order too.
    bool operator==(const json_value& other) const;

private:
    bool is_real() const { return std::holds_alternative<double>(value_); }
    template <class T>
    const T& get(const char* kind) const {
        if (const T* const found = std::get_if<T>(&value_)) return *found;
        refuse(kind);
    }
    [[noreturn]] void refuse(const char* kind) const;
    void write(std::string& text, int indent, int depth) const;

    std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, list, object> value_;
};

/// What an object has under a key.
struct json_value::member {
    std::string key;
    json_value value;

    bool operator==(const member&) const = default;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
