// SPDX-License-Identifier: MIT
// The checks of options that every call makes once.
#pragma once

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
#define MYRIAD_DECLARE_KIND(kind, ...) listed_components kind{};
    MYRIAD_COMPONENT_KINDS(MYRIAD_DECLARE_KIND)
#undef MYRIAD_DECLARE_KIND

    /// Refuses components of another kind, nonexistent components, and components named twice.
    void check(const char* what, const component_list& chosen, const listed_components& kind) const;
};
template <class Model>
inline constexpr model_components components_of{
#define MYRIAD_LIST_KIND(kind, ...) .kind = {kind##_numbering<Model>::count, kind##_numbering<Model>::enumeration()},
    MYRIAD_COMPONENT_KINDS(MYRIAD_LIST_KIND)
#undef MYRIAD_LIST_KIND
};

/// The most trial steps that can be counted, with a real type of so many digits: fixed ones are counted in it.
std::int64_t most_steps(int digits);
/// The trial steps that a phase may take.
std::int64_t step_limit(const options& o, bool adaptive, int digits);

/// The properties of a model, a method and a real type that the options must fit.
struct option_limits {
    const model_components& components;
    int n_event;
    bool writes_times, adaptive, samples_trajectory, has_diffusion;
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
