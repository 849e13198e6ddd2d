// SPDX-License-Identifier: MIT
// The case keller_miksis_schedules: instances whose costs differ 50-fold, sorted by cost and shuffled, by schedule.
#include <numeric>
#include <random>

#include "cases.hpp"
#include "sweeps.hpp"

namespace gpu_ensembles {
namespace {

using myriad::schedule;

void fill_shuffled(myriad::ensemble<keller_miksis>& instances) {
    myriad::ensemble<keller_miksis> sorted(instances.size());
    fill_bubbles(sorted);
    std::vector<std::int64_t> from(static_cast<std::size_t>(instances.size()));
    std::iota(from.begin(), from.end(), std::int64_t{0});
    std::shuffle(from.begin(), from.end(), std::mt19937_64(43));
    for (int c = 0; c < keller_miksis::n_parameter; ++c)
        for (std::int64_t i = 0; i < instances.size(); ++i)
            instances.parameter(c)[i] = sorted.parameter(c)[from[static_cast<std::size_t>(i)]];
    instances.time_domain(0, 1);
}

std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    std::vector<measurement> all;
    for (const bool shuffled : {false, true}) {
        for (const schedule s : {schedule::in_order, schedule::dynamic, schedule::by_cost, schedule::automatic}) {
            problem<keller_miksis> what{bubble_options(8, 1e-10), shuffled ? &fill_shuffled : &fill_bubbles,
                                        &start_bubbles};
            what.options.schedule = s;
            all.push_back(measure_myriad<myriad::cash_karp>(what, size, how, [](const auto&, measurement&) {}));
            all.back().implementation = std::string(shuffled ? "shuffled " : "sorted ") + name_of(s);
        }
    }
    return all;
}

}  // namespace

benchmark_case schedule_case() {
    return {.name = "keller_miksis_schedules",
            .work = "8 phases of keller_miksis, in the order of the frequencies, and shuffled",
            .error = "not measured: tests/host/solve shows that schedules change no bit",
            .allowed_error = 0,
            .sizes = {46080, 614'400},
            .measure = &measure};
}

}  // namespace gpu_ensembles
