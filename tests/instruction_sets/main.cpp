// SPDX-License-Identifier: MIT
// Prints the results of a sweep bit by bit, below the instruction set it was integrated with.
#include <cstdio>
#include <exception>

#include <myriad/myriad.hpp>

#include "model.hpp"

namespace {

void integrate_and_print() {
    using model = bouncing_pendulum;
    constexpr double tolerance = 1e-9;
    constexpr std::int64_t instances = 101;  // no multiple of any number of lanes
    myriad::ensemble<model> sweep(instances);
    sweep.parameter(model::drive) = Eigen::ArrayXd::LinSpaced(instances, 0.5, 1.5);
    sweep.parameter(model::side) = 0.8;
    sweep.state(model::angle) = 0.1;
    sweep.state(model::speed) = 0;
    sweep.accessory(model::fastest) = 0;
    sweep.time_domain(0, 20);
    const auto report = myriad::solve<myriad::cash_karp>(
        myriad::device::cpu(2), sweep,
        {.relative_tolerance = tolerance,
         .absolute_tolerance = tolerance,
         .events = {{.direction = myriad::direction::rising, .tolerance = 10 * tolerance}}});
    std::printf("# %s\n", report.instruction_set.c_str());
    for (std::int64_t i = 0; i < instances; ++i)
        std::printf("%a %a %a %d %d\n", sweep.state(model::angle)[i], sweep.state(model::speed)[i],
                    sweep.accessory(model::fastest)[i], static_cast<int>(sweep.accepted_steps()[i]),
                    static_cast<int>(sweep.status(i)));
}

}  // namespace

int main() {
    try {
        integrate_and_print();
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
    }
    return 1;
}
