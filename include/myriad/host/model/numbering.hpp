// SPDX-License-Identifier: MIT
// Maps numbers and enumerators to a model's components, and names them in messages. Host code only.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// A component's name in messages: "state 1 (v)", or "t_end", which has no number.
struct component_label {
    static constexpr part_kind part = part_kind::component;
    std::string_view what;
    int number = -1;
    std::string_view enumerator = {};  ///< empty if the model has none

    friend std::ostream& operator<<(std::ostream& out, const component_label& label);
};

// Compilers write a template's argument into __PRETTY_FUNCTION__, after "C = " or "value = " and up to the last
// bracket.
template <class C>
constexpr auto enumeration_text() {
    return std::string_view(__PRETTY_FUNCTION__);
}
template <auto value>
constexpr auto enumerator_text() {
    return std::string_view(__PRETTY_FUNCTION__);
}

/// The name of a type, as "duffing::state"; different for any two named enumerations.
template <class C>
constexpr std::string_view enumeration_name() {
    constexpr std::string_view text = enumeration_text<C>(), begin = "C = ";
    constexpr std::size_t from = text.find(begin) + begin.size();
    return text.substr(from, text.rfind(']') - from);
}

/// The last part of the name of an enumerator, as "v"; empty for a value without one.
template <auto value>
constexpr std::string_view enumerator_name() {
    std::string_view text = enumerator_text<value>();
    text = text.substr(0, text.rfind(']'));
    const std::string_view name = text.substr(text.find_last_of(": =") + 1);
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    for (const char c : name)
        if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || is_digit(c))) return {};  // "(state)7"
    return name.empty() || is_digit(name[0]) ? std::string_view() : name;
}
template <class C, int number>
constexpr std::string_view enumerator_of() {
    // Not a static_cast, which is undefined for a number beyond the enumeration's bits.
    return enumerator_name<std::bit_cast<C>(static_cast<std::underlying_type_t<C>>(number))>();
}
/// Only the first components are named, since each name costs compile time; a matrix names only its first entry anyway.
constexpr int named_ones(int count) { return count < 64 ? count : 64; }
template <class C, int count>
constexpr auto enumerators_of() {
    return []<int... number>(std::integer_sequence<int, number...>) {
        return std::array<std::string_view, sizeof...(number)>{enumerator_of<C, number>()...};
    }
    (std::make_integer_sequence<int, count>{});
}

/// "x_0", "v_0", "x_1", ...: the components of all units, which are named like those of one.
std::vector<std::string> names_in_units(std::span<const std::string_view> of_one, int units);
template <class C, int count>
std::vector<std::string> names_in_units(int units) {
    static constexpr auto of_one = enumerators_of<C, count>();
    return names_in_units(of_one, units);
}

/// Throws `error` if there is no component of that number.
void check_component(std::int64_t number, int count, std::string_view what);

// How the components of a kind are numbered and named. `index` takes an integer, or an enumerator of the enumeration
// for this kind: any other is a mistake.
#define MYRIAD_NUMBERING(kind, plural, words, type)                                                                   \
    template <class Model>                                                                                            \
    struct kind##_numbering {                                                                                         \
        static constexpr std::string_view what = words;                                                               \
        static constexpr int count = n_##kind<Model>;                                                                 \
        static constexpr bool has_names = requires { typename Model::kind; };                                         \
        /* the name of the enumeration; empty if it has none */                                                       \
        static constexpr std::string_view enumeration() {                                                             \
            if constexpr (has_names) return enumeration_name<typename Model::kind>();                                 \
            return {};                                                                                                \
        }                                                                                                             \
        template <class C>                                                                                            \
        static std::int64_t index(C c) {                                                                              \
            static_assert(std::is_enum_v<C> || std::is_integral_v<C>, "give a number or an enumerator of the model"); \
            if constexpr (std::is_enum_v<C> && has_names) {                                                           \
                static_assert(std::is_same_v<C, typename Model::kind>,                                                \
                              "this enumerator is not a " #kind                                                       \
                              " of the model; where the model declares anew an enumeration "                          \
                              "that it inherits, give those of the inherited one as numbers");                        \
            }                                                                                                         \
            return static_cast<std::int64_t>(c);                                                                      \
        }                                                                                                             \
        /* what messages call component c, which exists */                                                            \
        static component_label label(int c) {                                                                         \
            component_label label{what, c};                                                                           \
            if constexpr (has_names) {                                                                                \
                if constexpr (std::is_enum_v<typename Model::kind>) {                                                 \
                    static constexpr auto names = enumerators_of<typename Model::kind, named_ones(count)>();          \
                    if (c < named_ones(count)) label.enumerator = names[static_cast<std::size_t>(c)];                 \
                }                                                                                                     \
            }                                                                                                         \
            if constexpr (requires { typename Model::unit_##kind; } && n_unit < Model >> 0) {                         \
                static const std::vector<std::string> names =                                                         \
                    names_in_units<typename Model::unit_##kind, n_unit_##kind<Model>>(n_unit<Model>);                 \
                const int in_units = c - n_##kind<typename Model::unit_type>;                                         \
                if (in_units >= 0 && static_cast<std::size_t>(in_units) < names.size())                               \
                    label.enumerator = names[static_cast<std::size_t>(in_units)];                                     \
            }                                                                                                         \
            return label;                                                                                             \
        }                                                                                                             \
        /* the same; throws `error` if there is no such component */                                                  \
        template <class C>                                                                                            \
        static component_label find(C c) {                                                                            \
            const std::int64_t number = index(c);                                                                     \
            check_component(number, count, what);                                                                     \
            return label(static_cast<int>(number));                                                                   \
        }                                                                                                             \
    };
MYRIAD_COMPONENT_KINDS(MYRIAD_NUMBERING)
#undef MYRIAD_NUMBERING

}  // namespace myriad::host::inline MYRIAD_ABI
