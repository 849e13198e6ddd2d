// SPDX-License-Identifier: MIT
// A call on several GPUs, whose results are on the host.
#pragma once

#include <string>
#include <vector>

#include "device_library.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "run.hpp"

namespace myriad::python {

/// The names of the devices: "cuda:0, cuda:1".
std::string names_of(const std::vector<placed_kernel>& on);

/// Integrates on several GPUs, each of which takes the next part of the instances whenever it has done one. Throws
/// `error` if an input is invalid or a GPU fails, and what the progress function throws, once the parts under way are
/// done.
template <class R>
void integrate_on_several(const std::vector<placed_kernel>& on, const std::vector<host::called_model<R>>& models,
                          const options& o, host::ensemble_data<R>& data, host::solve_call<R>& call,
                          report_of<R>& result);

}  // namespace myriad::python
