// SPDX-License-Identifier: MIT
// GPU engines kept between calls of `solve`, since creating one takes longer than integrating a small ensemble. Host
// code only.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Whether this process is the first to use GPUs, and not a fork of one that has: a fork would wait for driver threads
/// and engines that it does not have.
bool may_use_gpus();
/// Throws `error` unless that is so.
void check_may_use_gpus();

/// What tells engines for different models, methods and real types apart: the address of their maker.
using engine_key = const void*;

/// An idle engine of that kind, or null.
std::unique_ptr<cuda::any_engine> take_idle_engine(engine_key kind, const cuda::engine_options& how);
/// Only for engines that have finished without an error. For each method as many are kept as a call may use.
void give_idle_engine(engine_key kind, const cuda::engine_options& how, std::unique_ptr<cuda::any_engine> e);

/// How options say that engines are to work.
inline cuda::engine_options engine_options_for(const device& where, const options& o) {
    return {where.number(), o.block_size, o.shared_placement, o.schedule};
}

/// Engines for a model's kernels, idle or new ones.
template <class R>
struct engine_source {
    engine_key kind = nullptr;
    std::function<std::unique_ptr<cuda::engine<R>>(const cuda::engine_options&)> make = {};
    cuda::engine_options how = {};

    std::unique_ptr<cuda::engine<R>> take() const {
        auto idle = take_idle_engine(kind, how);  // all engines of that kind are the maker's
        return idle != nullptr ? std::unique_ptr<cuda::engine<R>>(static_cast<cuda::engine<R>*>(idle.release()))
                               : make(how);
    }
    void give(std::unique_ptr<cuda::engine<R>> e) const { give_idle_engine(kind, how, std::move(e)); }
};

}  // namespace myriad::host::inline MYRIAD_ABI
