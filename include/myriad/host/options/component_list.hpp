// SPDX-License-Identifier: MIT
// A list of components in options, which do not know the model yet, so the list remembers its enumerators'
// enumerations.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

#include "myriad/host/model/numbering.hpp"

namespace myriad {

/// Components of a model, by its enumerators or by numbers: `{duffing::x, duffing::v}`. Enumerators of the wrong
/// enumeration are refused by the call that receives the options.
class component_list {
public:
    /// A component in a list, which converts from an enumerator or a number.
    class component {
    public:
        /// From an enumerator, or a number counted from 0.
        template <class C>
        requires(std::is_enum_v<C> || std::is_integral_v<C>) component(C c)
            : number_(in_range(static_cast<std::int64_t>(c))) {
            if constexpr (std::is_enum_v<C>) enumeration_ = host::enumeration_name<C>();
        }

    private:
        friend component_list;
        static int in_range(std::int64_t number) {
            using limits = std::numeric_limits<int>;
            return static_cast<int>(std::clamp(number, std::int64_t{limits::min()}, std::int64_t{limits::max()}));
        }
        int number_;
        std::string_view enumeration_;
    };

    /// Empty, or of the components in braces or in a vector.
    component_list() = default;
    component_list(std::initializer_list<component> all) {
        for (const component& c : all) push_back(c);
    }
    template <class C>
    component_list(const std::vector<C>& all) {
        for (const C& c : all) push_back(c);
    }

    /// Appends a component.
    void push_back(const component& c) {
        numbers_.push_back(c.number_);
        enumerations_.push_back(c.enumeration_);
    }
    /// Whether there is none.
    bool empty() const { return numbers_.empty(); }
    /// The number of components.
    std::size_t size() const { return numbers_.size(); }
    /// Number of the i-th component, and the name of its enumeration: empty for a plain number.
    int operator[](std::size_t i) const { return numbers_[i]; }
    /// Name of the enumeration of the i-th component, as the compiler spells it; empty for a plain number.
    std::string_view enumeration(std::size_t i) const { return enumerations_[i]; }
    /// Iterators over the numbers of the components.
    auto begin() const { return numbers_.begin(); }
    /// The end of the numbers of the components.
    auto end() const { return numbers_.end(); }
    /// Whether both name the same components in the same order.
    bool operator==(const component_list& other) const { return numbers_ == other.numbers_; }

private:
    std::vector<int> numbers_;
    std::vector<std::string_view> enumerations_;
};

}  // namespace myriad
