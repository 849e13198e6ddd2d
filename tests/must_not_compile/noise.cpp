// case: diffusion_with_a_method_for_ordinary_equations
// expect: the model has a diffusion, which methods for ordinary equations would ignore: use
// case: diffusion_with_a_stiff_method
// expect: the model has a diffusion, which methods for ordinary equations would ignore: use
// case: stochastic_method_without_diffusion
// expect: this method integrates stochastic equations, but the model has no diffusion: give it
// case: milstein_with_shared_noise
// expect: this method takes diagonal or additive noise alone, but the model has an `enum noise
// case: milstein_with_factors_of_other_states
// expect: this method takes noise whose factor of a state depends on no other state: use
// case: sriw1_with_shared_noise
// expect: this method takes diagonal or additive noise alone, but the model has an `enum noise
// case: sriw1_with_factors_of_other_states
// expect: this method takes noise whose factor of a state depends on no other state: use
// case: sra1_with_noise_that_is_not_additive
// expect: this method takes additive noise alone, but the diffusion may depend on the state
// case: diffusion_of_another_size
// expect: diffusion has a wrong signature: it must be
// case: diffusion_of_processes_that_is_no_matrix
// expect: diffusion has a wrong signature: it must be .*a row for each state
// case: diffusion_with_the_inputs_before_the_states
// expect: the arguments of diffusion are exchanged: they are the time, the states and the inputs, in this order
// case: events_on_no_path
// expect: this method follows no path, so that between the ends of a step there is nothing for an event
// case: events_within_steps_of_a_stiff_drift
// expect: this method is for steps in which a stiff drift undoes the noise
// case: diffusion_with_triggers
// expect: a model with a diffusion has no triggers yet: .*in after_step
// case: diffusion_that_writes_its_time_domain
// expect: a model with a diffusion may not declare writes_time_domain
// case: diffusion_with_integrals
// expect: a model with a diffusion has no integrals over a phase yet
// case: extrema_beside_events
// expect: a model with a diffusion has no extrema over a phase beside events yet
// case: diffusion_with_tangents
// expect: with_tangents and with_sensitivities take no model with a diffusion
// case: diffusion_with_sensitivities
// expect: with_tangents and with_sensitivities take no model with a diffusion
// case: diffusion_with_a_mass_matrix
// expect: the model has a mass_matrix, which methods for stochastic equations do not take
// case: noise_that_coupled_units_share
// expect: the noise of coupled units is a factor for each state of a unit
// case: diffusion_that_looks_at_other_units
// expect: diffusion of coupled units has a wrong signature: .*of which it sees the unit's own alone
// case: adaptive_steps_without_an_estimate
// expect: this method has no error estimate for adaptive steps: use adaptive<sra1>
// case: events_within_adaptive_steps
// expect: events and extrema of a model with a diffusion are found only in fixed steps
// case: adaptive_steps_with_a_controller
// expect: steps of stochastic equations are halved and doubled, by no controller
// SPDX-License-Identifier: MIT
// Stochastic equations with methods and parts that do not fit them.
#include <myriad/instantiate.hpp>  // first, as it is precompiled

#include "myriad/coupled_units.hpp"
#include "myriad/model.hpp"
#include "myriad/sensitivity.hpp"
#include "myriad/tangent.hpp"

struct walk {
    enum state { x, y, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {-p[k] * s[x], s[x] - s[y]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {p[k] * s[x], s[y]};
    }
};
MYRIAD_INSTANTIATE(walk, myriad::euler_maruyama, myriad::milstein, myriad::stochastic_heun)

#if defined(CASE_diffusion_with_a_method_for_ordinary_equations)
MYRIAD_INSTANTIATE(walk, myriad::cash_karp)
#endif
#if defined(CASE_diffusion_with_a_stiff_method)
MYRIAD_INSTANTIATE(walk, myriad::rodas_5p)
#endif
#if defined(CASE_stochastic_method_without_diffusion)
struct decay {
    enum state { x, n_state };
    enum parameter { diffusion, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return myriad::vec<R, n_state>{-p[diffusion] * s[x]};
    }
};
MYRIAD_INSTANTIATE(decay, myriad::euler_maruyama)
#endif

struct shared_noise : walk {
    enum noise { W, n_noise };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<myriad::vec<R, n_noise>, n_state> diffusion(auto,
                                                                                   const myriad::vec<R, n_state>& s,
                                                                                   const auto&) {
        return {myriad::vec<R, n_noise>{s[x]}, myriad::vec<R, n_noise>{s[y]}};
    }
};
#if defined(CASE_milstein_with_shared_noise)
MYRIAD_INSTANTIATE(shared_noise, myriad::milstein)
#endif

#if defined(CASE_sriw1_with_shared_noise)
MYRIAD_INSTANTIATE(shared_noise, myriad::sriw1)
#endif

#if defined(CASE_milstein_with_factors_of_other_states) || defined(CASE_sriw1_with_factors_of_other_states)
struct crossed : walk {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[y], s[x]};
    }
};
#if defined(CASE_sriw1_with_factors_of_other_states)
MYRIAD_INSTANTIATE(crossed, myriad::sriw1)
#else
MYRIAD_INSTANTIATE(crossed, myriad::milstein)
#endif
#endif
#if defined(CASE_sra1_with_noise_that_is_not_additive)
MYRIAD_INSTANTIATE(walk, myriad::sra1)
#endif
#if defined(CASE_diffusion_of_another_size)
struct too_many : walk {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 3> diffusion(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[y], s[x], s[x]};
    }
};
MYRIAD_INSTANTIATE(too_many, myriad::euler_maruyama)
#endif
#if defined(CASE_diffusion_of_processes_that_is_no_matrix)
struct no_matrix : walk {
    enum noise { W, n_noise };
};
MYRIAD_INSTANTIATE(no_matrix, myriad::euler_maruyama)
#endif
#if defined(CASE_diffusion_with_the_inputs_before_the_states)
struct exchanged : walk {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const auto& p, const myriad::vec<R, n_state>& s) {
        return {s[y], p[k] * s[x]};
    }
};
MYRIAD_INSTANTIATE(exchanged, myriad::euler_maruyama)
#endif
#if defined(CASE_events_on_no_path) || defined(CASE_diffusion_with_triggers) || \
    defined(CASE_events_within_steps_of_a_stiff_drift)
struct watched : walk {
    enum event { crossing, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return myriad::vec<R, n_event>{s[x]};
    }
};
#endif
#if defined(CASE_events_on_no_path)
MYRIAD_INSTANTIATE(watched, myriad::dri1)
#endif
#if defined(CASE_events_within_steps_of_a_stiff_drift)
MYRIAD_INSTANTIATE(watched, myriad::linearly_implicit_euler_maruyama)
#endif
#if defined(CASE_diffusion_with_triggers)
struct triggered : watched {
    enum trigger { rise, n_trigger };

    MYRIAD_FUNCTION static bool condition(int, const auto& positive, const auto&) { return positive[crossing]; }
    MYRIAD_FUNCTION static void after_trigger(int, auto&) {}
};
MYRIAD_INSTANTIATE(triggered, myriad::euler_maruyama)
#endif
#if defined(CASE_diffusion_that_writes_its_time_domain)
struct moving : walk {
    static constexpr bool writes_time_domain = true;

    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.t_end = lane.t_begin + 1; }
};
MYRIAD_INSTANTIATE(moving, myriad::euler_maruyama)
#endif
#if defined(CASE_diffusion_with_integrals) || defined(CASE_extrema_beside_events)
#if defined(CASE_diffusion_with_integrals)
struct base : walk {
    static constexpr auto kind = myriad::over_phase::integral;
};
#else
struct base : walk {
    enum event { crossing, n_event };
    static constexpr auto kind = myriad::over_phase::maximum;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return myriad::vec<R, n_event>{s[x]};
    }
};
#endif
struct summarised : base {
    enum observed { square, n_observed };
    enum accessory { largest, n_accessory };
    static constexpr myriad::summary summaries[] = {{square, kind, largest}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return myriad::vec<R, n_observed>{s[x] * s[x]};
    }
};
MYRIAD_INSTANTIATE(summarised, myriad::euler_maruyama)
#endif
#if defined(CASE_diffusion_with_tangents)
using with_tangents = myriad::with_tangents<walk, 1>;
MYRIAD_INSTANTIATE(with_tangents, myriad::euler_maruyama)
#endif
#if defined(CASE_diffusion_with_sensitivities)
using with_sensitivities = myriad::with_sensitivities<walk, walk::k>;
MYRIAD_INSTANTIATE(with_sensitivities, myriad::euler_maruyama)
#endif
#if defined(CASE_diffusion_with_a_mass_matrix)
struct massive : walk {
    static constexpr myriad::mass_entry mass_matrix[] = {{x, x, 1}};
};
MYRIAD_INSTANTIATE(massive, myriad::euler_maruyama)
#endif
#if defined(CASE_noise_that_coupled_units_share) || defined(CASE_diffusion_that_looks_at_other_units)
struct unit {
    enum unit_state { x, n_unit_state };
#if defined(CASE_noise_that_coupled_units_share)
    enum noise { W, n_noise };
#endif

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto, const auto& s, const auto&) {
        return myriad::vec<R, n_unit_state>{-s[x]};
    }
    template <class R, class States>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> diffusion(int, auto, const States& s,
                                                                  const auto&) requires requires {
        s.of(1);
    }
    { return myriad::vec<R, n_unit_state>{s.of(1)[x]}; }
};
using units = myriad::coupled_units<unit, 4>;
MYRIAD_INSTANTIATE(units, myriad::euler_maruyama)
#endif
#if defined(CASE_adaptive_steps_without_an_estimate)
MYRIAD_INSTANTIATE(walk, myriad::adaptive<myriad::milstein>)
#endif
#if defined(CASE_events_within_adaptive_steps)
struct stopped : walk {
    enum event { zero, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return myriad::vec<R, n_event>{s[x]};
    }
};
MYRIAD_INSTANTIATE(stopped, myriad::adaptive<myriad::sriw1>)
#endif
#if defined(CASE_adaptive_steps_with_a_controller)
using controlled_steps = myriad::controlled<myriad::adaptive<myriad::sriw1>, myriad::pi_control>;
MYRIAD_INSTANTIATE(walk, controlled_steps)
#endif
