// SPDX-License-Identifier: MIT
// What was computed of a chunk, until it is kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "myriad/study/plan/study_plan.hpp"
#include "myriad/study/run/chunk_solver.hpp"
#include "myriad/study/run/result_keeper.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The values of quantities, and the reductions that the device has done.
class chunk_values {
public:
    /// `wanted`: of the plan's quantities, those that are copied from the device.
    chunk_values(const study_plan& plan, const std::vector<bool>& wanted);

    /// Room for the first `count` instances of `all` of the chunk.
    void make_room(std::int64_t all, std::int64_t count);
    /// Copies and reduces a piece, which begins at an instance of the chunk. Nothing is reduced twice if this throws.
    void take(chunk_solver& solver, std::int64_t at, const solved& piece);
    /// Reduces what the device has not, and hands all over.
    void commit(result_keeper& keeper, std::int64_t chunk, chunk_record record) const;
    /// How the integration of all pieces went.
    const solved& how() const { return how_; }

private:
    const study_plan& plan_;
    const std::vector<bool>& wanted_;
    solved how_;
    std::vector<std::vector<std::byte>> values_;
    std::vector<std::unique_ptr<reduction_state>> reduced_;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
