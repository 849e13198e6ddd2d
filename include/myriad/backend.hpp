// SPDX-License-Identifier: MIT
// The seam between host code and backends: the one function a backend provides for a model, a method and a real type,
// declared here and defined where the model is instantiated.
#pragma once

#include <cstdint>

#include "myriad/ensemble/view.hpp"

namespace myriad {

/// What a backend needs beside the kernel's arguments.
struct run_options {
    int threads = 0;  ///< OpenMP threads; 0: as OMP_NUM_THREADS or the machine says
    /// Called from the calling thread with the number of instances begun; may be null.
    void (*progress)(void* context, std::int64_t begun) = nullptr;
    void* context = nullptr;
};

/// How a run used its lanes.
struct run_statistics {
    std::int64_t lane_turns = 0;  ///< trial steps times lanes, those of idle lanes included
    int lanes = 1;                ///< instances side by side in one pack
    int threads = 1;
};

namespace openmp {
// Weak, so that a program that names a method nobody instantiated gets a readable error instead of one by the linker.
template <class Model, class Method, class R>
__attribute__((weak)) run_statistics run(const kernel_arguments<Model, R>& arguments, const run_options& options);
}  // namespace openmp

}  // namespace myriad
