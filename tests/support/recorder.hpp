// SPDX-License-Identifier: MIT
// A log of hook calls: what each call saw, in the order of an instance's calls. For runs on one thread or on a GPU. The
// hooks are in files compiled for an instruction set, the log is not: only plain numbers are exchanged.
#pragma once

#include <cstdint>
#include <vector>

#include <myriad/model.hpp>

#include "tests/support/kernel_memory.hpp"

namespace recorder {

enum class hook { initialise, after_step, after_event, finalise };

struct call {
    recorder::hook which;
    int event;  // index of the event, or -1
    std::int64_t index;
    int phase;
    double t, t_begin, t_end, h, h_next;
    double first, last;  // components of the state
    int event_count;     // of that event
};

/// The calls from the kernels of one file.
struct kernel_log {
    static constexpr unsigned int capacity = 131072;
    unsigned int size;
    call calls[capacity];
};
#if MYRIAD_FOR_GPU
MYRIAD_TEST_KERNEL_VARIABLE(kernel_log, kernel_calls)
#endif

/// Adds a call to the log.
void add(const call& c);
/// Returns and clears the log. Throws if it was too small.
std::vector<call> take();

/// Logs the view of a scalar hook. `n`: components of the state.
template <int n>
MYRIAD_FUNCTION void log(hook which, const auto& lane, int event = -1) {
    call c;
    c.which = which;
    c.event = event;
    c.index = lane.index;
    c.phase = lane.phase;
    c.t = lane.t;
    c.t_begin = lane.t_begin;
    c.t_end = lane.t_end;
    c.h = lane.h;
    c.h_next = lane.h_next;
    c.first = lane.y[0];
    c.last = lane.y[n - 1];
    c.event_count = event < 0 ? 0 : lane.event_count[event];
#if MYRIAD_ON_GPU
    const unsigned int number = atomicAdd(&kernel_calls.size, 1u);
    if (number < kernel_log::capacity) kernel_calls.calls[number] = c;
#else
    add(c);
#endif
}

/// Any model, with a log of its accepted steps.
template <class Model>
struct recorded : Model {
    MYRIAD_FUNCTION static void after_step(auto& lane) { recorder::log<Model::n_state>(hook::after_step, lane); }
};

}  // namespace recorder
