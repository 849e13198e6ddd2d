// SPDX-License-Identifier: MIT
// The components of a model by name, and what else of an instance a study sets or keeps: without the model's type, so
// that all of a study but one adapter is compiled once. Host code only.
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// Text that reads back as exactly that number.
std::string exact_text(double value);

/// What a named value of an instance is.
enum class component_kind {
    state,              ///< at the start, and at the end
    parameter,          ///< a parameter of the instance
    accessory,          ///< a real accessory
    integer_accessory,  ///< an integer accessory
    shared,             ///< the same for all instances
    shared_integer,     ///< the same for all instances, an integer
    t_begin,            ///< the begin of the time domain
    t_end,              ///< its end
};
/// The word for a kind before the point of a full name, as in "state.x".
const char* name_of(component_kind kind);

/// A component of a model, or one end of the time domain.
struct component {
    component_kind kind;    ///< what it is
    int number = 0;         ///< among the components of its kind
    std::string name = {};  ///< of its enumerator; empty if it has none

    /// Whether it is the same component.
    bool operator==(const component& other) const { return kind == other.kind && number == other.number; }
    /// "parameter.k", or "parameter.3" without an enumerator.
    std::string full_name() const;
};

/// Thrown for a name that no component has.
class unknown_component : public error {
public:
    using error::error;
};

/// All components of one model.
class component_names {
public:
    /// Of a model by its name.
    component_names(std::string model, std::vector<component> all);

    /// The name of the model.
    const std::string& model() const { return model_; }
    /// All of them, kind by kind.
    const std::vector<component>& all() const { return all_; }
    /// The component called "k", "parameter.k" or "parameter.3", if it is of one of the given kinds. Throws `error`,
    /// which lists the names there are, for any other name, and for one that several components have.
    const component& find(std::string_view name, std::initializer_list<component_kind> kinds) const;
    /// Whether results call something by this name that is no component's own value, as "t", "status" or "x_end".
    bool is_taken(std::string_view name) const;
    /// The name of a variable or an axis of results for this component: its own name if nothing else has it, otherwise
    /// with the kind, "state_x".
    std::string variable(const component& c) const;
    /// The name of its initial value, "x_start", if a call changes it; otherwise the same.
    std::string initial_variable(const component& c) const;

private:
    std::string choices(std::initializer_list<component_kind> kinds) const;

    std::string model_;
    std::vector<component> all_;
    std::map<std::string, int, std::less<>> uses_;  // how many have a name
};

}  // namespace myriad::studies::inline MYRIAD_ABI
