// SPDX-License-Identifier: MIT
// Compiles a model's header to a shared object, by this machine's C++ compiler, and loads it, so that the program knows
// the model. What was compiled is kept. Host code only.
#pragma once

#include <functional>
#include <string>

#include "myriad/study/layout.hpp"
#include "program/model_source.hpp"

namespace myriad::programs {

/// What is compiled.
struct compile_request {
    model_source source;
    std::string model, method;  ///< as in C++; the library's names may be without `myriad::`
    studies::element real = studies::element::f64;
};

/// Registers the model with that method. `flags` is the file that says where the library's headers are: a folder, from
/// its own or absolute, or an option of the compiler in each line. `tell` is called with what takes time. Throws
/// `error` with the first messages of the compiler if it refuses the model, and if there is no compiler.
///
/// Shared objects are kept in the folder $MYRIAD_CACHE_DIR, or myriad in the user's folder of caches, under a name that
/// depends on the model, the library, the compiler and the CPU; where that cannot be written, for this process alone.
void compile_and_load(const compile_request& wanted, const std::string& flags,
                      const std::function<void(const std::string&)>& tell);

}  // namespace myriad::programs
