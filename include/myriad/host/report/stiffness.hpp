// SPDX-License-Identifier: MIT
// Finds out, after an explicit method has run, whether stability rather than accuracy limited its steps. Compiled in
// the library, for models that are known by their right-hand side alone. Host code only.
#pragma once

#include <cstdint>

#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The right-hand side of a model for any instance, without the model's type.
template <class R>
struct any_rhs {
    void* of;  ///< what `evaluate` takes
    /// The slopes of instance i at time t in state y.
    void (*evaluate)(void* of, std::int64_t i, R t, const R* y, R* slopes);
};

/// For an explicit method whose steps are stable up to `limit`, examines 64 or so instances in their current states.
/// Steps limited by stability stay near that limit; those limited by accuracy resolve the fastest mode and stay well
/// below. But a step may be near both limits, as in the calm parts of chaotic motion: then a stiff method gains
/// nothing, which a trial step shows.
template <class R>
stiffness find_stiffness(const ensemble_data<R>& e, const options& o, double limit, const any_rhs<R>& rhs);

/// Adds a note if stability, not accuracy, limited the steps of an explicit method, stable up to `limit()`, in half or
/// more of the instances examined. Runs of fewer than 200 steps per instance are not worth it.
template <class R>
void note_stiffness(report_of<R>& r, const ensemble_data<R>& e, const options& o, double (*limit)(),
                    const any_rhs<R>& rhs);

extern template stiffness find_stiffness(const ensemble_data<double>&, const options&, double, const any_rhs<double>&);
extern template stiffness find_stiffness(const ensemble_data<float>&, const options&, double, const any_rhs<float>&);
extern template void note_stiffness(report_of<double>&, const ensemble_data<double>&, const options&, double (*)(),
                                    const any_rhs<double>&);
extern template void note_stiffness(report_of<float>&, const ensemble_data<float>&, const options&, double (*)(),
                                    const any_rhs<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
