// SPDX-License-Identifier: MIT
// Results of a call that stay on its GPU, as the driver of chunks sees them. Host code only.
#pragma once

#include <memory>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// What takes the place of a call's copies where all instances are one chunk, and their results stay on the GPU.
template <class R>
class results_on_gpu {
public:
    /// Whether the GPU of this engine, which has no work, has room for them. If not, the call copies as any other.
    virtual bool fit(const cuda::engine<R>& worker) = 0;
    /// Copies all instances to the GPU, as `cuda::engine::upload` does.
    virtual void upload(cuda::engine<R>& worker, cuda::past of_instances) = 0;
    /// Takes the engine once they are integrated, and adds to the report how instances ended, and the work.
    virtual void keep(std::unique_ptr<cuda::engine<R>> worker, report_of<R>& result) = 0;

protected:
    ~results_on_gpu() = default;
};

}  // namespace myriad::host::inline MYRIAD_ABI
