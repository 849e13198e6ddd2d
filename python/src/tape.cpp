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

#define MYRIAD_TAPE_KERNEL(method, size) const kernel_library* tape_##method##_##size();
#define MYRIAD_TAPE_KERNELS(size, ...) MYRIAD_TAPE_METHODS(MYRIAD_TAPE_KERNEL, size)
MYRIAD_TAPE_SIZES(MYRIAD_TAPE_KERNELS)
#undef MYRIAD_TAPE_KERNEL

namespace {

struct named_kernel {
    const char* method;
    const char* size;
    const kernel_library* (*get)();
};
constexpr named_kernel kernels[] = {
#define MYRIAD_TAPE_KERNEL(method, size) {#method, #size, &tape_##method##_##size},
    MYRIAD_TAPE_SIZES(MYRIAD_TAPE_KERNELS)
#undef MYRIAD_TAPE_KERNEL
#undef MYRIAD_TAPE_KERNELS
};
constexpr int most_events = std::max({
#define MYRIAD_TAPE_EVENTS(size, ...) tape_sizes::size::n_event,
    MYRIAD_TAPE_SIZES(MYRIAD_TAPE_EVENTS)
#undef MYRIAD_TAPE_EVENTS
});

}  // namespace

std::vector<std::string> interpreted_methods() {
#define MYRIAD_TAPE_NAME(name) #name,
    return {MYRIAD_TAPE_METHODS(MYRIAD_TAPE_NAME)};
#undef MYRIAD_TAPE_NAME
}
std::vector<std::string> interpreter_sizes() {
#define MYRIAD_TAPE_NAME(name, ...) #name,
    return {MYRIAD_TAPE_SIZES(MYRIAD_TAPE_NAME)};
#undef MYRIAD_TAPE_NAME
}
std::vector<std::string> tape_operations() { return {std::begin(tape_names), std::end(tape_names)}; }

const kernel_library& interpreter(const std::string& method, const std::string& size) {
    for (const named_kernel& k : kernels)
        if (method == k.method && size == k.size) return *k.get();
    throw error(message("there is no interpreter of size ", size, " with the method ", method));
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
    require(functions.size() >= 6, "a tape has 6 functions, and one for each event");
    after_event_.resize(std::max(functions.size() - 6, std::size_t{most_events}));
    for (std::size_t j = 6; j < functions.size(); ++j) after_event_[j - 6] = part(functions[j]);
    tape_ = {part(functions[0]), part(functions[1]), part(functions[2]), part(functions[3]),
             part(functions[4]), part(functions[5]), after_event_.data()};
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
