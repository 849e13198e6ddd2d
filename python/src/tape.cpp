// SPDX-License-Identifier: MIT
// The interpreter's kernels by name, and the tapes that they run.
#include "tape.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "interpreted.hpp"
#include "myriad/host/core/error.hpp"
#include "threads.hpp"

namespace myriad::python {

__thread const tape* current_tape = nullptr;

#define MYRIAD_TAPE_KERNEL(method) const kernel_library* tape_##method();
MYRIAD_TAPE_METHODS(MYRIAD_TAPE_KERNEL)
#undef MYRIAD_TAPE_KERNEL

namespace {

struct named_kernel {
    const char* method;
    const kernel_library* (*get)();
};
constexpr named_kernel kernels[] = {
#define MYRIAD_TAPE_KERNEL(method) {#method, &tape_##method},
    MYRIAD_TAPE_METHODS(MYRIAD_TAPE_KERNEL)
#undef MYRIAD_TAPE_KERNEL
};

}  // namespace

std::vector<std::string> interpreted_methods() {
    std::vector<std::string> names;
    for (const named_kernel& k : kernels) names.emplace_back(k.method);
    return names;
}
std::vector<std::string> tape_operations() { return {std::begin(tape_names), std::end(tape_names)}; }

const kernel_library& interpreter(const std::string& method) {
    for (const named_kernel& k : kernels)
        if (method == k.method) return *k.get();
    throw error(message("the interpreter has no method ", method));
}

interpreted::interpreted(const tape_functions& functions, std::vector<tape_step> steps) : steps_(std::move(steps)) {
    const auto number_of_steps = static_cast<std::uint32_t>(steps_.size());
    for (const tape_step& step : steps_)
        require(std::max({step.to, step.b, step.c}) < tape_registers, "a tape names a register beyond ",
                tape_registers);
    const auto part = [&](const std::pair<std::uint32_t, std::uint32_t>& range) {
        require(range.first <= range.second && range.second <= number_of_steps, "a tape's function is out of range");
        return tape_function{steps_.data() + range.first, steps_.data() + range.second};
    };
    require(functions.size() == 6 + tape_events, "a tape has ", 6 + tape_events, " functions");
    tape_ = {part(functions[0]),
             part(functions[1]),
             part(functions[2]),
             part(functions[3]),
             part(functions[4]),
             part(functions[5]),
             {}};
    for (std::size_t j = 0; j < tape_events; ++j) tape_.after_event[j] = part(functions[6 + j]);
}

void start_tape_team(openmp::team* all) {
    struct work {
        const tape* what;
        openmp::team* all;
    } mine{current_tape, all};
    openmp::team with_tape = *all;
    with_tape.context = &mine;
    with_tape.body = [](void* context, int part) {
        const work& w = *static_cast<const work*>(context);
        current_tape = w.what;
        w.all->body(w.all->context, part);
    };
    start_team(&with_tape);
    all->threads = with_tape.threads;
    all->least_stack = with_tape.least_stack;
}

}  // namespace myriad::python
