// SPDX-License-Identifier: MIT
// What the launch of a kernel depends on besides its compiled resources: for host code and for what compiles kernels.
#pragma once

#include <cstdint>

#include "myriad/kernel/model/model_facts.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::cuda {

/// The places for which a model's kernel is compiled: the constant bank for few shared parameters, the others for many.
constexpr bool is_compiled(shared_placement placement, int shared_bytes) {
    return (shared_bytes <= 1024) == (placement == shared_placement::constant_bank);
}

/// What the launch of a kernel depends on besides its compiled resources.
struct kernel_traits {
    detail::model_numbers model;
    std::int32_t shared_bytes;     // of both kinds of shared parameters
    std::int32_t max_block_size;   // as the model or the library limits it
    bool costs_differ;             // whether instances may differ in cost
    std::int32_t step_bytes;       // of shared memory that each thread takes, for its steps or for its team
    std::int32_t block_bytes = 0;  // of shared memory that a block takes besides
    std::int32_t team = 1;         // threads that integrate an instance together
};

/// Where a kernel of such a model has its launch parameters, in bytes: the members of `launch_arguments`.
template <class R>
struct launch_offsets {
    explicit constexpr launch_offsets(const detail::model_numbers& m) {
        const detail::argument_offsets<R> behind(m);
        queue = to_words(arrays + behind.end);
        shared_integer = shared() + detail::at_least_one(m.n_shared) * static_cast<int>(sizeof(R));
        end = to_words(shared_integer + detail::at_least_one(m.n_shared_integer) * 4);
    }
    constexpr int stop() const { return queue + word; }
    /// The shared parameters in the constant bank; the end, where they are elsewhere.
    constexpr int shared() const { return queue + 2 * word; }
    constexpr int bytes(shared_placement placement) const {
        return placement == shared_placement::constant_bank ? end : shared();
    }

    int arrays = sizeof(detail::argument_head<R>), queue = 0, shared_integer = 0, end = 0;

private:
    static constexpr int word = 8;
    static constexpr int to_words(int bytes) { return (bytes + word - 1) / word * word; }
};

}  // namespace myriad::cuda
