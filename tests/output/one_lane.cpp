// SPDX-License-Identifier: MIT
// Compiles a scalar lane with dense output, whatever the instruction set.
#include <myriad/instantiate.hpp>

#include "tests/output/models.hpp"


namespace output {

template <class Model, class Method>
myriad::run_statistics run_one_lane(const myriad::kernel_arguments<Model, double>& arguments,
                                    const myriad::run_options& options) {
    return myriad::run_packs<Model, Method, double, 0>(arguments, options);
}

template myriad::run_statistics run_one_lane<bouncing, myriad::dense<myriad::cash_karp>>(
    const myriad::kernel_arguments<bouncing, double>&, const myriad::run_options&);

}  // namespace output
