// SPDX-License-Identifier: MIT
// A table of a TOML file while it is read: values of the wanted types, and errors that name the place and the key. Host
// code only.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/host/options/option_table.hpp"
#include "program/toml_value.hpp"

namespace myriad::programs {

/// `: did you mean "relative_tolerance"?`: the choice that is most like a name, as the end of a message; empty if none
/// is like it at all.
std::string nearest_of(std::string_view name, const std::vector<std::string>& choices);
/// `"relativ_tolerance": did you mean "relative_tolerance"?`: the choice that is most like a name, as the end of a
/// message; without one that is at all like it, all choices.
std::string suggestion(std::string_view name, const std::vector<std::string>& choices);

/// A number: as such, or a multiple of pi as "2 pi" or "pi/2".
double number_in(const toml_value& v, std::string_view key);
/// A whole number; also one as 1e6.
std::int64_t integer_in(const toml_value& v, std::string_view key);
/// A string.
const std::string& text_in(const toml_value& v, std::string_view key);
/// true or false.
bool truth_in(const toml_value& v, std::string_view key);
/// The items of an array; another value is the only one.
std::vector<const toml_value*> items_in(const toml_value& v);
/// An array of numbers.
std::vector<double> numbers_in(const toml_value& v, std::string_view key);
/// An array of strings, or a single one.
std::vector<std::string> texts_in(const toml_value& v, std::string_view key);

/// What an error says, in the words of study files. `events`: the names of the model's events.
std::string in_words_of_files(const statement& said, const std::vector<std::string>& events = {});
/// "file:line:column: key: " and the text, as an error.
input_error wrong(const toml_value& v, std::string_view key, std::string_view text);
/// Calls a function, and gives errors that it throws the place and the key.
void placed(const toml_value& v, std::string_view key, const std::function<void()>& function);

/// A table, whose keys are asked for one after the other. What was not asked for is unknown.
class section {
public:
    /// `path` is its name in messages; empty: the document.
    section(const toml_value& table, std::string path);

    /// The value of a key; null if it is not there.
    const toml_value* find(std::string_view key);
    /// Calls `function(value, name of the key)` if the key is there.
    template <class Function>
    void with(std::string_view key, Function&& function) {
        if (const toml_value* const v = find(key)) function(*v, full(key));
    }
    void read(std::string_view key, double& to) {
        with(key, [&](const toml_value& v, const std::string& name) { to = number_in(v, name); });
    }
    void read(std::string_view key, std::int64_t& to) {
        with(key, [&](const toml_value& v, const std::string& name) { to = integer_in(v, name); });
    }
    void read(std::string_view key, bool& to) {
        with(key, [&](const toml_value& v, const std::string& name) { to = truth_in(v, name); });
    }
    void read(std::string_view key, std::string& to) {
        with(key, [&](const toml_value& v, const std::string& name) { to = text_in(v, name); });
    }
    /// One of some words.
    template <class T>
    void read(std::string_view key, T& to, std::initializer_list<host::choice<T>> choices) {
        read_choice<T>(key, to, {choices.begin(), choices.size()});
    }
    template <class T, std::size_t n>
    void read(std::string_view key, T& to, const std::array<host::choice<T>, n>& choices) {
        read_choice<T>(key, to, choices);
    }
    /// A key's name in messages, with the names of the tables that it is in.
    std::string full(std::string_view key) const;
    const toml_value& whole() const { return table_; }
    /// Throws `input_error` for a key that was not asked for.
    void finish() const;

private:
    template <class T>
    void read_choice(std::string_view key, T& to, std::span<const host::choice<T>> choices) {
        with(key, [&](const toml_value& v, const std::string& name) {
            const std::string& word = text_in(v, name);
            std::vector<std::string> words;
            for (const host::choice<T>& c : choices) {
                if (word == c.name) {
                    to = c.value;
                    return;
                }
                words.emplace_back(c.name);
            }
            throw wrong(v, name, message('"', word, "\" is none of its values", suggestion(word, words)));
        });
    }

    const toml_value& table_;
    std::string path_;
    std::vector<std::string> asked_;
};

}  // namespace myriad::programs
