// SPDX-License-Identifier: MIT
// Interpreted models: a tape of a traced model's operations, run for all lanes of a pack at each of them. Free of the
// standard library's containers, as it is compiled for an instruction set of its own.
#pragma once

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
    X(integer_accessory) X(event_count) X(time) X(step) X(next_step) X(phase) X(instance) X(t_begin) X(t_end) X(waiting)
#define MYRIAD_TAPE_STORE(X) \
    X(result)                \
    X(state)                 \
    X(parameter) X(accessory) X(integer_accessory) X(next_step) X(end_phase) X(end_instance) X(waiting) X(put) X(drop)
// The methods that the interpreter is compiled for.
#define MYRIAD_TAPE_METHODS(X, ...)           \
    X(tsitouras_5 __VA_OPT__(, ) __VA_ARGS__) \
    X(cash_karp __VA_OPT__(, ) __VA_ARGS__)   \
    X(dormand_prince_5 __VA_OPT__(, ) __VA_ARGS__) X(runge_kutta_4 __VA_OPT__(, ) __VA_ARGS__)

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
    bool empty() const { return begin == end; }
};

inline constexpr int tape_registers = 512;
inline constexpr int tape_batches = 2;  ///< SIMD registers per pack

/// The most that an interpreter has of each kind of component, of stops and of triggers.
template <int states, int parameters, int accessories, int integers, int events, int stops, int triggers,
          bool lane_by_lane>
struct tape_size {
    static constexpr bool scalar_only = lane_by_lane;
    static constexpr int n_stop = stops, n_trigger = triggers;
    static constexpr int n_state = states, n_parameter = parameters, n_accessory = accessories,
                         n_integer_accessory = integers, n_event = events;
};
// The interpreters, from the smallest: a model has the first that it fits in, as what it does not use costs time and
// memory; models with more need a compiler. The large ones have no packs, which more than double the time to compile.
#define MYRIAD_TAPE_SIZES(X)                   \
    X(small, 8, 16, 6, 3, 3, 0, 0, false)      \
    X(large, 128, 128, 128, 8, 64, 0, 0, true) \
    X(with_triggers, 128, 128, 512, 256, 64, 3, 128, true)
namespace tape_sizes {
#define MYRIAD_TAPE_SIZE(name, ...) using name = tape_size<__VA_ARGS__>;
MYRIAD_TAPE_SIZES(MYRIAD_TAPE_SIZE)
#undef MYRIAD_TAPE_SIZE
}  // namespace tape_sizes

inline constexpr int tape_values = 32;  ///< that an action which waits can have

/// Where a model's actions wait, as in `action_queue`.
struct tape_queue {
    int first = 0, first_integer = 0, capacity = 0, values = 0;
};

// The functions of which a model has several: for each event, stop or trigger; for each trigger also the action that
// has waited, and its priority. Conditions read sides as states, and times of stops the number as the time.
#define MYRIAD_TAPE_SERIES(X) \
    X(after_event) X(stop_time) X(after_stop) X(condition) X(after_trigger) X(late_action) X(priority)

/// A model.
struct tape {
    tape_function rhs, events, initialise, after_step, finalise, generate;
#define MYRIAD_TAPE_MEMBER(name) const tape_function* name = nullptr;  // for as many as any interpreter has
    MYRIAD_TAPE_SERIES(MYRIAD_TAPE_MEMBER)
#undef MYRIAD_TAPE_MEMBER
    std::uint64_t false_at_first = 0, lapsing = 0;  ///< triggers whose initial value is false; that do not persist
    tape_queue queue;
    int due = -1;            ///< the stop at which actions run that have waited
    std::int64_t seed = -1;  ///< of their order where priorities tie; -1: that in which they were put
};

/// The tape that the calling thread runs.
extern __thread const tape* current_tape;

}  // namespace myriad::python
