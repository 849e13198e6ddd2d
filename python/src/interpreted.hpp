// SPDX-License-Identifier: MIT
// Models that are interpreted, for machines without a compiler and as a second opinion.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "myriad/python/kernel_interface.hpp"
#include "tape.hpp"
#include "tape_matrix.hpp"

namespace myriad::python {

/// First and last step of each function: rhs, events, initialise, after_step, finalise, generate, jacobian; and then
/// those of which there are several.
using tape_functions = std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>>;

/// A delayed value: its state, the first delayed value that is as long ago, and whether it is the state's slope.
struct tape_delay {
    std::int32_t state = 0, same_lag = 0;
    bool is_slope = false;
};

/// What a tape has besides its functions: how many components of each kind, the entries of the Jacobian if a stiff
/// method is to know them; numbers of triggers whose initial value is false, and of those that do not persist; the
/// queue, the stop at which its actions run, and the seed of their order; delayed values, and whether their lags are
/// constant.
struct tape_facts {
    tape_lengths length;
    tape_entries entries;
    bool autonomous = false;
    std::vector<int> false_at_first, lapsing;
    tape_queue queue;
    int due = -1;
    std::int64_t seed = -1;
    std::vector<tape_delay> past;
    bool constant_lags = true;
};

/// A tape with its memory. Throws `error` if it is not a valid one.
class interpreted {
public:
    interpreted(const tape_functions& functions, std::vector<tape_step> steps, const tape_facts& facts);
    interpreted(const interpreted&) = delete;
    interpreted& operator=(const interpreted&) = delete;
    const tape& get() const { return tape_; }

private:
    void keep_past(const tape_facts& facts);

    std::vector<tape_step> steps_;
    std::vector<std::vector<tape_function>> series_;
    std::unique_ptr<bool[]> false_at_first_, lapsing_, is_slope_;
    std::vector<std::int32_t> place_, lag_, kept_state_, first_, delayed_state_;  // as in `tape_past`
    stored_matrix matrix_;
    tape tape_;
};

/// The kernel that interprets a tape by a method, with the model's numbers.
kernel_library interpreter(const std::string& method, const tape& model, int shared, int shared_integers);
/// The instruction set for which the interpreter is compiled.
openmp::instruction_set instructions_of_interpreter();
std::vector<std::string> interpreted_methods();
std::vector<std::string> tape_operations();

/// `start_team` for a kernel that interprets the calling thread's tape.
void start_tape_team(openmp::team* all);

}  // namespace myriad::python
