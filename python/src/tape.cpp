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
constexpr int most_of_a_kind = std::max({
#define MYRIAD_TAPE_MOST(size, ...) tape_sizes::size::n_event, tape_sizes::size::n_trigger,
    MYRIAD_TAPE_SIZES(MYRIAD_TAPE_MOST)
#undef MYRIAD_TAPE_MOST
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

interpreted::interpreted(const tape_functions& functions, std::vector<tape_step> steps, const tape_triggers& triggers)
    : steps_(std::move(steps)) {
    const auto number_of_steps = static_cast<std::uint32_t>(steps_.size());
    for (const tape_step& step : steps_)
        require(std::max({step.to, step.b, step.c}) < tape_registers, "a tape names a register beyond ",
                tape_registers);
    for (const auto& several : functions) {
        std::vector<tape_function>& made = series_.emplace_back();
        for (const auto& [begin, end] : several) {
            require(begin <= end && end <= number_of_steps, "a tape's function is out of range");
            made.push_back({steps_.data() + begin, steps_.data() + end});
        }
        made.resize(std::max(made.size(), std::size_t{most_of_a_kind}));
    }
    std::size_t next = 1;
#define MYRIAD_TAPE_MEMBER(name) \
    require(next < series_.size(), "a tape has no " #name), tape_.name = series_[next++].data();
    MYRIAD_TAPE_SERIES(MYRIAD_TAPE_MEMBER)
#undef MYRIAD_TAPE_MEMBER
    const std::vector<tape_function>& first = series_.front();
    tape_.rhs = first[0], tape_.events = first[1], tape_.initialise = first[2], tape_.after_step = first[3],
    tape_.finalise = first[4], tape_.generate = first[5];
    for (const int trigger : triggers.false_at_first) tape_.false_at_first |= std::uint64_t{1} << trigger;
    for (const int trigger : triggers.lapsing) tape_.lapsing |= std::uint64_t{1} << trigger;
    tape_.queue = triggers.queue;
    tape_.due = triggers.due;
    tape_.seed = triggers.seed;
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
