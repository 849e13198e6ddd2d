// SPDX-License-Identifier: MIT
// Compiles a scalar lane with dense output, whatever the instruction set.
#include <myriad/instantiate.hpp>

#include "tests/kernel/output/models.hpp"

namespace output {

template <class Model, class Method>
myriad::detail::run_statistics run_one_lane(const myriad::detail::any_arguments<double>& arguments,
                                            const myriad::detail::run_options& options) {
    return myriad::detail::run_packs<Model, Method, double, 0>(arguments, options);
}

template myriad::detail::run_statistics run_one_lane<bouncing, myriad::dense<myriad::cash_karp>>(
    const myriad::detail::any_arguments<double>&, const myriad::detail::run_options&);

}  // namespace output
