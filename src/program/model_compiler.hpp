// SPDX-License-Identifier: MIT
// Compiles a model's header to a shared object, by this machine's C++ compiler, and loads it, so that the program knows
// the model. What was compiled is kept. Host code only.
#pragma once

#include <functional>
#include <string>

#include "myriad/study/plan/layout.hpp"
#include "program/model_source.hpp"

namespace myriad::programs {

/// What is compiled.
struct compile_request {
    model_source source;
    std::string model, method;  ///< as in C++; the library's names may be without `myriad::`
    studies::element real = studies::element::f64;
};

/// Whether the user has asked for it that a source is compiled and its code run, as by `run`.
enum class compile_permission {
    given,
    not_given,  ///< only what the same user has compiled before
};

/// Registers the model with that method. `flags` is the file that says where the library's headers are: a folder, from
/// its own or absolute, or an option of the compiler in each line. `tell` is called with what takes time, `warn` with
/// why nothing can be kept. Throws `error` with the first messages of the compiler if it refuses the model, if there is
/// no compiler, and if there is no permission. What is compiled is kept in the cache, under a name that depends
/// on the model, the library, the compiler and the CPU.
void compile_and_load(const compile_request& wanted, const std::string& flags, compile_permission permission,
                      const std::function<void(const std::string&)>& tell,
                      const std::function<void(const std::string&)>& warn);

}  // namespace myriad::programs
