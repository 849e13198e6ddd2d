// SPDX-License-Identifier: MIT
// The arguments of a kernel: pointers into the ensemble's arrays, and the options as plain numbers. Trivially copyable,
// the same for every backend, and free of Eigen, so that no type whose alignment depends on flags is exchanged.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/model_facts.hpp"
#include "myriad/kernel/model/path_constants.hpp"
#include "myriad/kernel/state/instance_arrays.hpp"

namespace myriad {

/// Where a GPU keeps the parameters that all instances share: the constant bank is fastest if all threads read the same
/// value at once, shared memory if they are many, the cache if they fit nowhere else. `automatic` takes the constant
/// bank up to 1 KiB, then shared memory as long as they fit.
enum class shared_placement : std::uint8_t {
    automatic,      ///< by their size
    constant_bank,  ///< with the arguments of the kernel, up to 1 KiB
    shared_memory,  ///< copied there by each block
    cache,          ///< read from device memory
};
/// The name of a place, as in the code.
constexpr const char* name_of(shared_placement placement) {
    constexpr const char* names[] = {"automatic", "constant_bank", "shared_memory", "cache"};
    return names[static_cast<int>(placement)];
}

}  // namespace myriad

namespace myriad::detail {

/// Length of a member array that may be empty.
constexpr int at_least_one(int n) { return n > 0 ? n : 1; }

/// One event function's options (see `event_options`), as the kernel needs them.
template <class R>
struct event_arguments {
    R tolerance;              // unit of the event function
    R end_tolerance;          // the same at the end of the time domain, beyond which nothing can happen there
    std::int32_t stop_after;  // detections that end the phase; 0: none
};

/// Where the records of the phases go: component c of recorded phase r of instance i is at
/// `values[(column * phases + r) * size + i]`, where the column is that of the component among `argument_arrays`; a
/// column of -1 is not recorded.
template <class R>
struct record_arguments {
    R* values;
    std::int32_t* integers;
    std::int32_t from_phase;  // of this call
    std::int32_t phases;      // recorded phases
    std::int16_t time_column;
};

/// Where samples go: sample k of instance i is at `time[k * size + i]` and, for a state, at
/// `values[(column * capacity + k) * size + i]`; a column of -1 is not sampled. Sampling is off if `stored` is null.
template <class R>
struct sample_arguments {
    R* time;
    R* values;
    std::int32_t* stored;  // per instance: number of samples
    const R* times;        // given times, or null: own or evenly spaced times
    R* own_times;          // given times of each instance, `count` components, or null
    std::int32_t count;    // times per phase
    std::int32_t every;    // accepted steps per sample; 0: by time
    std::int32_t capacity;
    std::int32_t from_phase;  // of this call
    R minimum_spacing;        // of samples by steps
};

/// The past of instances whose model has delays (model/past.hpp).
template <class R>
struct history_arguments {
    R* ring;               // the steps, and what is behind them
    std::uint32_t* jumps;  // of each instance a ring of as many entries as there are slots
    std::int32_t* place;   // steps stored, and jumps listed
    std::int32_t slots;    // steps in a ring, a power of two
    std::int32_t terms;    // numbers of each state kept in a step
};

/// The parameters shared by all instances, wherever a backend keeps them.
template <class R>
struct shared_parameters {
    const R* real;
    const std::int32_t* integer;
};

/// Which instances a kernel integrates. First in its arguments, which nvcc needs fewer registers to address then.
struct instance_range {
    std::int64_t size;         // instances, and the distance between two components
    std::int64_t first_index;  // number of the first instance, for hooks that read it
};

/// The part of a kernel's arguments that is the same for all models. Its last member is aligned like itself, so that
/// nothing is put into padding at its end.
template <class R>
struct argument_head : instance_range, instance_arrays<array_pointer, R> {
    shared_parameters<R> shared;

    // data of a schedule by cost, or null
    std::uint32_t* cost;         // trial steps of each instance's last phase, 0 if the instance has ended; written
    const std::uint32_t* order;  // the order in which instances are taken

    // options
    std::int32_t phases;
    std::int32_t first_phase;  // phases of this call already done
    R common_t_begin, common_t_end;
    R phase_length, phases_per_time;  // and its reciprocal; 0: a phase goes to t_end
    bool carry_time;                  // a phase continues from the end of the last one, not from t_begin
    bool carry_step;                  // and with its step size
    std::int32_t max_steps;
    R step;          // fixed step, or first step of an adaptive method
    R first_change;  // if positive, the first step is chosen by the change of the state in it: initial_step.hpp
    R minimum_step, maximum_step;
    float growth_limit, shrink_limit;  // in the precision of step-size control in CUDA threads
    std::int32_t sub_samples;          // points of the interpolant that are checked per step
    std::int32_t accumulation_limit;   // actions of one event without its function leaving the tolerance
    record_arguments<R> record;
    sample_arguments<R> sample;
    history_arguments<R> history;
};

// The arrays behind the head, whose lengths depend on the model: type, name, and what they have one of. Wider types
// come first, so that there is no padding between them. All that is known of them follows from this list. Bit j % 32 of
// word j / 32 of `rising` and `falling` says whether crossings of event j fire.
// clang-format off
#define MYRIAD_ARGUMENT_ARRAYS(array)                                  \
    array(R, relative_tolerance, n_state)                              \
    array(R, absolute_tolerance, n_state)                              \
    array(event_arguments<R>, event, n_event)                          \
    array(std::uint32_t, rising, n_event / 32 + 1)                     \
    array(std::uint32_t, falling, n_event / 32 + 1)                    \
    array(std::int16_t, state_column, n_state)                         \
    array(std::int16_t, accessory_column, n_accessory)                 \
    array(std::int16_t, integer_accessory_column, n_integer_accessory) \
    array(std::int16_t, sample_column, n_state)
// clang-format on

/// Where the arrays of such a model are, in bytes from the first.
template <class R>
struct argument_offsets {
    explicit constexpr argument_offsets(const model_numbers& of) {
#define MYRIAD_COUNT(kind, ...) [[maybe_unused]] const int n_##kind = of.n_##kind;
        MYRIAD_COMPONENT_KINDS(MYRIAD_COUNT)
#undef MYRIAD_COUNT
#define MYRIAD_PLACE_ARRAY(type, name, count) \
    name = end;                               \
    end += static_cast<int>(sizeof(type)) * at_least_one(count);
        MYRIAD_ARGUMENT_ARRAYS(MYRIAD_PLACE_ARRAY)
#undef MYRIAD_PLACE_ARRAY
        constexpr int unit = static_cast<int>(sizeof(R));
        noise = (end + unit - 1) / unit * unit;
        end = noise + (of.has_diffusion ? static_cast<int>(sizeof(path_constants<R>)) : 0);
    }
#define MYRIAD_DECLARE_OFFSET(type, name, count) int name = 0;
    MYRIAD_ARGUMENT_ARRAYS(MYRIAD_DECLARE_OFFSET)
#undef MYRIAD_DECLARE_OFFSET
    int noise = 0;  // of a model with a diffusion
    int end = 0;
};

/// The arrays of a model's kernel; the same for a part of it.
template <class Model, class R>
struct argument_arrays {
private:
#define MYRIAD_COUNT(kind, ...) static constexpr int n_##kind = detail::n_##kind<whole_of<Model>>;
    MYRIAD_COMPONENT_KINDS(MYRIAD_COUNT)
#undef MYRIAD_COUNT

public:
#define MYRIAD_DECLARE_ARRAY(type, name, count) type name[at_least_one(count)];
    MYRIAD_ARGUMENT_ARRAYS(MYRIAD_DECLARE_ARRAY)
#undef MYRIAD_DECLARE_ARRAY
};

/// What kernels of models with a diffusion have behind the arrays.
template <class Model, class R>
struct noise_arguments {};
template <class Model, class R>
requires has_diffusion<Model>
struct noise_arguments<Model, R> {
    path_constants<R> noise;
};

/// The arguments of a kernel.
template <class Model, class R>
struct kernel_arguments : argument_head<R>, argument_arrays<Model, R>, noise_arguments<Model, R> {};

/// How many actions of stops or of triggers at one instant are too many: triggers may put theirs into one queue, and so
/// each of them counts.
template <class Model, class R>
MYRIAD_FUNCTION auto most_actions(const kernel_arguments<Model, R>& args) {
    if constexpr (has_triggers<Model>) {
        const int triggers = MYRIAD_LENGTH(n_trigger<Model>);  // none only of a model that has its numbers at run time
        return std::int64_t(args.accumulation_limit) * (triggers > 0 ? triggers : 1);
    } else {
        return args.accumulation_limit;
    }
}

/// The tolerances of a thread's state. A team has them in shared memory, as each of its threads wants another one.
template <class Model, class R>
MYRIAD_FUNCTION R relative_tolerance_of(const kernel_arguments<Model, R>& args, int c) {
    if constexpr (team_size<Model> == 1) {
        return args.relative_tolerance[c];
    } else {
        return as_part<Model>::template tolerances<R>()[as_part<Model>::whole_state(c)];
    }
}
template <class Model, class R>
MYRIAD_FUNCTION R absolute_tolerance_of(const kernel_arguments<Model, R>& args, int c) {
    if constexpr (team_size<Model> == 1) {
        return args.absolute_tolerance[c];
    } else {
        return as_part<Model>::template tolerances<R>()[n_state<whole_of<Model>> + as_part<Model>::whole_state(c)];
    }
}

}  // namespace myriad::detail
