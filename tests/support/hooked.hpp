// SPDX-License-Identifier: MIT
// Models with hooks, each for one promise of the loop about hooks, phases and inputs of models.
#pragma once

#include <myriad/model.hpp>

#include "tests/support/problems.hpp"
#include "tests/support/recorder.hpp"

namespace hooked {

/// The oscillator with every hook logged. Its last two events are the same function: both fire at once.
struct hooks_logged : problems::oscillator {
    enum event { turning_point, zero, zero_too, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 3> events(auto, const myriad::vec<R, 2>& y, const auto&) {
        return {y[v], y[x], y[x]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { recorder::log<2>(recorder::hook::initialise, lane); }
    MYRIAD_FUNCTION static void after_step(auto& lane) { recorder::log<2>(recorder::hook::after_step, lane); }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        recorder::log<2>(recorder::hook::after_event, lane, event);
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { recorder::log<2>(recorder::hook::finalise, lane); }
};

/// A forced oscillator x'' = -x + B cos(w t) that stores records in every kind of storage.
struct phased {
    enum state { x, v, n_state };
    enum parameter { w, n_parameter };
    enum shared { B, n_shared };
    enum accessory { x_start, x_max, sum_of_max, last_h, n_accessory };
    enum integer_accessory { steps, phases_begun, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto t, const myriad::vec<R, 2>& y, const auto& p) {
        return {y[v], p.shared[B] * myriad::cos(p[w] * t) - y[x]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        if (lane.phase == 0) lane.accessory[sum_of_max] = 0;
        lane.accessory[x_start] = lane.y[x];
        lane.accessory[x_max] = lane.y[x];
        lane.integer_accessory[steps] = 0;
        lane.integer_accessory[phases_begun] += 1;
    }
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[x_max] = myriad::max(lane.accessory[x_max], lane.y[x]);
        lane.accessory[last_h] = lane.h;
        lane.integer_accessory[steps] += 1;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.accessory[sum_of_max] += lane.accessory[x_max]; }
};

/// The same with events: the second local maximum ends the phase, if the options request it.
struct phased_by_events : phased {
    enum event { maximum, zero, n_event };
    enum integer_accessory { steps, phases_begun, zeros, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> events(auto, const myriad::vec<R, 2>& y, const auto&) {
        return {y[v], y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        if (event == zero) lane.integer_accessory[zeros] += 1;
    }
};

/// A bouncing oscillator that records every step and impact in accessories that only its hooks read.
struct bookkeeper {
    enum state { x, v, n_state };
    enum parameter { w, n_parameter };
    enum accessory { x_max, path, v_last, n_accessory };
    enum integer_accessory { steps, impacts, n_integer_accessory };
    enum event { wall, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto t, const myriad::vec<R, 2>& y, const auto& p) {
        return {y[v], myriad::cos(p[w] * t) - y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, 2>& y, const auto&) {
        return myriad::vec<R, 1>{y[x] + R(0.5)};
    }
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        using count = myriad::integer_of<R>;
        lane.accessory[x_max] = myriad::max(lane.accessory[x_max], lane.y[x]);
        lane.accessory[path] += myriad::abs(lane.h * lane.y[v]);
        lane.accessory[v_last] = lane.y[v];
        lane.integer_accessory[steps] += count(1);
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.y[v] = -0.5 * lane.y[v];
        lane.integer_accessory[impacts] += 1;
    }
};
/// The same, with the declaration.
struct declared_bookkeeper : bookkeeper {
    static constexpr bool accessories_are_outputs = true;
};

/// Records `lane.h`, `lane.h_next` and `lane.t` at the start of a phase.
struct early_reader : problems::oscillator {
    enum accessory { t_seen, h_seen, h_next_seen, n_accessory };
    enum integer_accessory { phase_seen, index_seen, n_integer_accessory };

    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[t_seen] = lane.t;
        lane.accessory[h_seen] = lane.h;
        lane.accessory[h_next_seen] = lane.h_next;
        lane.integer_accessory[phase_seen] = static_cast<std::int32_t>(lane.phase);
        lane.integer_accessory[index_seen] = static_cast<std::int32_t>(lane.index);
    }
};

/// The oscillator with the integral of x, its maximum and a step count; ends the phase once x falls below a parameter.
/// The two forms of after_step, which must agree.
struct running_base : problems::oscillator {
    enum parameter { lowest, n_parameter };
    enum accessory { integral, maximum, n_accessory };
    enum integer_accessory { steps, n_integer_accessory };
};
struct running_scalar : running_base {
    MYRIAD_FUNCTION static myriad::action after_step(auto& lane) {
        lane.accessory[integral] = myriad::fma(lane.h, lane.y[x], lane.accessory[integral]);
        lane.accessory[maximum] = myriad::max(lane.accessory[maximum], lane.y[x]);
        lane.integer_accessory[steps] += 1;
        return lane.y[x] < lane.parameter[lowest] ? myriad::action::end_phase : myriad::action::proceed;
    }
};
struct running_generic : running_base {
    template <class R>
    MYRIAD_FUNCTION static myriad::mask_of<R> after_step(auto& lane) {
        lane.accessory[integral] = myriad::fma(lane.h, lane.y[x], lane.accessory[integral]);
        lane.accessory[maximum] = myriad::max(lane.accessory[maximum], lane.y[x]);
        lane.integer_accessory[steps] = lane.integer_accessory[steps] + 1;
        return lane.y[x] < lane.parameter[lowest];
    }
};

/// y' = rate, with hooks that write the parameter.
struct parameter_writer {
    enum state { y0, n_state };
    enum parameter { rate, untouched, n_parameter };
    enum integer_accessory { mode, n_integer_accessory };
    enum mode { none, in_initialise, in_after_step, in_finalise };
    static constexpr bool writes_parameters = true;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>&, const auto& p) {
        return myriad::vec<R, 1>{p[rate]};
    }
    MYRIAD_FUNCTION static void twice(auto& lane, int when) {
        if (lane.integer_accessory[0] == when) lane.parameter[rate] = lane.parameter[rate] + lane.parameter[rate];
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { twice(lane, in_initialise); }
    MYRIAD_FUNCTION static void after_step(auto& lane) { twice(lane, in_after_step); }
    MYRIAD_FUNCTION static void finalise(auto& lane) { twice(lane, in_finalise); }
};

/// y' = 1, with hooks that write the time domain.
struct domain_writer : problems::uniform {
    enum accessory { t_at_end, n_accessory };
    enum integer_accessory { mode, n_integer_accessory };
    enum mode { none, shift_in_finalise, set_in_initialise, extend, cut, stop_here, begin_later };
    static constexpr bool writes_time_domain = true;

    MYRIAD_FUNCTION static void initialise(auto& lane) {
        if (lane.integer_accessory[0] == set_in_initialise) {
            lane.t_begin = 2;
            lane.t_end = 5;
        }
    }
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (lane.phase != 0) return;
        if (lane.integer_accessory[0] == extend) lane.t_end = 3;
        if (lane.integer_accessory[0] == cut) lane.t_end = 0.25;
        if (lane.integer_accessory[0] == stop_here && lane.t >= 0.5) lane.t_end = lane.t;
        if (lane.integer_accessory[0] == begin_later) lane.t_begin = 0.5;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        lane.accessory[t_at_end] = lane.t;
        if (lane.integer_accessory[0] == shift_in_finalise) {
            const auto length = lane.t_end - lane.t_begin;
            lane.t_begin = lane.t_end;
            lane.t_end = lane.t_end + length + length;
        }
    }
};

/// x' = rate, a sum of all values that a right-hand side may read.
struct reader {
    enum state { x, n_state };
    enum parameter { a, n_parameter };
    enum shared { b0, b1, n_shared };
    enum shared_integer { m0, m1, n_shared_integer };
    enum accessory { c0, c1, n_accessory };
    enum integer_accessory { k0, k1, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>&, const auto& p) {
        using real = myriad::real_of<R>;
        const R integers = static_cast<real>(p.shared_integer[m0] * 10 + p.shared_integer[m1]);
        const R chosen =
            myriad::select(p.integer_accessory[k1] > p.integer_accessory[k0], p.accessory[c1], p.accessory[c0]);
        return myriad::vec<R, 1>{p[a] + p.shared[b0] + p.shared[b1] + integers + chosen};
    }
};

/// x'' = -x + push, kicked once: changes by after_step must reach the next slope. With `in_push` zero the speed changes
/// at once, otherwise the push does, which only the right-hand side sees.
struct kicked_base {
    enum state { x, v, n_state };
    enum parameter { time, size, in_push, n_parameter };
    enum accessory { push, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& y, const auto& p) {
        return {y[v], p.accessory[push] - y[x]};
    }
};
struct kicked_scalar : kicked_base {
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (!(lane.t == lane.parameter[time])) return;
        if (lane.parameter[in_push] == 0) {
            lane.y[v] = lane.y[v] + lane.parameter[size];
        } else {
            lane.accessory[push] = lane.accessory[push] + lane.parameter[size];
        }
    }
};
struct kicked_generic : kicked_base {
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        const auto now = lane.t == lane.parameter[time];
        const auto state = now & (lane.parameter[in_push] == R(0));
        lane.y[v] = myriad::select(state, lane.y[v] + lane.parameter[size], lane.y[v]);
        const auto inner = now & (lane.parameter[in_push] != R(0));
        lane.accessory[push] = myriad::select(inner, lane.accessory[push] + lane.parameter[size], lane.accessory[push]);
    }
};

/// y' = 1, ended by hooks at given times.
struct stopper : problems::uniform {
    enum parameter { phase_stop, instance_stop, n_parameter };
    enum integer_accessory { begun, finished, n_integer_accessory };

    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.integer_accessory[begun] += 1; }
    MYRIAD_FUNCTION static myriad::action after_step(auto& lane) {
        if (lane.y[y0] >= lane.parameter[instance_stop]) return myriad::action::end_instance;
        if (lane.t >= lane.parameter[phase_stop]) return myriad::action::end_phase;
        return myriad::action::proceed;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.integer_accessory[finished] += 1; }
};

/// y' = y, scaled back to one at the end of every phase, with the sum of the logarithms: the growth rate times the
/// time.
struct renormalised {
    enum state { y0, n_state };
    enum accessory { sum, started_at, n_accessory };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{y[y0]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        if (lane.phase == 0) lane.accessory[sum] = 0;
        lane.y[y0] = lane.y[y0] + 1;  // to two: the phase must start from it
        lane.accessory[started_at] = lane.y[y0];
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        lane.accessory[sum] += myriad::log(lane.y[y0] / 2);
        lane.y[y0] = 1;
    }
};

/// y' = t, so that the integral of a restarted phase is known.
struct ramp {
    enum state { y0, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto t, const myriad::vec<R, 1>&, const auto&) {
        return myriad::vec<R, 1>{t};
    }
};

/// y' = 1 with an event at y = 1, and an after_step that causes a failure in the step that arrives there.
struct breaker : problems::uniform {
    enum integer_accessory { mode, events_seen, n_integer_accessory };
    enum mode { none, state_not_finite, end_not_finite };
    enum event { one, n_event };
    static constexpr bool writes_time_domain = true;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{y[y0] - R(1)};
    }
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (lane.y[y0] < 1 - 1e-3) return;
        const auto zero = lane.y[y0] - lane.y[y0];
        if (lane.integer_accessory[0] == state_not_finite) lane.y[y0] = zero / zero;
        if (lane.integer_accessory[0] == end_not_finite) lane.t_end = zero / zero;
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.integer_accessory[events_seen] += 1; }
};

/// y' = 1 with an event at y = 1/2, and hooks that set the next step to the root of `wanted` (NaN if that is negative);
/// the integer accessory selects the hook, after_step once y is past 3/16.
struct step_spoiler_base {
    enum state { y0, n_state };
    enum parameter { wanted, n_parameter };
    enum integer_accessory { which, n_integer_accessory };
    enum hooks { none, in_initialise, in_after_step, in_after_event, in_finalise };
    enum event { half, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>&, const auto&) {
        return myriad::vec<R, 1>{R(1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{y[y0] - R(0.5)};
    }
    MYRIAD_FUNCTION static void set(auto& lane, int hook) {
        if (lane.integer_accessory[which] == hook) lane.h_next = myriad::sqrt(lane.parameter[wanted]);
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { set(lane, in_initialise); }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { set(lane, in_after_event); }
    MYRIAD_FUNCTION static void finalise(auto& lane) { set(lane, in_finalise); }
};
struct step_spoiler : step_spoiler_base {
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (lane.y[y0] > 0.1875) set(lane, in_after_step);
    }
};
/// The same with an after_step for packs.
struct step_spoiler_generic : step_spoiler_base {
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        const auto now = (lane.y[y0] > R(0.1875)) & (lane.integer_accessory[which] == static_cast<int>(in_after_step));
        lane.h_next = myriad::select(now, myriad::sqrt(lane.parameter[wanted]), lane.h_next);
    }
};

/// y' = 1, with an after_step that sets the next step.
struct step_setter : problems::uniform {
    enum parameter { wanted, n_parameter };
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        recorder::log<1>(recorder::hook::after_step, lane);
        lane.h_next = lane.parameter[wanted];
    }
};

}  // namespace hooked
