// SPDX-License-Identifier: MIT
// Models for the command-line program: a source file with MYRIAD_REGISTER_MODEL, linked with the target
// myriad::program, which has the function main, makes a program like `myriad` that knows these models. Host code only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "myriad/host/model/numbering.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/methods.hpp"
#include "myriad/study/model_study.hpp"
#include "myriad/study/plan/component_names.hpp"
#include "myriad/study/plan/layout.hpp"
#include "myriad/study/run/chunk_solver.hpp"

namespace myriad::programs::inline MYRIAD_ABI {

/// A method for which a model was compiled, and its real type.
struct program_method {
    std::string name;                               ///< as in C++, without `myriad::`: "dense<cash_karp>"
    studies::element real = studies::element::f64;  ///< f64 or f32
    std::function<std::shared_ptr<const studies::any_model>()> make;  ///< what a study needs of the model
};

/// A model that the program knows.
struct program_model {
    studies::component_names names;       ///< of the model and its components
    std::vector<std::string> events;      ///< names of its events, empty where it has no enumerator for one
    std::vector<program_method> methods;  ///< for which it was compiled
};

/// Adds a model, or methods to one of the same name. `sizes` are the sizes of types that the program shares with the
/// file that registers the model: throws `error` if they are others here, as for a file that was compiled with headers
/// of another version.
void add_model(program_model added, std::size_t sizes);
/// All models, in the order in which they were registered.
const std::vector<program_model>& registered_models();

/// What `add_model` compares.
inline constexpr std::size_t sizes_of_shared_types =
    sizeof(program_model) +
    256 * (sizeof(options) + 256 * (sizeof(studies::study_plan) + 256 * sizeof(report_of<double>)));

/// A type as users write it: without the library's namespaces.
std::string plain_name(std::string_view type);

/// Adds a model with these methods: what the macros below call.
template <class Model, class R, class... Methods>
bool register_model() {
    program_model made{.names = studies::names_of_components<Model>(), .events = {}, .methods = {}};
    for (int e = 0; e < host::event_numbering<Model>::count; ++e)
        made.events.emplace_back(host::event_numbering<Model>::label(e).enumerator);
    (made.methods.push_back({plain_name(host::enumeration_name<Methods>()), studies::element_of<R>,
                             [] { return std::make_shared<studies::model_of<Model, Methods, R>>(); }}),
     ...);
    add_model(std::move(made), sizes_of_shared_types);
    return true;
}

}  // namespace myriad::programs::inline MYRIAD_ABI

#define MYRIAD_NAME_WITH_LINE(name, line) MYRIAD_NAME_AND_LINE(name, line)
#define MYRIAD_NAME_AND_LINE(name, line) name##line

/// Makes a model and the methods that MYRIAD_INSTANTIATE has compiled for it known to the program:
/// `MYRIAD_REGISTER_MODEL(duffing, myriad::cash_karp, myriad::tsitouras_5)`. It stands at namespace scope, in a file
/// of host code, which is none of the model files. One such line for each model.
#define MYRIAD_REGISTER_MODEL(Model, ...)                                               \
    [[maybe_unused]] static const bool MYRIAD_NAME_WITH_LINE(myriad_model_, __LINE__) = \
        myriad::programs::register_model<Model, double, __VA_ARGS__>();
/// The same in single precision, for what MYRIAD_INSTANTIATE_FLOAT has compiled.
#define MYRIAD_REGISTER_MODEL_FLOAT(Model, ...)                                               \
    [[maybe_unused]] static const bool MYRIAD_NAME_WITH_LINE(myriad_float_model_, __LINE__) = \
        myriad::programs::register_model<Model, float, __VA_ARGS__>();
