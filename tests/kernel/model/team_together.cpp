// SPDX-License-Identifier: MIT
// The kernels of teams, simulated: each thread is a context of its own, which runs up to where it waits for the others.
#define MYRIAD_SIMULATED_TEAM 1
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <myriad/instantiate.hpp>
#include <ucontext.h>

#include "myriad/kernel/integrator/integrate.hpp"
#include "myriad/kernel/integrator/team_choice.hpp"
#include "tests/kernel/model/teams.hpp"

namespace {

constexpr int most_threads = 64, most_numbers = 4096;
constexpr std::size_t bytes_of_stack = 512 << 10;

struct simulation {
    int threads, running, at_end;
    void (*work)();
    bool ended[most_threads];
    std::uint64_t exchanged[most_threads];
    ucontext_t host, thread[most_threads];
    alignas(16) char stack[most_threads][bytes_of_stack];
    double memory[most_numbers];
};
simulation now;

/// The thread after this one, around the team.
int next() {
    const int step = teams::order_of_threads == teams::order::first_thread_first ? 1 : now.threads - 1;
    return (now.running + step) % now.threads;
}
void go_on_with(int thread) {
    const int from = now.running;
    now.running = thread;
    swapcontext(&now.thread[from], &now.thread[thread]);
}
void run_thread() {
    now.work();
    now.ended[now.running] = true;
    if (++now.at_end == now.threads) setcontext(&now.host);
    now.running = next();
    setcontext(&now.thread[now.running]);
}

/// Runs a function in all threads of a team.
void run_team(int threads, void (*work)()) {
    now.threads = threads;
    now.work = work;
    now.at_end = 0;
    for (int i = 0; i < threads; ++i) {
        now.ended[i] = false;
        getcontext(&now.thread[i]);
        now.thread[i].uc_stack.ss_sp = now.stack[i];
        now.thread[i].uc_stack.ss_size = bytes_of_stack;
        now.thread[i].uc_link = nullptr;
        makecontext(&now.thread[i], &run_thread, 0);
    }
    now.running = teams::order_of_threads == teams::order::first_thread_first ? 0 : threads - 1;
    swapcontext(&now.host, &now.thread[now.running]);
}

}  // namespace

namespace myriad::simulated_team {

int number_of_thread() { return now.running; }
void synchronise(int) {
    if (now.at_end > 0) {
        std::fprintf(stderr, "a thread waits for others of its team, which have ended\n");
        std::abort();
    }
    go_on_with(next());
}
std::uint64_t exchange(std::uint64_t value, int from, int threads) {
    now.exchanged[now.running] = value;
    synchronise(threads);
    const std::uint64_t found = now.exchanged[from];
    synchronise(threads);
    return found;
}
void* memory() { return now.memory; }

}  // namespace myriad::simulated_team

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
                  most_numbers);
    static kernel_arguments<part, double> arguments;
    static std::int64_t turns;
    static_cast<argument_head<double>&>(arguments) = from;
    std::memcpy(static_cast<arrays*>(&arguments), from.arrays, sizeof(arrays));
    if constexpr (has_diffusion<Model>)
        std::memcpy(&arguments.noise, from.arrays + from.offsets().noise, sizeof(arguments.noise));
    part::stage_tolerances(arguments, 0, 1);
    run_team(threads, [] {
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
INTEGRATE_IN_TEAMS(teams::places, teams::with_memory, 4)
INTEGRATE_IN_TEAMS(teams::places, teams::with_memory, 16)
INTEGRATE_IN_TEAMS(teams::places, myriad::dormand_prince_8, 64)
INTEGRATE_IN_TEAMS(teams::places, myriad::runge_kutta_4, 8)
INTEGRATE_IN_TEAMS(teams::phases, myriad::cash_karp, 2)
INTEGRATE_IN_TEAMS(teams::phases, myriad::cash_karp, 16)
INTEGRATE_IN_TEAMS(teams::ring, teams::careful_start, 8)
INTEGRATE_IN_TEAMS(teams::places, teams::sampled, 4)
INTEGRATE_IN_TEAMS(teams::places, teams::averaged, 16)
INTEGRATE_IN_TEAMS(teams::hoppers, myriad::cash_karp, 4)
INTEGRATE_IN_TEAMS(teams::hoppers, myriad::cash_karp, 16)
INTEGRATE_IN_TEAMS(teams::hoppers, teams::sampled_8, 8)
INTEGRATE_IN_TEAMS(teams::drifters, myriad::dormand_prince_5, 8)
INTEGRATE_IN_TEAMS(teams::drifters, myriad::runge_kutta_4, 2)
INTEGRATE_IN_TEAMS(teams::watched_ring, myriad::cash_karp, 4)
INTEGRATE_IN_TEAMS(teams::watched_ring, myriad::dormand_prince_8, 8)
INTEGRATE_IN_TEAMS(teams::envious_ring, myriad::cash_karp, 8)
INTEGRATE_IN_TEAMS(teams::metered_line, myriad::runge_kutta_4, 8)
INTEGRATE_IN_TEAMS(teams::metered_line, teams::sampled, 16)
INTEGRATE_IN_TEAMS(teams::adapting_cells, myriad::cash_karp, 4)
INTEGRATE_IN_TEAMS(teams::adapting_cells, myriad::dormand_prince_5, 16)
INTEGRATE_IN_TEAMS(teams::noisy_places, myriad::milstein, 4)
INTEGRATE_IN_TEAMS(teams::noisy_places, teams::sriw1_by_halves, 8)
INTEGRATE_IN_TEAMS(teams::noisy_points, myriad::euler_maruyama, 4)
INTEGRATE_IN_TEAMS(teams::noisy_points, myriad::sra1, 16)
