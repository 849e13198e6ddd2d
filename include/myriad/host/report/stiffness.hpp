// SPDX-License-Identifier: MIT
// Finds out, after an explicit method has run, whether stability rather than accuracy limited its steps. Compiled in
// the library, for models that are known by their functions alone. Host code only.
#pragma once

#include <cstdint>

#include "myriad/host/checks/instance_functions.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The distance between the 64 or so instances that are examined.
constexpr std::int64_t examined_stride(std::int64_t size) { return size < 128 ? 1 : size / 64; }
/// Whether `note_stiffness` examines instances.
template <class R>
bool examines_stiffness(const report_of<R>& r, std::int64_t size, const options& o, const instance_functions<R>& call) {
    constexpr std::int64_t worthwhile = 200;  // steps per instance
    return call.rhs != nullptr && o.advice == advice::on && r.accepted_steps + r.rejected_steps >= worthwhile * size;
}

/// For an explicit method whose steps are stable up to `limit`, examines 64 or so instances in their current states.
/// Steps limited by stability stay near that limit; those limited by accuracy resolve the fastest mode and stay well
/// below. But a step may be near both limits, as in the calm parts of chaotic motion: then a stiff method gains
/// nothing, which a trial step shows.
template <class R>
stiffness find_stiffness(const ensemble_data<R>& e, const options& o, double limit, const single_instances<R>& of);

/// Adds a note if stability, not accuracy, limited the steps of an explicit method, in half or more of the instances
/// examined. Runs of fewer than 200 steps per instance are not worth it. Nothing is noted where the model cannot be
/// asked.
template <class R>
void note_stiffness(report_of<R>& r, const ensemble_data<R>& e, const options& o, const single_instances<R>& of);

}  // namespace myriad::host::inline MYRIAD_ABI
