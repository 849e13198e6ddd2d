// SPDX-License-Identifier: MIT
// GPU engines kept between calls of `solve`, since creating one takes longer than integrating a small ensemble. Host
// code only.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

#include <unistd.h>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/chunks/chunk_plan.hpp"
#include "myriad/host/threads/object_pool.hpp"

namespace myriad::host {

/// Whether this process is the first to use GPUs, and not a fork of one that has: a fork would wait for driver threads
/// and engines that it does not have.
inline bool may_use_gpus() {
    static std::atomic<pid_t> user{0};
    pid_t first = 0;
    return user.compare_exchange_strong(first, getpid()) || first == getpid();
}

/// The function that creates an engine for a model and a real type: one for each method.
template <class Model, class R>
using engine_maker = std::unique_ptr<cuda::engine<Model, R>> (*)(const cuda::engine_options&);

/// The idle engines of all methods of a model.
template <class Model, class R>
class idle_engines {
    using engine = std::unique_ptr<cuda::engine<Model, R>>;
    using maker = engine_maker<Model, R>;
    struct use {
        maker make;
        cuda::engine_options how;
        bool operator==(const use& other) const { return make == other.make && how == other.how; }
    };
    using idle = object_pool<use, cuda::engine<Model, R>>;

public:
    static engine take(maker make, const cuda::engine_options& how) {
        engine found = idle::all().take({make, how});
        return found != nullptr ? std::move(found) : make(how);
    }
    /// Only for engines that have finished without an error. For each method as many are kept as a call may use.
    static void give(maker make, const cuda::engine_options& how, engine e) {
        e->rest();
        idle::all().give({make, how}, std::move(e));
        idle::all().keep_at_most(static_cast<std::size_t>(most_chunks_held),
                                 [make](const use& other) { return other.make == make; });
    }
};

}  // namespace myriad::host
