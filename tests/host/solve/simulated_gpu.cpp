// SPDX-License-Identifier: MIT
// The simulated GPU: the functions that programs with the CUDA backend have, and its kernels.
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/host/solve/models.hpp"
#include "tests/host/solve/simulated_engine.hpp"

namespace simulated {
namespace {

[[maybe_unused]] const int test_on_it = setenv("MYRIAD_TEST_DEVICE", "cuda", 1);

struct pinned_memory {
    std::shared_mutex mutex;  // shared, so that threads that only query do not wait for each other
    std::map<const std::byte*, std::size_t> blocks;
};
pinned_memory& pinned() {
    static auto* const all = new pinned_memory;  // outlives every ensemble
    return *all;
}

}  // namespace

void gpu::meet(call kind) {
    if (fails_at != kind || (calls_before += -1) >= 0) return;
    fails_at = call::none;
    throw myriad::error("the simulated GPU failed");
}
void demand(bool condition, const char* misuse) {
    if (condition) return;
    std::fprintf(stderr, "misuse of the simulated GPU: %s\n", misuse);
    std::abort();
}
bool is_pinned(const void* place) {
    const std::shared_lock lock(pinned().mutex);
    const auto byte = static_cast<const std::byte*>(place);
    const auto after = pinned().blocks.upper_bound(byte);
    return after != pinned().blocks.begin() && byte < std::prev(after)->first + std::prev(after)->second;
}

}  // namespace simulated

namespace myriad::cuda {

std::vector<device_facts> list_devices(std::string&) {
    const device_facts each{"simulated GPU", simulated::the_gpu.memory, 1, 90};
    return {each, each, each};
}

void pin_memory(int, void* memory, std::size_t bytes) {
    simulated::the_gpu.meet(simulated::call::pin);
    const std::lock_guard lock(simulated::pinned().mutex);
    const bool is_new = simulated::pinned().blocks.emplace(static_cast<std::byte*>(memory), bytes).second;
    simulated::demand(is_new, "memory is pinned twice");
}
void unpin_memory(void* memory) {
    const std::lock_guard lock(simulated::pinned().mutex);
    simulated::demand(simulated::pinned().blocks.erase(static_cast<std::byte*>(memory)) == 1,
                      "no such memory is pinned");
}

template <class Model, class Method, class R, class Counts>
std::unique_ptr<engine<R>> make_engine(const engine_options&) {
    simulated::the_gpu.meet(simulated::call::make_engine);
    return std::make_unique<simulated::engine<Model, Method, R>>();
}

#define MYRIAD_SIMULATE(Model, Method) \
    template std::unique_ptr<engine<double>> make_engine<Model, Method, double>(const engine_options&);
MYRIAD_SIMULATE(solving::swing, runge_kutta_4)
MYRIAD_SIMULATE(solving::swing, cash_karp)
MYRIAD_SIMULATE(solving::swing, dense<tsitouras_5>)
MYRIAD_SIMULATE(solving::drift, runge_kutta_4)
MYRIAD_SIMULATE(solving::drift, cash_karp)

}  // namespace myriad::cuda
