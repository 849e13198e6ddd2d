// SPDX-License-Identifier: MIT
// A TOML document as plain data with the place of everything in it, so that one file alone includes the library that
// reads it. Host code only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "myriad/host/core/error.hpp"

namespace myriad::programs {

/// What a user gave is wrong: exit status 2.
class input_error : public error {
public:
    using error::error;
};

/// A place in a file, counted from 1 as editors do; line 0: the file as a whole.
struct text_place {
    std::string_view file;
    int line = 0, column = 0;
};

/// A value in a TOML file.
struct toml_value {
    using array = std::vector<toml_value>;
    struct entry;
    using table = std::vector<entry>;  ///< in the order of the file
    struct other {                     ///< a date or a time
        std::string_view kind;
    };

    std::variant<table, array, std::string, std::int64_t, double, bool, other> value;
    text_place place;  ///< of its key in a table, otherwise of the value; its file is the document's

    /// "a table", "an integer" and so on.
    std::string_view kind() const;
    template <class T>
    const T* as() const {
        return std::get_if<T>(&value);
    }
};
struct toml_value::entry {
    std::string key;
    toml_value value;
};

/// "file:line:column: " for messages.
std::string position(const text_place& place);

/// Reads a document. `file`, its name in messages, must outlive the result. Throws `input_error` where it is no TOML.
toml_value parse_toml(std::string_view text, std::string_view file);

}  // namespace myriad::programs
