// SPDX-License-Identifier: MIT
// The checks of options that every call makes once.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "myriad/host/core/error.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad {
namespace host::inline MYRIAD_ABI {

void check_count(const char* name, std::int64_t value, std::int64_t least, std::int64_t most);

/// The components of one kind that options may name.
struct listed_components {
    int count;
    std::string_view enumeration;  ///< its name; empty if it has none
};
/// The components of a model, and the names of all its enumerations.
struct model_components {
    listed_components state, accessory, integer_accessory;
    std::array<std::string_view, 7> enumerations;

    /// Refuses components of another kind, nonexistent components, and components named twice.
    void check(const char* what, const component_list& chosen, const listed_components& kind) const;
};
template <template <class> class numbering, class Model>
inline constexpr listed_components listed{numbering<Model>::count, numbering<Model>::enumeration()};
template <class Model>
inline constexpr model_components components_of{
    listed<state_numbering, Model>,
    listed<accessory_numbering, Model>,
    listed<integer_accessory_numbering, Model>,
    {state_numbering<Model>::enumeration(), parameter_numbering<Model>::enumeration(),
     accessory_numbering<Model>::enumeration(), integer_accessory_numbering<Model>::enumeration(),
     shared_numbering<Model>::enumeration(), shared_integer_numbering<Model>::enumeration(),
     event_numbering<Model>::enumeration()}};

/// The properties of a model, a method and a real type that the options must fit.
struct option_limits {
    const model_components& components;
    int n_event;
    bool writes_times, adaptive, samples_trajectory;
    int digits;                 ///< of the real type's mantissa
    double (*rounded)(double);  ///< a number rounded to the real type

    /// Refuses numbers that turn into zero or infinity in the ensemble's real type. `name`: what messages call the
    /// option, if not by its key.
    void check_kept(const char* key, double value, const char* name = nullptr) const;
    /// Throws `error`. One function for all models and methods, to save compiling it for each.
    void check(const options& o) const;
};

}  // namespace host::inline MYRIAD_ABI
}  // namespace myriad
