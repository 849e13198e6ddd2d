// SPDX-License-Identifier: MIT
// How the host tells a running kernel to stop: a word of device memory that threads read now and then, written by a
// copy in a stream of its own. Reading the host's memory instead would take all threads of a large kernel across the
// bus.
#pragma once

#include <atomic>
#include <cstdint>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/resources.cuh"
#include "myriad/kernel/core/stop_request.hpp"

namespace myriad::cuda {

class stop_line {
public:
    stop_line() { word_.reserve(sizeof(std::uint32_t)); }

    /// Where kernels read.
    const std::uint32_t* word() const { return static_cast<const std::uint32_t*>(word_.data()); }
    /// Before a launch in that stream: takes back what was asked of earlier kernels.
    void clear(gpu::stream_handle where) {
        if (!used_.exchange(false)) return;
        MYRIAD_GPU_CALL(gpu::synchronise(asking_.get()));
        MYRIAD_GPU_CALL(gpu::fill(word_.data(), 0, sizeof(std::uint32_t), where));
    }
    /// Any thread may call it, with the device current.
    void ask(detail::stop_request how) {
        used_ = true;
        MYRIAD_GPU_CALL(gpu::copy(word_.data(), pinned_ + static_cast<std::uint32_t>(how), sizeof(std::uint32_t),
                                  gpu::direction::to_device, asking_.get()));
    }

private:
    /// The values of all requests, in pinned memory, as other copies might wait for the kernel. Kept for good.
    static const std::uint32_t* requests() {
        static const std::uint32_t* const values = [] {
            constexpr std::uint32_t count = 4;
            void* memory = nullptr;
            MYRIAD_GPU_CALL(gpu::allocate_pinned(&memory, count * sizeof(std::uint32_t)));
            auto* const all = static_cast<std::uint32_t*>(memory);
            for (std::uint32_t i = 0; i < count; ++i) all[i] = i;
            return all;
        }();
        return values;
    }

    const std::uint32_t* const pinned_ = requests();  // allocated before there are kernels, which that may wait for
    device_memory word_;
    stream asking_;
    std::atomic<bool> used_{true};
};

}  // namespace myriad::cuda
