// SPDX-License-Identifier: MIT
// The part of `solve` that depends neither on the model nor on the method: compiled in the library. Host code only.
#pragma once

#include "myriad/host/backend/cpu_kernel.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/chunks/chunked_solve.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Throws `error` if the program has no kernel for the device, or may not use it.
void check_kernel(const device& where, bool exists);

/// The part of `solve` that depends neither on the model nor on the method; takes one of the two kernels.
template <class R>
void integrate_all(const device& where, const options& o, const any_run* on_cpu, chunk_source* on_gpu,
                   ensemble_data<R>& instances, data_check<R>& check, report_of<R>& result);
extern template void integrate_all(const device&, const options&, const any_run*, chunk_source*, ensemble_data<double>&,
                                   data_check<double>&, report_of<double>&);
extern template void integrate_all(const device&, const options&, const any_run*, chunk_source*, ensemble_data<float>&,
                                   data_check<float>&, report_of<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
