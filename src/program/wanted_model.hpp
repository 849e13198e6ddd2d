// SPDX-License-Identifier: MIT
// The model and the method that a study names: those of the program, or of a header that is compiled. Host code only.
#pragma once

#include <string>

#include "myriad/program.hpp"
#include "program/model_compiler.hpp"
#include "program/model_source.hpp"
#include "program/study_file.hpp"

namespace myriad::programs {

/// The text that follows a key's place.
input_error wrong_at(const text_place& place, const std::string& text);
/// The model, which the program has. Throws `input_error` that says which one may have been meant.
const program_model& find_model(const study_file::model_choice& wanted);
/// The same of its method.
const program_method& find_method(const program_model& model, const study_file::model_choice& wanted);
/// Compiles a model's header and registers it.
void compile_model(const study_file::model_choice& wanted, const model_source& source, compile_permission permission,
                   bool quiet);

}  // namespace myriad::programs
