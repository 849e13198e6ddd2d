// SPDX-License-Identifier: MIT
// What watches the solution: the contract of an observer, and the observers that there are, which the loop calls
// together.
#pragma once

#include "myriad/kernel/output/bridge_summariser.hpp"
#include "myriad/kernel/output/history_writer.hpp"
#include "myriad/kernel/output/sampler.hpp"
#include "myriad/kernel/output/summariser.hpp"
#include "myriad/kernel/state/inside_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// An observer follows every phase of every instance and sees each step that is committed, with its interpolant. It is
/// made anew for each call, as `{args, s, own}` of the kernel's arguments, the state of the loop, and its own memory;
/// it reads the state and writes only accessories of it; `inside` counts the evaluations that it takes:
///
///     watches          whether kernels of this model and method have it; in others there is nothing of it
///     changes_inputs   whether it writes accessories that the right-hand side or event functions read
///     memory           what it keeps between steps, for each lane; it lies in registers
///     begin(i)         a phase of lane i begins at its time and state, after `initialise`
///     see(step)        steps are about to be committed: an `accepted_step`. If it changes inputs, it returns the lanes
///                      in which it has
template <class Observer, class Step>
concept observer = requires(Observer o, int i, const Step& step) {
    requires std::is_same_v<decltype(Observer::watches), const bool>;
    requires std::is_same_v<decltype(Observer::changes_inputs), const bool>;
    typename Observer::memory;
    o.begin(i);
    o.see(step);
};

/// The memory of an observer, and nothing for one that does not watch.
template <class Observer, bool watches = Observer::watches>
struct observer_memory {};
template <class Observer>
struct observer_memory<Observer, true> : Observer::memory {};

template <class Model, class Method, class S, class... Observer>
struct observer_list {
    using R = real_of<S>;
    using mask = mask_of<S>;
    using step_type = accepted_step<Model, Method, S>;
    static_assert((observer<Observer, step_type> && ...));

    struct memories : observer_memory<Observer>... {};

    static constexpr bool any_watches = (Observer::watches || ...);
    template <class One>
    static constexpr bool any_other_watches = ((Observer::watches && !std::is_same_v<Observer, One>) || ...);
    static constexpr bool change_inputs = ((Observer::watches && Observer::changes_inputs) || ...);
    static_assert(
        !change_inputs || slope_cache<Model, Method, S>::loses_start,
        "an observer changes inputs, for which slopes are evaluated again: slope_cache::loses_start must name it");

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    memories& own;

    /// A phase of lane i begins.
    MYRIAD_FUNCTION void begin(int i) { (begin_one<Observer>(i), ...); }
    /// Steps are about to be committed. Returns the lanes in which inputs have changed.
    MYRIAD_FUNCTION mask see(const step_type& step) {
        mask changed = mask(false);
        (see_one<Observer>(step, changed), ...);
        return changed;
    }

private:
    template <class One>
    MYRIAD_FUNCTION void begin_one(int i) {
        if constexpr (One::watches) One{args, s, static_cast<observer_memory<One>&>(own)}.begin(i);
    }
    template <class One>
    MYRIAD_FUNCTION void see_one(const step_type& step, mask& changed) {
        if constexpr (One::watches) {
            One one{args, s, static_cast<observer_memory<One>&>(own)};
            if constexpr (One::changes_inputs) {
                changed = changed | one.see(step);
            } else {
                one.see(step);
            }
        }
    }
};

/// The observers, in the order in which they are called. Another one is a header of its own, included above, and a name
/// here.
template <class Model, class Method, class S>
using observers = observer_list<Model, Method, S, sampler<Model, Method, S>, summariser<Model, Method, S>,
                                history_writer<Model, Method, S>>;

}  // namespace myriad::detail::inline MYRIAD_TARGET
