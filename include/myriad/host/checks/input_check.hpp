// SPDX-License-Identifier: MIT
// The checks of an ensemble's data before an integration, by its model's type. Host code only.
#pragma once

#include <cstdint>

#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/checks/phase_check.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Checks the data of an ensemble (data_check.hpp).
template <class Model, class R>
class input_check : public data_check<R> {
public:
    input_check(ensemble<Model, R>& e, const options& o, std::int64_t count)
        : data_check<R>(ensemble_access::data(e), o, count, may_end_early<Model, R>(o)) {}
};

/// Checks the sample times of an ensemble (data_check.hpp).
template <class Model, class R>
void check_sample_times(const ensemble<Model, R>& e, const options& o, std::int64_t count) {
    check_sample_times(ensemble_access::data(e), o, count);
}

}  // namespace myriad::host::inline MYRIAD_ABI
