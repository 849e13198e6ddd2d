// SPDX-License-Identifier: MIT
// The options of an integration, with their defaults.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include "myriad/host/options/component_list.hpp"
#include "myriad/host/options/schedule.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad {

/// One value for all components, or one for each: `1e-9` or `{1e-9, 1e-6}`.
class per_component {
public:
    /// One value for all components, or one for each.
    per_component(double value) : values_{value} {}
    per_component(std::initializer_list<double> values) : values_(values) {}
    per_component(std::vector<double> values) : values_(std::move(values)) {}

    /// 1 for one value that holds for all components, otherwise the number of values.
    std::size_t size() const { return values_.size(); }
    /// The value of component i.
    double operator[](std::size_t i) const { return values_.size() == 1 ? values_[0] : values_.at(i); }

private:
    std::vector<double> values_;
};

/// Which sign changes of an event function count, in the direction of integration.
enum class direction {
    falling = -1,  ///< from positive to negative
    either = 0,    ///< both
    rising = 1,    ///< from negative to positive
    none = 2,      ///< neither: the event is switched off
};

/// How one event is detected.
struct event_options {
    myriad::direction direction = myriad::direction::either;  ///< which crossings count
    double tolerance = 0;         ///< an event is located to |g| of at most this, in units of the event function; 0: as
                                  ///< closely as t and the state resolve
    std::int64_t stop_after = 0;  ///< number of detections in a phase that ends it (`stopped_by_event`); 0: never
};

/// Where a phase starts: at the instance's t_begin, or where the last phase ended, for phases that events or hooks end.
/// Otherwise the first phase ends at t_end, and the others would have no length, which is refused: see
/// `options::phase_length`.
enum class phase_time {
    restart,   ///< at t_begin
    carry_on,  ///< where the last phase ended
};
/// The first step of a phase: `options::step` again, or what the last phase ended with.
enum class phase_step {
    restart,   ///< with `options::step`
    carry_on,  ///< with the step size that the last phase would have tried next
};
/// Whether work is counted per instance (16 bytes each, 8 more with an adaptive method, 8 more with events).
enum class counting {
    off,  ///< no counters, no memory for them
    on,   ///< counters per instance, and their sums in the report
};
/// Whether `solve` checks after the integration for stiffness, with some evaluations of rhs on the host, and for phases
/// too long for Lyapunov exponents.
enum class advice {
    off,  ///< no checks
    on,   ///< checks, and notes in the report if they find something
};
/// What to do with two sorts of instances: some have a state, parameter or time that is not finite; others ended in an
/// earlier call, and their state or parameters were set again without `ensemble::restart`. Refuse the call; or mark the
/// former `invalid_input`, leave the latter as they are, and run the others.
enum class invalid_instances {
    refuse,  ///< throw `error` before any work
    mark,    ///< give them the status `invalid_input`, and run the others
};

/// States, accessories and times to keep at the end of every phase from `from_phase` on (counted from 0 in each call).
/// Nothing is recorded, and no memory allocated, unless something is chosen.
struct record_options {
    std::int64_t from_phase = 0;              ///< first phase of the call that is recorded, counted from 0
    component_list states = {};               ///< states to record
    component_list accessories = {};          ///< accessories to record
    component_list integer_accessories = {};  ///< integer accessories to record
    bool time = false;                        ///< whether to record the time at the end of the phase

    /// Whether nothing is recorded.
    bool empty() const { return states.empty() && accessories.empty() && integer_accessories.empty() && !time; }
};

/// Dense output, for a method `dense<Method>`: states along every trajectory, by exactly one of `evenly`, `times`,
/// `times_of_instances` and `every`. Samples are appended phase by phase and call by call until the capacity is
/// reached.
struct sample_options {
    component_list states = {};  ///< components to sample; empty: no samples
    std::int64_t capacity = 0;   ///< samples kept per instance, over all phases and calls
    std::int64_t evenly = 0;     ///< number of evenly spaced times over [t_begin, t_end] in every phase, ends included;
                                 ///< with phase_length over each phase, those between two phases once
    std::vector<double> times = {};  ///< or these times in every phase, in the order in which they are reached
    std::vector<double> times_of_instances = {};  ///< or times per instance, equally many: instance 0 first
    std::int64_t every = 0;                       ///< or the start of the phase and the end of every n-th accepted step
    double minimum_spacing = 0;                   ///< least time between samples by steps
    std::int64_t from_phase = 0;                  ///< first phase of the call that is sampled

    /// Whether there are no samples.
    bool empty() const { return states.empty(); }
};

/// How an ensemble is integrated. Times and steps are in the model's unit of time.
struct options {
    std::int64_t phases = 1;  ///< integration phases in this call, each from t_begin to t_end or until stopped

    per_component relative_tolerance =
        1e-8;  ///< error per step over max(|y|, |y1|), per component of the state; raised to
               ///< four times the precision's epsilon, with a note in the report
    per_component absolute_tolerance = 1e-8;  ///< error per step, per component of the state, in its unit

    /// Fixed step (must be given), or first step. Not given, the first step follows from the slope, the tolerances and
    /// the domain, as in MATLAB's ode45. One below the resolution of t is lengthened to it.
    double step = std::numeric_limits<double>::quiet_NaN();
    double minimum_step = 0;                                        ///< smallest step size; 0: the resolution of t
    double maximum_step = std::numeric_limits<double>::infinity();  ///< largest step size; infinity: no limit
    double growth_limit = 5;    ///< largest factor from one step to the next; rounded to single precision
    double shrink_limit = 0.1;  ///< smallest factor from one step to the next, rounded in the same way
    /// Trial steps per phase; an instance that needs more ends as `max_steps`. 0: 200 000 adaptive steps, or as many
    /// fixed ones as are counted, 2e9 (in single precision 1.6e7).
    std::int64_t max_steps = 0;
    /// Seconds from the beginning of the call after which what is left ends as `interrupted`: instances under way where
    /// they are, the others as they were. 0, or infinity: no limit. Solvers, which are asynchronous, and studies, which
    /// go on where they were stopped, refuse it.
    double time_limit = 0;

    /// Where a phase starts.
    myriad::phase_time phase_time = myriad::phase_time::restart;
    /// Length of a phase; 0: up to t_end. With a length, time continues from phase to phase, whatever `phase_time`
    /// says, and each phase ends at the next of its instance's times t_begin + k phase_length (backwards: minus), or at
    /// t_end, which may be infinite. A phase that an event or a hook ends early leaves the rest to the next.
    double phase_length = 0;
    /// The first step of a phase.
    myriad::phase_step phase_step = myriad::phase_step::restart;

    /// The seed of the paths of a stochastic equation (`diffusion`), from 0 to 2^32 - 1.
    std::int64_t seed = 0;
    /// The cells of these paths, in time: steps that are a multiple of one, or a number of 65536ths of one, follow the
    /// same path. Adaptive steps are one at the most, or its half, a quarter and so on. 0: the step; for adaptive steps
    /// a 64th of the domain, or of `phase_length`.
    double noise_step = 0;

    /// Steps of the past that are kept of each instance of a model with delays, rounded up to a power of two: those
    /// over its longest delay, and a few. 0: 256 adaptive steps, 1024 fixed ones, or in Python those of the
    /// longest constant lag.
    std::int64_t history_steps = 0;

    std::vector<event_options> events = {};  ///< one for each event, in the model's order; empty: defaults for all
    std::int64_t sub_samples = 1;  ///< points per step at which event functions are evaluated (the last is the end);
                                   ///< with two or more also where they turn
    std::int64_t accumulation_limit = 50;  ///< actions of one event, without its function leaving the surface in
                                           ///< between, or of one kind of stop at one time, that end the instance
                                           ///< as `event_accumulation`

    record_options record = {};                        ///< what to keep at the end of every phase
    sample_options samples = {};                       ///< dense output
    myriad::counting counting = myriad::counting::on;  ///< whether work is counted per instance
    myriad::advice advice = myriad::advice::on;        ///< whether to look for stiffness and for phases too long
    /// What to do with instances whose inputs are not valid.
    myriad::invalid_instances invalid_instances = myriad::invalid_instances::refuse;

    myriad::schedule schedule = myriad::schedule::automatic;  ///< order of the instances; changes no result
    std::int64_t block_size = 0;  ///< CUDA threads per block; 0: the size with the best occupancy
    std::int64_t chunk_size = 0;  ///< instances on a GPU at a time; 0: chosen so that transfers and kernels overlap
    /// Where a GPU keeps shared parameters.
    myriad::shared_placement shared_placement = myriad::shared_placement::automatic;

    /// Called by `solve` from time to time, in the calling thread, with the number of instances done, which never
    /// falls, and the number of all instances; with all done exactly once, at the end. An exception it throws ends the
    /// work and reaches the caller of `solve`: no instance is begun any more, and those that take more than half a
    /// second longer end as `interrupted`. A solver, which is asynchronous, refuses it.
    std::function<void(std::int64_t done, std::int64_t total)> progress = {};
};

/// The smallest meaningful relative tolerance: a state's rounding error is up to half of epsilon, and that of its
/// change as much again.
template <class R>
inline constexpr R least_relative_tolerance = R(4) * std::numeric_limits<R>::epsilon();

}  // namespace myriad
