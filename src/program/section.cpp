// SPDX-License-Identifier: MIT
// Values of TOML tables.
#include "program/section.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace myriad::programs {

namespace {

/// The number of insertions, deletions, exchanges and swaps of neighbours that make one word the other.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> least(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                least[i][j] = i + j;
                continue;
            }
            least[i][j] = std::min(
                {least[i - 1][j] + 1, least[i][j - 1] + 1, least[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                least[i][j] = std::min(least[i][j], least[i - 2][j - 2] + 1);
        }
    }
    return least[a.size()][b.size()];
}

/// A product of numbers and pi, as "2 pi", "-3*pi/4"; nothing for another text. A factor without a sign before it is pi
/// after a number, and not in a divisor, where "1 / 2 pi" could mean both.
std::optional<double> multiple_of_pi(std::string_view text) {
    double product = 1;
    bool has_pi = false, divides = false, wants_factor = true, takes_pi = false;
    const char* at = text.data();
    const char* const end = at + text.size();
    if (at != end && *at == '-') {
        product = -1;
        ++at;
    }
    while (true) {
        while (at != end && *at == ' ') ++at;
        if (at == end) break;
        if (!wants_factor && (*at == '*' || *at == '/')) {
            divides = *at++ == '/';
            wants_factor = true;
            continue;
        }
        double factor = std::numbers::pi;
        if (end - at >= 2 && std::string_view(at, 2) == "pi") {
            if (!wants_factor && !takes_pi) return {};
            has_pi = true;
            at += 2;
            takes_pi = false;
        } else {
            const auto [rest, problem] = std::from_chars(at, end, factor);
            if (problem != std::errc() || !wants_factor) return {};
            at = rest;
            takes_pi = !divides;
        }
        product = divides ? product / factor : product * factor;
        divides = wants_factor = false;
    }
    if (!has_pi || wants_factor || !std::isfinite(product)) return {};
    return product;
}

std::string in_quotes(std::string_view text) { return message('"', text, '"'); }

using enum host::cures;
/// What study files have other words for than C++.
constexpr std::pair<host::cures, std::string_view> cures_in_files[] = {
    {set_value, "give it a value under [set]"},
    {give_step, "give step under [options]"},
    {use_doubles, "write real = \"double\""},
    {smaller_parts, "make chunk smaller"},
    {fewer_instances, "make chunk smaller"},
    {allow_arithmetic, "give --any-arithmetic, or arithmetic = \"any\" under [store]"},
    {new_folder, "give another store and a smaller chunk"},
    {make_consistent, "give initial values that satisfy them"}};

}  // namespace

std::string nearest_of(std::string_view name, const std::vector<std::string>& choices) {
    const std::string* nearest = nullptr;
    std::size_t least = std::max<std::size_t>(name.size() / 2, 1) + 1;
    for (const std::string& choice : choices) {
        const std::size_t shorter = std::min(name.size(), choice.size());
        if (std::max(name.size(), choice.size()) - shorter >= least) continue;  // that many insertions at the least
        const std::size_t d = distance(name, choice);
        if (d < least) {
            least = d;
            nearest = &choice;
        }
    }
    return nearest != nullptr ? message(": did you mean \"", *nearest, "\"?") : "";
}

std::string suggestion(std::string_view name, const std::vector<std::string>& choices) {
    std::string nearest = nearest_of(name, choices);
    if (!nearest.empty() || choices.empty()) return nearest;
    std::string all;
    for (const std::string& choice : choices) all += (all.empty() ? "" : ", ") + choice;
    return ": there are " + all;
}

std::string in_words_of_files(const statement& said, const std::vector<std::string>& events) {
    return said.text([&](const statement_part& p) {
        if (p.kind == part_kind::event && std::cmp_less(p.number, events.size()))
            return message("event ", in_quotes(events[static_cast<std::size_t>(p.number)]));
        if (p.kind == part_kind::cure)
            for (const auto& [known, words] : cures_in_files)
                if (p.key == host::row_of(known).name) return std::string(words);
        return p.words;
    });
}

input_error wrong(const toml_value& v, std::string_view key, std::string_view text) {
    return input_error(message(position(v.place), key, key.empty() ? "" : ": ", text));
}

void placed(const toml_value& v, std::string_view key, const std::function<void()>& function) {
    try {
        function();
    } catch (const input_error&) {
        throw;
    } catch (const error& e) {
        throw wrong(v, key, in_words_of_files(e.said()));
    }
}

double number_in(const toml_value& v, std::string_view key) {
    if (const auto* const n = v.as<double>()) return *n;
    if (const auto* const n = v.as<std::int64_t>()) return static_cast<double>(*n);
    if (const auto* const text = v.as<std::string>()) {
        if (const std::optional<double> n = multiple_of_pi(*text)) return *n;
        throw wrong(v, key,
                    message("must be a number, and is the string ", in_quotes(*text),
                            ": write 1.5, or a multiple of pi as \"2 pi\""));
    }
    throw wrong(v, key, message("must be a number, and is ", v.kind()));
}

std::int64_t integer_in(const toml_value& v, std::string_view key) {
    if (const auto* const n = v.as<std::int64_t>()) return *n;
    if (const auto* const n = v.as<double>()) {
        if (std::fabs(*n) <= 9007199254740992.0 && *n == std::floor(*n)) return static_cast<std::int64_t>(*n);
        throw wrong(v, key, message("must be a whole number, and is ", *n));
    }
    throw wrong(v, key, message("must be a whole number, and is ", v.kind()));
}

const std::string& text_in(const toml_value& v, std::string_view key) {
    if (const auto* const text = v.as<std::string>()) return *text;
    throw wrong(v, key, message("must be a string, and is ", v.kind()));
}

bool truth_in(const toml_value& v, std::string_view key) {
    if (const auto* const truth = v.as<bool>()) return *truth;
    throw wrong(v, key, message("must be true or false, and is ", v.kind()));
}

std::vector<const toml_value*> items_in(const toml_value& v) {
    const auto* const array = v.as<toml_value::array>();
    if (array == nullptr) return {&v};
    std::vector<const toml_value*> items;
    for (const toml_value& item : *array) items.push_back(&item);
    return items;
}

std::vector<double> numbers_in(const toml_value& v, std::string_view key) {
    const auto* const array = v.as<toml_value::array>();
    if (array == nullptr) throw wrong(v, key, message("must be an array of numbers, and is ", v.kind()));
    std::vector<double> numbers;
    for (const toml_value& item : *array) numbers.push_back(number_in(item, key));
    return numbers;
}

std::vector<std::string> texts_in(const toml_value& v, std::string_view key) {
    std::vector<std::string> texts;
    for (const toml_value* const item : items_in(v)) texts.push_back(text_in(*item, key));
    return texts;
}

section::section(const toml_value& table, std::string path) : table_(table), path_(std::move(path)) {
    if (table_.as<toml_value::table>() == nullptr)
        throw wrong(table_, path_, message("must be a table, and is ", table_.kind()));
}

std::string section::full(std::string_view key) const { return message(path_, path_.empty() ? "" : ".", key); }

const toml_value* section::find(std::string_view key) {
    asked_.emplace_back(key);
    for (const toml_value::entry& e : *table_.as<toml_value::table>())
        if (e.key == key) return &e.value;
    return nullptr;
}

void section::finish() const {
    for (const toml_value::entry& e : *table_.as<toml_value::table>())
        if (std::find(asked_.begin(), asked_.end(), e.key) == asked_.end())
            throw wrong(e.value, full(e.key), "there is no such key" + suggestion(e.key, asked_));
}

}  // namespace myriad::programs
