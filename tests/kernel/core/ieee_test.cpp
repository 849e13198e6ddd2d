// SPDX-License-Identifier: MIT
// Files compiled with parts of -ffast-math that no macro reveals are refused at the start, before any integration.
#include "myriad/kernel/core/ieee.hpp"

#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"

using ensemble_models::bare;

TEST_CASE("arithmetic is as written in this program") { CHECK(myriad::detail::computes_as_written()); }

TEST_CASE("a kernel whose file was compiled with a part of -ffast-math is refused at the start") {
    myriad::host::cpu_kernel<double> kernel;
    kernel.run = [](const myriad::detail::any_arguments<double>&, const myriad::detail::run_options&) {
        return myriad::detail::run_statistics{.computed_as_written = false};
    };
    refused([&] { myriad::host::run_kernel(kernel, {}, {}); },
            {"the model's file was compiled with a part of -ffast-math", "NaN passes for a number", "-fno-fast-math"});
}
