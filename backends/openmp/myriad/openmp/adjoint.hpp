// SPDX-License-Identifier: MIT
// MYRIAD_INSTANTIATE_ADJOINT on CPUs: the adjoint of a model as it is written in C++, by teams of OpenMP.
#pragma once

#include <algorithm>
#include <cstdint>

#include <omp.h>

#include "myriad/host/backend/cpu_adjoint.hpp"
#include "myriad/openmp/adjoint_packs.hpp"
#include "myriad/openmp/team.hpp"
#include "myriad/openmp/transposed_model.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The instances of a call, in parts for the threads of a team.
template <class Adjoint, class Method>
struct adjoint_parts {
    static constexpr std::int64_t part = 64;  // instances: whole packs
    const adjoint_call& call;
    const run_options& options;
    bool failed = false;

    static void work(void* context, int number) noexcept {
        auto& all = *static_cast<adjoint_parts*>(context);
        try {
            const std::int64_t first = number * part;
            detail::run_adjoint<Adjoint, Method>(all.call, first, std::min(first + part, all.call.size));
        } catch (...) {  // of a function of the model
            const bool is_first = !__atomic_exchange_n(&all.failed, true, __ATOMIC_ACQ_REL);
            if (is_first && all.options.caught != nullptr) all.options.caught(all.options.failure);
        }
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::openmp {

template <class Model, class Method, class Counts>
run_statistics adjoint_on(for_set<instruction_set::MYRIAD_INSTRUCTION_SET> set, const adjoint_call& call,
                          const run_options& options) {
    if (!computes_as_written()) return {.computed_as_written = false};
    using adjoint = detail::transposed_model<Model>;
    using S = adjoint_lanes<adjoint, Method>;
    using parts = detail::adjoint_parts<adjoint, Method>;
    parts all{call, options};
    constexpr std::size_t stack = 2 * sizeof(adjoint_pack<adjoint, Method, S, false>) + 65536;
    team members{&parts::work, &all, static_cast<int>((call.size + parts::part - 1) / parts::part), stack};
    in_parts(set, members);
    run_statistics used{.lanes = lanes_of<S>, .threads = members.threads};
    used.failed = all.failed;
    used.stack = members.stack;
    used.least_stack = members.least_stack;
    return used;
}

}  // namespace myriad::openmp

/// Compiles the adjoint of a model for one method.
#define MYRIAD_BACKEND_ADJOINT(Model, Method)                                             \
    template myriad::detail::run_statistics myriad::openmp::adjoint_on<Model, Method>(    \
        myriad::openmp::for_set<myriad::openmp::instruction_set::MYRIAD_INSTRUCTION_SET>, \
        const myriad::detail::adjoint_call&, const myriad::detail::run_options&);
