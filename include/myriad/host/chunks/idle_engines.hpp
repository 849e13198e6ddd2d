// SPDX-License-Identifier: MIT
// GPU engines kept between calls of `solve`, since creating one takes longer than integrating a small ensemble. Host
// code only.
#pragma once

#include <memory>

#include "myriad/host/backend/backend.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Whether this process is the first to use GPUs, and not a fork of one that has: a fork would wait for driver threads
/// and engines that it does not have.
bool may_use_gpus();

/// The function that creates an engine for a model and a real type: one for each method.
template <class Model, class R>
using engine_maker = std::unique_ptr<cuda::engine<Model, R>> (*)(const cuda::engine_options&);

/// What tells engines for different models, methods and real types apart: the address of their maker.
using engine_key = const void*;

/// An idle engine of that kind, or null.
std::unique_ptr<cuda::any_engine> take_idle_engine(engine_key kind, const cuda::engine_options& how);
/// Only for engines that have finished without an error. For each method as many are kept as a call may use.
void give_idle_engine(engine_key kind, const cuda::engine_options& how, std::unique_ptr<cuda::any_engine> e);

}  // namespace myriad::host::inline MYRIAD_ABI
