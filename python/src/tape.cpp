// SPDX-License-Identifier: MIT
// The interpreter's kernels by name, and the tapes that they run.
#include "tape.hpp"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>

#include "interpreted.hpp"
#include "myriad/host/core/error.hpp"
#include "tape_instances.hpp"
#include "tape_kernel.hpp"
#include "threads.hpp"

namespace myriad::python {

__thread const tape* current_tape = nullptr;
__thread tape_memory* current_memory = nullptr;

tape_memory::tape_memory() : before_(current_memory) { current_memory = this; }
tape_memory::~tape_memory() {
    current_memory = before_;
    while (chunks_ != nullptr) to_system(std::exchange(chunks_, chunks_->next));
}
void* tape_memory::from_system(std::size_t bytes) noexcept {
    void* const found = std::aligned_alloc(smallest, bytes);
    if (found == nullptr) std::terminate();  // what a call needs is checked before it
    return found;
}
void tape_memory::to_system(void* memory) noexcept { std::free(memory); }
void* tape_memory::grow(int size_class) noexcept {
    constexpr std::size_t usual = std::size_t{1} << 16;
    const std::size_t bytes = smallest << size_class;
    const auto chunk_of = [this](std::size_t size) {
        auto* const made = static_cast<block*>(from_system(smallest + size));
        made->next = std::exchange(chunks_, made);
        return reinterpret_cast<char*>(made) + smallest;
    };
    if (bytes > usual / 4) return chunk_of(bytes);
    if (static_cast<std::size_t>(end_ - next_) < bytes) {
        next_ = chunk_of(usual);
        end_ = next_ + usual;
    }
    return std::exchange(next_, next_ + bytes);
}

#define MYRIAD_DECLARE_KERNEL(method, kind) tape_kernel tape_##method##_##kind();
#define MYRIAD_DECLARE_KERNELS(kind) MYRIAD_TAPE_METHODS(MYRIAD_DECLARE_KERNEL, kind)
MYRIAD_TAPE_KINDS(MYRIAD_DECLARE_KERNELS)
#undef MYRIAD_DECLARE_KERNEL

namespace {

struct named_kernel {
    const char* method;
    const char* kind;
    tape_kernel (*get)();
};
constexpr named_kernel kernels[] = {
#define MYRIAD_DECLARE_KERNEL(method, kind) {#method, #kind, &tape_##method##_##kind},
    MYRIAD_TAPE_KINDS(MYRIAD_DECLARE_KERNELS)
#undef MYRIAD_DECLARE_KERNEL
#undef MYRIAD_DECLARE_KERNELS
};

/// Registers that a function uses.
std::int32_t registers_of(const tape_function& f) {
    int most = 0;
    for (const tape_step* step = f.begin; step != f.end; ++step)
        most = std::max({most, step->to + 1, step->a + 1, step->b + 1, step->c + 1});
    return most;
}

}  // namespace

std::vector<std::string> interpreted_methods() {
#define MYRIAD_TAPE_NAME(name) #name,
    return {MYRIAD_TAPE_METHODS(MYRIAD_TAPE_NAME)};
#undef MYRIAD_TAPE_NAME
}
std::vector<std::string> tape_operations() { return {std::begin(tape_names), std::end(tape_names)}; }

openmp::instruction_set instructions_of_interpreter() {
    return static_cast<openmp::instruction_set>(kernels[0].get().instruction_set);
}

kernel_library interpreter(const std::string& method, const tape& model, int shared, int shared_integers) {
    const tape_lengths& n = model.length;
    const std::string kind = n.delayed > 0 ? "with_delays" : n.stop > 0 || n.trigger > 0 ? "with_triggers" : "in_packs";
    for (const named_kernel& k : kernels) {
        if (method != k.method || kind != k.kind) continue;
        const tape_kernel found = k.get();
        kernel_library made{};
        made.facts = {interface_version, sizeof(double), {}, found.call, {}};
        detail::model_numbers& numbers = made.facts.model;
        numbers.n_state = n.state, numbers.n_parameter = n.parameter, numbers.n_event = n.event;
        numbers.n_accessory = n.accessory, numbers.n_integer_accessory = n.integer_accessory;
        numbers.n_shared = shared, numbers.n_shared_integer = shared_integers;
        numbers.writes_parameters = true;
        numbers.n_kept = n.kept;
        if (found.solves_linear_systems) {
            const tape_matrix& of = model.matrix;
            const std::int32_t all = n.state * n.state;
            made.facts.matrix = {n.state, of.entries > 0 ? of.entries : all,
                                 of.factor_entries > 0 ? of.factor_entries : all,
                                 !model.jacobian.empty() ? 0
                                 : of.entries > 0        ? of.groups
                                                         : n.state,
                                 false};
        }
        made.instruction_set = found.instruction_set;
        made.run = found.run;
        const auto of_instances = instances_of_tape(model);
        made.functions = of_instances.functions;
        made.behaviour = of_instances.behaviour;
        return made;
    }
    throw error(message("there is no interpreter with the method ", method));
}

interpreted::interpreted(const tape_functions& functions, std::vector<tape_step> steps, const tape_facts& facts)
    : steps_(std::move(steps)), matrix_(facts.length.state, facts.entries) {
    const auto number_of_steps = static_cast<std::uint32_t>(steps_.size());
    for (const auto& several : functions) {
        std::vector<tape_function>& made = series_.emplace_back();
        for (const auto& [begin, end] : several) {
            require(begin <= end && end <= number_of_steps, "a tape's function is out of range");
            made.push_back({steps_.data() + begin, steps_.data() + end});
            made.back().registers = registers_of(made.back());
        }
    }
    std::size_t next = 1;
#define MYRIAD_TAPE_MEMBER(name) \
    require(next < series_.size(), "a tape has no " #name), tape_.name = series_[next++].data();
    MYRIAD_TAPE_SERIES(MYRIAD_TAPE_MEMBER)
#undef MYRIAD_TAPE_MEMBER
    const std::vector<tape_function>& first = series_.front();
    require(first.size() == 7, "a tape has ", first.size(), " functions instead of seven");
    tape_.rhs = first[0], tape_.events = first[1], tape_.initialise = first[2], tape_.after_step = first[3],
    tape_.finalise = first[4], tape_.generate = first[5], tape_.jacobian = first[6];
    const auto triggers = static_cast<std::size_t>(facts.length.trigger) + 1;
    false_at_first_.reset(new bool[triggers]()), lapsing_.reset(new bool[triggers]());
    for (const int trigger : facts.false_at_first) false_at_first_[static_cast<std::size_t>(trigger)] = true;
    for (const int trigger : facts.lapsing) lapsing_[static_cast<std::size_t>(trigger)] = true;
    tape_.false_at_first = false_at_first_.get(), tape_.lapsing = lapsing_.get();
    tape_.length = facts.length;
    keep_past(facts);
    tape_.matrix = matrix_.tables();
    tape_.autonomous = facts.autonomous;
    tape_.queue = facts.queue;
    tape_.due = facts.due;
    tape_.seed = facts.seed;
}

void interpreted::keep_past(const tape_facts& facts) {
    const std::size_t n = facts.past.size();
    std::vector<std::int32_t> place_of_state(static_cast<std::size_t>(facts.length.state) + 1, -1);
    is_slope_.reset(new bool[n + 1]());
    for (std::size_t j = 0; j < n; ++j) {
        const tape_delay& one = facts.past[j];
        require(one.state >= 0 && one.state < facts.length.state && one.same_lag >= 0 &&
                    static_cast<std::size_t>(one.same_lag) <= j,
                "a delayed value of a tape is out of range");
        std::int32_t& place = place_of_state[static_cast<std::size_t>(one.state)];
        if (place < 0) {
            place = static_cast<std::int32_t>(kept_state_.size());
            kept_state_.push_back(one.state);
        }
        place_.push_back(place);
        const auto number = static_cast<std::int32_t>(j);
        if (one.same_lag == number) first_.push_back(number);
        lag_.push_back(one.same_lag == number ? static_cast<std::int32_t>(first_.size()) - 1
                                              : lag_[static_cast<std::size_t>(one.same_lag)]);
        delayed_state_.push_back(one.state);
        is_slope_[j] = one.is_slope;
    }
    tape_.length.delayed = static_cast<std::int32_t>(n);
    tape_.length.kept = static_cast<std::int32_t>(kept_state_.size());
    tape_.length.lag = static_cast<std::int32_t>(first_.size());
    require(tape_.length.kept <= tape_kept, "the past of ", tape_.length.kept, " states is kept, and the interpreter ",
            "keeps that of ", tape_kept, " at the most", host::cure, "install a C++ compiler");
    tape_.past = {place_.data(),         lag_.data(),     kept_state_.data(), first_.data(),
                  delayed_state_.data(), is_slope_.get(), facts.constant_lags};
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
        const tape_memory memory;
        w.all->body(w.all->context, part);
    };
    start_team(&with_tape);
    all->threads = with_tape.threads;
    all->least_stack = with_tape.least_stack;
}

}  // namespace myriad::python
