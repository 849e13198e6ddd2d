// SPDX-License-Identifier: MIT
// What a user may choose about an integration, with its defaults.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "myriad/ensemble/view.hpp"

namespace myriad {

/// One value for all components, or one for each: `1e-9` or `{1e-9, 1e-6}`.
class per_component {
public:
    per_component(double value) : values_{value} {}
    per_component(std::initializer_list<double> values) : values_(values) {}
    per_component(std::vector<double> values) : values_(std::move(values)) {}

    std::size_t size() const { return values_.size(); }
    /// The value of component i.
    double operator[](std::size_t i) const { return values_.size() == 1 ? values_[0] : values_.at(i); }

private:
    std::vector<double> values_;
};

/// Which sign changes of an event function count, seen in the direction of integration.
enum class direction { falling = -1, either = 0, rising = 1 };

/// How one event function is watched.
struct event_options {
    myriad::direction direction = myriad::direction::either;
    double tolerance = 1e-6;      ///< an event is located where |g| is at most this; unit of the event function
    std::int64_t stop_after = 0;  ///< number of detections in a phase that ends it (`stopped_by_event`); 0: never
};

/// Where a phase starts: at the instance's t_begin, or where the last phase ended.
enum class phase_time { restart, carry_on };
/// The first step of a phase: `options::step` again, or what the last phase ended with.
enum class phase_step { restart, carry_on };
/// Whether work is counted per instance (16 bytes each, 8 more with an adaptive method, 8 more with events).
enum class counting { off, on };
/// Whether `solve` looks for stiffness afterwards, with some evaluations of rhs on the host.
enum class advice { off, on };
/// The order in which instances are integrated. Their results do not depend on it, bit for bit; the time does where they cost
/// differently. `in_order`: by index, one to a CUDA thread, one part to a thread of the CPU. `dynamic`: by index, each lane taking the
/// next one when it is done with its last. `by_cost`: dynamic in the first phase, whose steps are counted; the other phases after sorting by that
/// count, so that instances side by side in a warp cost the same (a solver sorts by the last call's counts as long as the
/// instances stay on the GPU). `automatic`: on the CPU dynamic; on a GPU by_cost for step-size control, events or after_step, four phases
/// or more and more instances than one for each thread of a warp on every warp scheduler, else in_order. Kernels of fixed
/// steps without events and after_step are always in order on a GPU. With by_cost on the CPU, progress is told of the phases
/// after the first.
enum class schedule : std::uint8_t { automatic, in_order, dynamic, by_cost };
constexpr const char* name_of(schedule s) {
    constexpr const char* names[] = {"automatic", "in_order", "dynamic", "by_cost"};
    return names[static_cast<int>(s)];
}
/// What to do with instances whose state, parameters or times are not finite: refuse the call, or mark them
/// `invalid_input` and run the others.
enum class invalid_instances { refuse, mark };

/// States, accessories and times to keep at the end of every phase from `from_phase` on (counted from 0 in each call).
/// Nothing is recorded, and no memory taken, unless something is chosen.
struct record_options {
    std::int64_t from_phase = 0;
    std::vector<int> states = {};
    std::vector<int> accessories = {};
    std::vector<int> integer_accessories = {};
    bool time = false;

    bool empty() const { return states.empty() && accessories.empty() && integer_accessories.empty() && !time; }
};

/// Dense output, for a method `dense<Method>`: states along every trajectory, by exactly one of `evenly`, `times`,
/// `times_of_instances` and `every`. Samples are appended phase by phase and call by call until the capacity is reached.
struct sample_options {
    std::vector<int> states = {};  ///< components to sample; empty: no samples
    std::int64_t capacity = 0;     ///< samples kept per instance, over all phases and calls
    std::int64_t evenly = 0;  ///< number of evenly spaced times over [t_begin, t_end] in every phase, ends included
    std::vector<double> times = {};  ///< or these times in every phase, in the order in which they are reached
    std::vector<double> times_of_instances = {};  ///< or own times, as many for each: those of instance 0 first
    std::int64_t every = 0;          ///< or the start of the phase and the end of every n-th accepted step
    double minimum_spacing = 0;      ///< least time between samples by steps
    std::int64_t from_phase = 0;     ///< first phase of the call that is sampled

    bool empty() const { return states.empty(); }
};

/// How an ensemble is integrated. Times and steps are in the model's unit of time.
struct options {
    std::int64_t phases = 1;  ///< integration phases in this call, each from t_begin to t_end or until stopped

    per_component relative_tolerance = 1e-8;  ///< error per step over max(|y|, |y1|), per component of the state; raised to
                                              ///< four times the precision's epsilon, with a note in the report
    per_component absolute_tolerance = 1e-8;  ///< error per step, per component of the state, in its unit

    double step =
        std::numeric_limits<double>::quiet_NaN();  ///< fixed step (must be given), or first step (default 1e-2)
    double minimum_step = 0;                       ///< 0: the resolution of t
    double maximum_step = std::numeric_limits<double>::infinity();
    double growth_limit = 5;              ///< largest factor from one step to the next; kept in single precision
    double shrink_limit = 0.1;            ///< smallest factor, likewise
    std::int64_t max_steps = 10'000'000;  ///< trial steps per phase; more end the instance as `max_steps`

    myriad::phase_time phase_time = myriad::phase_time::restart;
    myriad::phase_step phase_step = myriad::phase_step::restart;

    std::vector<event_options> events = {};  ///< one for each event, in the model's order; empty: defaults for all
    std::int64_t sub_samples = 1;  ///< points per step at which event functions are looked at (the last is the end)
    std::int64_t accumulation_limit = 50;  ///< actions of one event, without its function leaving its tolerance in
                                           ///< between, that end the instance as `event_accumulation`

    record_options record = {};
    sample_options samples = {};
    myriad::counting counting = myriad::counting::on;
    myriad::advice advice = myriad::advice::on;
    myriad::invalid_instances invalid_instances = myriad::invalid_instances::refuse;

    myriad::schedule schedule = myriad::schedule::automatic;
    std::int64_t block_size = 0;  ///< CUDA threads per block; 0: what fills the multiprocessors best
    std::int64_t chunk_size = 0;  ///< instances on a GPU at a time; 0: so many that transfers and work overlap
    myriad::shared_placement shared_placement = myriad::shared_placement::automatic;

    /// Called now and then from the thread that called solve, with the number of instances begun and their total.
    std::function<void(std::int64_t, std::int64_t)> progress = {};
};

/// The least relative tolerance that makes sense: the rounding of a state is up to half of epsilon, and that of its change
/// another.
template <class R>
inline constexpr R least_relative_tolerance = R(4) * std::numeric_limits<R>::epsilon();

}  // namespace myriad
