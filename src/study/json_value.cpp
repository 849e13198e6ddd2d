// SPDX-License-Identifier: MIT
// Reading and writing JSON.
#include "myriad/study/json_value.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <system_error>

#include "myriad/study/component_names.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

/// Bytes of the character in UTF-8 that a text begins with; 0 if it is none (Unicode 15, table 3-7).
std::size_t character_bytes(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t bytes = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
    for (std::size_t i = 1; i < bytes; ++i)
        if ((byte(i) & 0xC0) != 0x80) return 0;
    const unsigned second = byte(1);
    const bool is_overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
    const bool is_no_character = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
    return is_overlong || is_no_character ? 0 : bytes;
}

void append_character(std::string& text, unsigned code) {
    const auto append = [&](unsigned byte) { text += static_cast<char>(byte); };
    const auto append_rest = [&](int bits) {
        for (; bits >= 0; bits -= 6) append(0x80 | ((code >> bits) & 0x3F));
    };
    if (code < 0x80) {
        append(code);
    } else if (code < 0x800) {
        append(0xC0 | (code >> 6));
        append_rest(0);
    } else if (code < 0x10000) {
        append(0xE0 | (code >> 12));
        append_rest(6);
    } else {
        append(0xF0 | (code >> 18));
        append_rest(12);
    }
}

constexpr std::pair<char, char> escapes[] = {{'"', '"'},  {'\\', '\\'}, {'b', '\b'}, {'f', '\f'},
                                             {'n', '\n'}, {'r', '\r'},  {'t', '\t'}};

void write_string(std::string& text, std::string_view value) {
    text += '"';
    while (!value.empty()) {
        const std::size_t bytes = character_bytes(value);
        if (bytes == 0) throw json_error("a string is not in UTF-8");
        const auto* const escape =
            std::find_if(std::begin(escapes), std::end(escapes), [&](const auto& e) { return e.second == value[0]; });
        if (escape != std::end(escapes)) {
            text += {'\\', escape->first};
        } else if (bytes == 1 && value[0] < 0x20) {
            char code[7];
            std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(value[0]));
            text += code;
        } else {
            text += value.substr(0, bytes);
        }
        value.remove_prefix(bytes);
    }
    text += '"';
}

class reader {
public:
    explicit reader(std::string_view text) : rest_(text), size_(text.size()) {}

    json_value read() {
        json_value value = read_value(0);
        skip_blanks();
        if (!rest_.empty()) fail("it goes on after its end");
        return value;
    }

private:
    static constexpr int deepest = 200;  // so that no text overflows the stack

    [[noreturn]] void fail(const char* what) const {
        throw json_error("no JSON at byte " + std::to_string(size_ - rest_.size()) + ": " + what);
    }
    void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\n\r"), rest_.size())); }
    bool skip(std::string_view word) {
        const bool found = rest_.starts_with(word);
        if (found) rest_.remove_prefix(word.size());
        return found;
    }
    void expect(std::string_view word, const char* otherwise) {
        skip_blanks();
        if (!skip(word)) fail(otherwise);
    }

    json_value read_value(int depth) {
        if (depth > deepest) fail("too many values inside each other");
        skip_blanks();
        if (skip("null")) return {};
        if (skip("true")) return true;
        if (skip("false")) return false;
        if (rest_.starts_with('"')) return read_string();
        if (skip("[")) {
            json_value::list items;
            read_all("]", [&] { items.push_back(read_value(depth + 1)); });
            return items;
        }
        if (skip("{")) {
            json_value::object members;
            read_all("}", [&] {
                skip_blanks();
                std::string key = read_string();
                expect(":", "a colon is missing");
                members.push_back({std::move(key), read_value(depth + 1)});
            });
            return members;
        }
        return read_number();
    }
    /// What a list or an object holds, up to its end.
    template <class F>
    void read_all(std::string_view end, F read_one) {
        skip_blanks();
        if (skip(end)) return;
        for (;;) {
            read_one();
            skip_blanks();
            if (skip(end)) return;
            expect(",", "a comma or an end is missing");
        }
    }

    std::string read_string() {
        if (!skip("\"")) fail("a value or a string is missing");
        std::string text;
        while (!skip("\"")) {
            const std::size_t bytes = rest_.empty() ? 0 : character_bytes(rest_);
            if (bytes == 0) fail(rest_.empty() ? "a string has no end" : "a string is not in UTF-8");
            if (bytes == 1 && static_cast<unsigned char>(rest_[0]) < 0x20) fail("a control character in a string");
            if (skip("\\")) {
                append_character(text, read_escape());
            } else {
                text += rest_.substr(0, bytes);
                rest_.remove_prefix(bytes);
            }
        }
        return text;
    }
    unsigned read_escape() {
        if (skip("/")) return '/';
        for (const auto& [name, character] : escapes)
            if (skip({&name, 1})) return static_cast<unsigned char>(character);
        if (!skip("u")) fail("an unknown escape in a string");
        const unsigned code = read_hexadecimal();
        const bool is_high = code >= 0xD800 && code < 0xDC00, is_low = code >= 0xDC00 && code < 0xE000;
        if (is_low || (is_high && !skip("\\u"))) fail("half a surrogate pair in a string");
        if (!is_high) return code;
        const unsigned low = read_hexadecimal();
        if (low < 0xDC00 || low >= 0xE000) fail("half a surrogate pair in a string");
        return 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
    }
    unsigned read_hexadecimal() {
        unsigned code = 0;
        const std::string_view digits = rest_.substr(0, 4);
        const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
        if (problem != std::errc() || end != digits.data() + 4) fail("an escape without four digits in a string");
        rest_.remove_prefix(4);
        return code;
    }

    json_value read_number() {
        const std::string_view text = number_text();
        const char *const begin = text.data(), *const end = begin + text.size();
        if (text.find_first_of(".eE") == text.npos) {
            std::int64_t integer = 0;
            if (std::from_chars(begin, end, integer).ec == std::errc()) return integer;
            std::uint64_t large = 0;
            if (text[0] != '-' && std::from_chars(begin, end, large).ec == std::errc()) return large;
        }
        double number = 0;
        if (std::from_chars(begin, end, number).ec != std::errc()) fail("a number out of range");
        return number;
    }
    std::string_view number_text() {
        const std::string_view from = rest_;
        const auto digits = [&] {
            const std::size_t count = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
            if (count == 0) fail("a value or a digit is missing");
            rest_.remove_prefix(count);
        };
        skip("-");
        if (!skip("0")) digits();
        if (skip(".")) digits();
        if (skip("e") || skip("E")) {
            if (!skip("+")) skip("-");
            digits();
        }
        return from.substr(0, from.size() - rest_.size());
    }

    std::string_view rest_;
    std::size_t size_;
};

}  // namespace

json_value json_value::parse(std::string_view text) { return reader(text).read(); }

std::string json_value::text_of(int indent) const {
    std::string text;
    write(text, indent, 0);
    return text;
}

double json_value::number() const {
    if (const auto* const integer = std::get_if<std::int64_t>(&value_)) return static_cast<double>(*integer);
    if (const auto* const large = std::get_if<std::uint64_t>(&value_)) return static_cast<double>(*large);
    return get<double>("a number");
}

const json_value* json_value::find(std::string_view key) const {
    for (const member& m : members())
        if (m.key == key) return &m.value;
    return nullptr;
}
const json_value& json_value::at(std::string_view key) const {
    if (const json_value* const found = find(key)) return *found;
    throw json_error("the key \"" + std::string(key) + "\" is missing");
}
const json_value& json_value::at(std::size_t place) const {
    if (place < items().size()) return items()[place];
    throw json_error("a list has only " + std::to_string(items().size()) + " values");
}
json_value& json_value::operator[](std::string_view key) {
    auto* const all = std::get_if<object>(&value_);
    if (all == nullptr) refuse("an object");
    const auto found = std::find_if(all->begin(), all->end(), [&](const member& m) { return m.key == key; });
    return found != all->end() ? found->value : all->emplace_back(member{std::string(key), {}}).value;
}

json_value json_value::sorted() const {
    json_value made = *this;
    if (auto* const all = std::get_if<list>(&made.value_)) {
        for (json_value& item : *all) item = item.sorted();
    } else if (auto* const members = std::get_if<object>(&made.value_)) {
        std::sort(members->begin(), members->end(), [](const member& a, const member& b) { return a.key < b.key; });
        for (member& m : *members) m.value = m.value.sorted();
    }
    return made;
}

bool json_value::operator==(const json_value& other) const {
    if (is_number() && other.is_number() && is_real() != other.is_real()) return number() == other.number();
    return value_ == other.value_;
}

void json_value::refuse(const char* kind) const {
    constexpr const char* kinds[] = {"null",     "a truth value", "an integer", "a large integer",
                                     "a number", "a string",      "a list",     "an object"};
    throw json_error(std::string(kinds[value_.index()]) + " where " + kind + " is needed");
}

void json_value::write(std::string& text, int indent, int depth) const {
    const auto write_all = [&](const auto& values, const char* brackets, auto write_one) {
        text += brackets[0];
        bool first = true;
        for (const auto& v : values) {
            if (!first) text += ',';
            first = false;
            if (indent > 0) text += '\n' + std::string(static_cast<std::size_t>(indent * (depth + 1)), ' ');
            write_one(v);
        }
        if (indent > 0 && !first) text += '\n' + std::string(static_cast<std::size_t>(indent * depth), ' ');
        text += brackets[1];
    };
    if (is_null()) {
        text += "null";
    } else if (is_bool()) {
        text += boolean() ? "true" : "false";
    } else if (is_large()) {
        text += std::to_string(std::get<std::uint64_t>(value_));
    } else if (is_integer()) {
        text += std::to_string(integer());
    } else if (is_number()) {
        if (!std::isfinite(number())) throw json_error("JSON has no NaN and no infinity");
        const std::string digits = exact_text(number());
        text += digits;
        if (digits.find_first_of(".e") == digits.npos) text += ".0";  // read again, it is no integer
    } else if (is_string()) {
        write_string(text, string());
    } else if (is_list()) {
        write_all(items(), "[]", [&](const json_value& v) { v.write(text, indent, depth + 1); });
    } else {
        write_all(members(), "{}", [&](const member& m) {
            write_string(text, m.key);
            text += indent > 0 ? ": " : ":";
            m.value.write(text, indent, depth + 1);
        });
    }
}

}  // namespace myriad::studies::inline MYRIAD_ABI
