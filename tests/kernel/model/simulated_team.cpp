// SPDX-License-Identifier: MIT
// The threads of a simulated team: each is a context of its own, which runs up to where it waits for the others.
#define MYRIAD_SIMULATED_TEAM 1
#include "tests/kernel/model/simulated_team.hpp"

#include <cstdio>
#include <cstdlib>

#include <ucontext.h>

#include "tests/kernel/model/order_of_threads.hpp"

namespace {

using simulated::most_numbers;
using simulated::most_threads;
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

}  // namespace

void simulated::run_team(int threads, void (*work)()) {
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
