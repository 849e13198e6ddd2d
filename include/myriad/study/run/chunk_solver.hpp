// SPDX-License-Identifier: MIT
// Computes a chunk of a study's instances: sets them as the axes say, integrates them, and copies what is kept. Host
// code only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/study/plan/study_plan.hpp"
#include "myriad/study/store/store.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// How an integration went.
struct solved {
    std::array<std::int64_t, status_count> by_status{};
    std::vector<statement> notes;
    /// Adds how another one went; of different notes, the first sixteen stay.
    void add(const solved& more);
};

/// Instances of a study on one device, one part after the other. One thread uses it at a time.
class chunk_solver {
public:
    virtual ~chunk_solver() = default;
    /// Sets instances [first, first + count) to what the axes and the generator say.
    virtual void prepare(std::int64_t first, std::int64_t count) = 0;
    /// Integrates them; `progress` is told how many of them are done. Throws what `myriad::solve` throws.
    virtual solved integrate(const device& where, const std::function<void(std::int64_t done)>& progress) = 0;
    /// Copies a variable of all of them, in row-major order, the instance outermost.
    virtual void copy(const quantity& what, std::byte* to) const = 0;
    /// Frees the memory of the instances.
    virtual void clear() = 0;
    /// Whether it works on a device by itself: what it throws is then the device's failure.
    virtual bool on_device() const { return false; }
    /// Most instances that the device has memory for.
    virtual std::int64_t most_at_a_time() { return std::numeric_limits<std::int64_t>::max(); }
    /// Whether it does a reduction of the plan itself, so that its input need not be copied; if so, adds it to `to`.
    virtual bool reduce(std::size_t /*number*/, reduction_state& /*to*/) { return false; }
};

/// A model, a method and a real type: what a study needs of them.
class any_model {
public:
    virtual ~any_model() = default;
    virtual const component_names& names() const = 0;
    virtual std::string method() const = 0;
    virtual element real() const = 0;
    /// Throws `error` if an option is invalid, or if the device has no kernel for them.
    virtual void check(const device& where, const options& o) const = 0;
    /// Bytes of memory that a call takes on the host for one instance.
    virtual double bytes_per_instance(const options& o) const = 0;
    /// A solver for that device.
    virtual std::unique_ptr<chunk_solver> make_solver(const study_plan& plan, const device& where) const = 0;
    /// One that sets and reduces instances on the GPU; null if that cannot be.
    virtual std::unique_ptr<chunk_solver> make_device_solver(const study_plan& /*plan*/,
                                                             const device& /*where*/) const {
        return nullptr;
    }
    /// What the last digits depend on there.
    virtual arithmetic arithmetic_on(const device& where) const = 0;
    /// What it does, for a store to tell it from others; null where nothing can be asked.
    virtual std::shared_ptr<const model_behaviour> behaviour(const study_plan& /*plan*/,
                                                             const std::vector<device>& /*devices*/) const {
        return nullptr;
    }
    /// What stands for the generator of instances; empty if there is none.
    virtual std::string generator() const = 0;
    /// Whether that is the model's own.
    virtual bool generates_itself() const { return false; }
};

}  // namespace myriad::studies::inline MYRIAD_ABI
