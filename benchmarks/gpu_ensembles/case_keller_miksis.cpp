// SPDX-License-Identifier: MIT
// The case keller_miksis: a bubble in water at one frequency; its instances' costs differ 50-fold.
#include "cases.hpp"
#include "reference.hpp"
#include "sweeps.hpp"

namespace gpu_ensembles {
namespace {

std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    const problem<keller_miksis> what{bubble_options(64, 1e-10), &fill_bubbles, &start_bubbles};
    return {measure_myriad<myriad::cash_karp>(what, size, how, [&](const auto&, measurement& m) {
        set_errors(m, differences_from_cpu<myriad::cash_karp>(what, size, how.device));
    })};
}

}  // namespace

benchmark_case keller_miksis_case() {
    return {.name = "keller_miksis",
            .work =
                "64 phases tau in [0, 1] from (1, 0), t and step restarted in each, Cash-Karp, tolerances 1e-10, f1 = "
                "geomspace(20 kHz, 1000 kHz, N) at 1.5 bar, power and angles by exp2(y log2 x), sinpi and cospi",
            .error = "difference of 64 instances from the CPU backend after 1 phase, over max(1, |value|)",
            .allowed_error = 1e-7,
            .sizes = {8192, 46080},
            .measure = &measure};
}

}  // namespace gpu_ensembles
