// SPDX-License-Identifier: MIT
// The idle engines of all models.
#include "myriad/host/chunks/idle_engines.hpp"

#include <atomic>
#include <cstddef>

#include <unistd.h>

#include "myriad/host/chunks/chunk_plan.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/threads/object_pool.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

struct use {
    engine_key kind;
    cuda::engine_options how;
    bool operator==(const use& other) const { return kind == other.kind && how == other.how; }
};
using idle = object_pool<use, cuda::any_engine>;

}  // namespace

bool may_use_gpus() {
    static std::atomic<pid_t> user{0};
    pid_t first = 0;
    return user.compare_exchange_strong(first, getpid()) || first == getpid();
}

void check_may_use_gpus() {
    require(may_use_gpus(),
            "this process was forked from one that has used a GPU, which a fork cannot: fork before that, use the CPU, "
            "or start a new program (exec)");
}

std::unique_ptr<cuda::any_engine> take_idle_engine(engine_key kind, const cuda::engine_options& how) {
    return idle::all().take({kind, how});
}
void give_idle_engine(engine_key kind, const cuda::engine_options& how, std::unique_ptr<cuda::any_engine> e) {
    e->rest();
    idle::all().give({kind, how}, std::move(e));
    idle::all().keep_at_most(static_cast<std::size_t>(most_chunks_held),
                             [kind](const use& other) { return other.kind == kind; });
}

}  // namespace myriad::host::inline MYRIAD_ABI
