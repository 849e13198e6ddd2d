// SPDX-License-Identifier: MIT
// The kernels of teams on a CPU, whose threads run one after the other. For files that define MYRIAD_SIMULATED_TEAM
// before they include anything.
#pragma once

#include <cstdint>
#include <cstring>

#include <myriad/instantiate.hpp>

#include "myriad/kernel/integrator/integrate.hpp"
#include "myriad/kernel/integrator/team_choice.hpp"

namespace simulated {

constexpr int most_threads = 64, most_numbers = 4096;
/// Runs a function in all threads of a team.
void run_team(int threads, void (*work)());

}  // namespace simulated

namespace myriad::detail::inline MYRIAD_TARGET {

/// All instances, one after the other.
struct each_instance {
    std::int64_t size, given = 0;
    std::int64_t next() { return given < size ? given++ : -1; }
};

template <class Model, class Method, int threads>
run_statistics run_in_teams(const any_arguments<double>& from, const run_options&) {
    using part = part_of_units<Model, threads>;
    using arrays = argument_arrays<part, double>;
    static_assert(runs_in_teams<Model, Method>());
    static_assert(sizeof(arrays) == sizeof(argument_arrays<Model, double>));
    static_assert((part::template bytes_of_block<double> + threads * part::template bytes_of_thread<double>) /
                      sizeof(double) <=
                  simulated::most_numbers);
    static kernel_arguments<part, double> arguments;
    static std::int64_t turns;
    static_cast<argument_head<double>&>(arguments) = from;
    std::memcpy(static_cast<arrays*>(&arguments), from.arrays, sizeof(arrays));
    if constexpr (has_diffusion<Model>)
        std::memcpy(&arguments.noise, from.arrays + from.offsets().noise, sizeof(arguments.noise));
    part::stage_tolerances(arguments, 0, 1);
    simulated::run_team(threads, [] {
        each_instance instances{arguments.size};
        turns = detail::integrate<part, Method, double>(arguments, arguments.shared, instances);
    });
    return {turns, 1, 1};
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

#define INTEGRATE_IN_TEAMS(Model, Method, threads)                                                \
    template <>                                                                                   \
    myriad::detail::run_statistics myriad::openmp::run_on<Model<threads>, Method, double>(        \
        for_set<instruction_set::MYRIAD_INSTRUCTION_SET>, const any_arguments<double>& arguments, \
        const run_options& options) {                                                             \
        return myriad::detail::run_in_teams<Model<threads>, Method, threads>(arguments, options); \
    }
