// SPDX-License-Identifier: MIT
// Launches the phases of a call in the order of the schedule; owns the device memory for it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/cost_order.cuh"
#include "myriad/cuda/launch.cuh"
#include "myriad/cuda/resources.cuh"

namespace myriad::cuda {

template <class R>
class phase_scheduler {
    using arguments = any_arguments<R>;

public:
    phase_scheduler(schedule wanted, bool costs_differ) : wanted_(costs_differ ? wanted : schedule::in_order) {}

    /// Device memory per instance besides its own data: a cost and a place in the order.
    std::size_t bytes_per_instance() const {
        return wanted_ == schedule::by_cost || wanted_ == schedule::automatic ? 2 * sizeof(std::uint32_t) : 0;
    }
    /// Allocates memory for calls with that many phases; no work may be in progress.
    void reserve(std::int64_t count, std::int64_t phases, const kernel_launcher<R>& kernel) {
        const schedule how = chosen(count, phases, kernel);
        if (how == schedule::by_cost) by_cost_.reserve(count);
        if (how != schedule::in_order) queue_.reserve(sizeof(unsigned long long));
    }
    std::size_t bytes() const { return by_cost_.bytes(); }
    void release() { by_cost_.release(); }
    /// To be called after other instances have been uploaded.
    void forget_costs() { costs_known_ = false; }

    void launch(kernel_launcher<R>& kernel, arguments now, gpu::stream_handle where) {
        const schedule how = chosen(now.size, now.phases, kernel);
        kernel.note(how);
        if (how == schedule::in_order) return kernel.launch(now, nullptr, where);
        reserve(now.size, now.phases, kernel);
        if (how == schedule::dynamic) return launch_with_queue(kernel, now, where);
        now.cost = by_cost_.cost();
        if (!costs_known_) {
            by_cost_.clear(now.size, where);  // instances that have ended write no cost
            const std::int32_t phases = now.phases;
            now.phases = 1;
            launch_with_queue(kernel, now, where);
            now.phases = phases;
            now.first_phase = 1;
            costs_known_ = true;
        }
        if (now.first_phase == now.phases) return;
        by_cost_.sort(kernel.sort(), now.size, where);
        now.order = by_cost_.order();
        kernel.launch(now, nullptr, where);
    }

private:
    /// Sorting pays off if most of the work is still ahead. With fewer phases a queue pays off where a step takes much
    /// longer than fetching the next instance.
    schedule chosen(std::int64_t count, std::int64_t phases, const kernel_launcher<R>& kernel) const {
        const bool sortable = count <= most_sorted;
        if (wanted_ == schedule::automatic) {
            if (sortable && phases >= 4 && count > kernel.least_instances()) return schedule::by_cost;
            return kernel.makes_wait(count) ? schedule::dynamic : schedule::in_order;
        }
        return wanted_ == schedule::by_cost && !sortable ? schedule::dynamic : wanted_;
    }
    void launch_with_queue(kernel_launcher<R>& kernel, const arguments& now, gpu::stream_handle where) {
        auto* const queue = static_cast<unsigned long long*>(queue_.data());
        MYRIAD_GPU_CALL(gpu::fill(queue, 0, sizeof *queue, where));
        kernel.launch(now, queue, where);
    }

    schedule wanted_;
    bool costs_known_ = false;  // of the instances on the device
    device_memory queue_;
    cost_order by_cost_;
};

}  // namespace myriad::cuda
