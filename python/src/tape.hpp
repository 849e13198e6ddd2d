// SPDX-License-Identifier: MIT
// Interpreted models: a tape of a traced model's operations, run for all lanes of a pack at each of them. Free of the
// standard library's containers, as it is compiled for an instruction set of its own.
#pragma once

#include <cstddef>
#include <cstdint>

// Operations with one, two and three arguments, by the names of the traced expressions, and what they call.
#define MYRIAD_TAPE_UNARY(X) \
    X(sqrt)                  \
    X(cbrt)                  \
    X(abs)                   \
    X(floor)                 \
    X(rint)                  \
    X(sin)                   \
    X(cos)                   \
    X(tan)                   \
    X(asin)                  \
    X(acos)                  \
    X(atan)                  \
    X(sinh)                  \
    X(cosh) X(tanh) X(exp) X(exp2) X(log) X(log2) X(log10) X(expm1) X(log1p) X(reciprocal) X(rsqrt) X(sinpi) X(cospi)
#define MYRIAD_TAPE_BINARY(X) X(min) X(max) X(pow) X(atan2) X(hypot) X(copysign) X(fmod) X(floor_mod) X(floor_divide)
// Of whole numbers, which go round at the ends of their 32 bits, or 64 where `c` is not zero.
#define MYRIAD_TAPE_WHOLE(X) X(wrapping_add) X(wrapping_subtract) X(wrapping_multiply) X(quotient) X(remainder)
// Draws of random numbers, of `generate` alone: uniform between two numbers, normal with mean and standard deviation.
#define MYRIAD_TAPE_DRAW(X) X(uniform) X(normal)
#define MYRIAD_TAPE_INFIX(X) X(add, +) X(subtract, -) X(multiply, *) X(divide, /)
#define MYRIAD_TAPE_COMPARISON(X) \
    X(less, <) X(less_equal, <=) X(greater, >) X(greater_equal, >=) X(equal, ==) X(not_equal, !=)
// What is loaded from and stored to a model's arguments; `a` is the number of the component.
#define MYRIAD_TAPE_LOAD(X) \
    X(state)                \
    X(parameter)            \
    X(shared)               \
    X(shared_integer)       \
    X(accessory)            \
    X(integer_accessory)    \
    X(delayed) X(event_count) X(time) X(step) X(next_step) X(phase) X(instance) X(t_begin) X(t_end) X(waiting)
#define MYRIAD_TAPE_STORE(X) \
    X(result)                \
    X(state)                 \
    X(parameter) X(accessory) X(integer_accessory) X(next_step) X(end_phase) X(end_instance) X(waiting) X(put) X(drop)
// The methods that the interpreter is compiled for.
#define MYRIAD_TAPE_METHODS(X, ...)                \
    X(tsitouras_5 __VA_OPT__(, ) __VA_ARGS__)      \
    X(cash_karp __VA_OPT__(, ) __VA_ARGS__)        \
    X(dormand_prince_5 __VA_OPT__(, ) __VA_ARGS__) \
    X(runge_kutta_4 __VA_OPT__(, ) __VA_ARGS__)    \
    X(rosenbrock_23 __VA_OPT__(, ) __VA_ARGS__) X(rodas_5p __VA_OPT__(, ) __VA_ARGS__)

namespace myriad::python {

enum class tape_code : std::uint8_t {
    constant,
    negate,
    fma,
    select,
    both,
    either,
    opposite,
    is_finite,
    lookup,
    find_interval,
    powr,
#define MYRIAD_TAPE_NAME(name, ...) name,
    MYRIAD_TAPE_UNARY(MYRIAD_TAPE_NAME) MYRIAD_TAPE_BINARY(MYRIAD_TAPE_NAME) MYRIAD_TAPE_INFIX(MYRIAD_TAPE_NAME)
        MYRIAD_TAPE_COMPARISON(MYRIAD_TAPE_NAME) MYRIAD_TAPE_WHOLE(MYRIAD_TAPE_NAME) MYRIAD_TAPE_DRAW(MYRIAD_TAPE_NAME)
#undef MYRIAD_TAPE_NAME
#define MYRIAD_TAPE_NAME(name) load_##name,
            MYRIAD_TAPE_LOAD(MYRIAD_TAPE_NAME)
#undef MYRIAD_TAPE_NAME
#define MYRIAD_TAPE_NAME(name) store_##name,
                MYRIAD_TAPE_STORE(MYRIAD_TAPE_NAME)
#undef MYRIAD_TAPE_NAME
};

/// The names of the codes, in their order.
inline constexpr const char* tape_names[] = {
    "constant",
    "negate",
    "fma",
    "select",
    "and",
    "or",
    "not",
    "is_finite",
    "lookup",
    "find_interval",
    "powr",
#define MYRIAD_TAPE_NAME(name, ...) #name,
    MYRIAD_TAPE_UNARY(MYRIAD_TAPE_NAME) MYRIAD_TAPE_BINARY(MYRIAD_TAPE_NAME) MYRIAD_TAPE_INFIX(MYRIAD_TAPE_NAME)
        MYRIAD_TAPE_COMPARISON(MYRIAD_TAPE_NAME) MYRIAD_TAPE_WHOLE(MYRIAD_TAPE_NAME) MYRIAD_TAPE_DRAW(MYRIAD_TAPE_NAME)
#undef MYRIAD_TAPE_NAME
#define MYRIAD_TAPE_NAME(name) "load_" #name,
            MYRIAD_TAPE_LOAD(MYRIAD_TAPE_NAME)
#undef MYRIAD_TAPE_NAME
#define MYRIAD_TAPE_NAME(name) "store_" #name,
                MYRIAD_TAPE_STORE(MYRIAD_TAPE_NAME)
#undef MYRIAD_TAPE_NAME
};

/// One operation on registers: `to` is its result's, or what a store stores; conditions are 1 and 0.
struct tape_step {
    double value;  ///< of a constant
    std::uint16_t to, a, b, c;
    tape_code code;
};

/// One function of a model.
struct tape_function {
    const tape_step* begin = nullptr;
    const tape_step* end = nullptr;
    std::int32_t registers = 0;  ///< that it uses
    bool empty() const { return begin == end; }
};

inline constexpr int most_registers = 0xffff;  ///< of a function, and components of a kind
inline constexpr int tape_batches = 2;         ///< SIMD registers per pack

inline constexpr int tape_events = 251, tape_triggers = 241, tape_stops = 37, tape_kept = 4093;  // most of them
// The kinds of components of which a tape has a number of its own, and the most that there may be.
#define MYRIAD_TAPE_LENGTHS(X)           \
    X(state, most_registers)             \
    X(parameter, most_registers)         \
    X(accessory, most_registers)         \
    X(integer_accessory, most_registers) \
    X(event, tape_events)                \
    X(stop, tape_stops) X(trigger, tape_triggers) X(delayed, most_registers) X(kept, tape_kept) X(lag, most_registers)

/// The interpreters: for packs of models without stops, triggers and delays, and for one instance at a time of all
/// others. Compiling them as one for packs would take three times as long.
#define MYRIAD_TAPE_KINDS(X) X(in_packs) X(with_triggers) X(with_delays)

inline constexpr int tape_values = 32;  ///< that an action which waits can have

/// Where a model's actions wait, as in `action_queue`.
struct tape_queue {
    int first = 0, first_integer = 0, capacity = 0, values = 0;
};

// The functions of which a model has several: for each event, stop or trigger; for each trigger also the action that
// has waited, and its priority; for each delayed value how long ago it is, and what it was before the beginning.
// Conditions read sides as states, and times of stops the number as the time.
#define MYRIAD_TAPE_SERIES(X) \
    X(after_event)            \
    X(stop_time) X(after_stop) X(condition) X(after_trigger) X(late_action) X(priority) X(lag) X(history)

// Between these limits the factors of a stiff method's matrix are sparse, as those of a model that is compiled.
inline constexpr int largest_dense_matrix = 6, most_matrix_updates = 4096;

/// The matrix of stiff methods: the entries of the Jacobian that may differ from zero, and the tables by which it is
/// factorised, as `lu_tables`; without entries it is dense, and its derivatives are found one column after the other.
struct tape_matrix {
    std::int32_t entries = 0, groups = 0;
    const std::int32_t *row = nullptr, *column = nullptr;                                  // of each entry
    const std::int32_t *group_of_column = nullptr, *begin = nullptr, *in_group = nullptr;  // entries of each group
    std::int32_t factor_entries = 0;                                                       // 0: dense
    const std::int32_t *pivot = nullptr, *diagonal = nullptr, *lower_begin = nullptr, *upper_begin = nullptr,
                       *lower_entry = nullptr, *lower_row = nullptr, *upper_entry = nullptr, *upper_column = nullptr,
                       *first_update = nullptr, *target = nullptr, *target_row = nullptr, *position = nullptr,
                       *pivot_row = nullptr;
};

/// Which delayed value sees what, as `tables_of_past`; and whether each is a slope.
struct tape_past {
    const std::int32_t *place = nullptr, *lag = nullptr, *state = nullptr, *first = nullptr, *delayed_state = nullptr;
    const bool* is_slope = nullptr;
    bool constant_lags = true;  ///< no lag reads the time or a state
};

/// How many components of each kind a model has.
struct tape_lengths {
#define MYRIAD_TAPE_LENGTH(kind, most) std::int32_t kind = 0;
    MYRIAD_TAPE_LENGTHS(MYRIAD_TAPE_LENGTH)
#undef MYRIAD_TAPE_LENGTH
};

/// A model.
struct tape {
    tape_lengths length;
    tape_function jacobian;  ///< the derivatives in the order of the matrix's entries, or none
    tape_matrix matrix;
    bool autonomous = false;  ///< the right-hand side does not read the time
    tape_function rhs, events, initialise, after_step, finalise, generate;
#define MYRIAD_TAPE_MEMBER(name) const tape_function* name = nullptr;  // for as many as any interpreter has
    MYRIAD_TAPE_SERIES(MYRIAD_TAPE_MEMBER)
#undef MYRIAD_TAPE_MEMBER
    const bool *false_at_first = nullptr,
               *lapsing = nullptr;  ///< triggers whose initial value is false; that do not persist
    tape_queue queue;
    tape_past past;
    int due = -1;            ///< the stop at which actions run that have waited
    std::int64_t seed = -1;  ///< of their order where priorities tie; -1: that in which they were put
};

/// Memory of a thread that runs a tape, from which vectors are taken many times a step: blocks by powers of two, which
/// are kept. A thread without one asks the system.
class tape_memory {
public:
    tape_memory();  ///< is the calling thread's until it is destroyed
    tape_memory(const tape_memory&) = delete;
    tape_memory& operator=(const tape_memory&) = delete;
    ~tape_memory();

    static int class_of(std::size_t bytes) {
        return bytes <= smallest ? 0 : 64 - __builtin_clzll((bytes - 1) / smallest);
    }
    static inline void* take(int size_class) noexcept;
    static inline void give(void* block, int size_class) noexcept;

private:
    static constexpr std::size_t smallest = 64;  // bytes; all blocks are aligned so
    struct block {
        block* next;
    };
    static void* from_system(std::size_t bytes) noexcept;
    static void to_system(void* memory) noexcept;
    void* grow(int size_class) noexcept;

    block* free_[48]{};
    block* chunks_ = nullptr;
    char *next_ = nullptr, *end_ = nullptr;  // what is left of the last chunk
    tape_memory* before_;
};

// In the part of a thread's memory that is found without a call.
#define MYRIAD_TAPE_THREAD __attribute__((tls_model("initial-exec")))
/// The tape that the calling thread runs, and its memory.
extern __thread const tape* current_tape MYRIAD_TAPE_THREAD;
extern __thread tape_memory* current_memory MYRIAD_TAPE_THREAD;

inline void* tape_memory::take(int size_class) noexcept {
    tape_memory* const from = current_memory;
    if (from == nullptr) return from_system(smallest << size_class);
    block* const found = from->free_[size_class];
    if (found == nullptr) return from->grow(size_class);
    from->free_[size_class] = found->next;
    return found;
}
inline void tape_memory::give(void* memory, int size_class) noexcept {
    tape_memory* const to = current_memory;
    if (to == nullptr) return to_system(memory);
    block* const given = static_cast<block*>(memory);
    given->next = to->free_[size_class];
    to->free_[size_class] = given;
}

}  // namespace myriad::python
