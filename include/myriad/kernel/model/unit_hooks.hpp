// SPDX-License-Identifier: MIT
// The hooks, event functions and observed quantities of a system of units: those of the units, one after the other.
#pragma once

#include <array>
#include <concepts>
#include <type_traits>
#include <utility>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/model/unit_views.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Largest system whose units are written out, so that their numbers are constants.
inline constexpr int largest_unrolled_system = 16;

/// Calls `f(first)` for every `step`-th unit, from `begin` on, as long as `step` of them are left.
template <int begin, int end, int step, bool unrolled, class F>
MYRIAD_FUNCTION void each_unit(F&& f) {
    if constexpr (unrolled) {
        static_for<0, (end - begin) / step>([&](auto i) MYRIAD_LAMBDA { f(begin + step * decltype(i)::value); });
    } else {
        MYRIAD_ROLLED
        for (int unit = begin; unit + step <= end; unit += step) {
            f(unit);
            MYRIAD_WHOLE_LOOP;
        }
    }
}
template <class Unit, int units, class F>
MYRIAD_FUNCTION void each_unit(F&& f) {
    detail::each_unit<0, units, 1, units * n_unit_state<Unit> <= largest_unrolled_system>(f);
}

/// The inputs of one unit.
template <class Unit, int units, class Inputs>
MYRIAD_FUNCTION auto inputs_of_unit(const Inputs& p, int unit) {
    using S = std::remove_cvref_t<decltype(*first_of(p.parameter))>;
    return unit_inputs<Unit, units, S, typename Inputs::real, Inputs>(p, unit);
}
template <class Unit, int units, class Lane>
MYRIAD_FUNCTION auto lane_of_unit(Lane& lane, int unit) {
    using S = std::remove_cvref_t<decltype(lane.t)>;
    using P = std::remove_pointer_t<decltype(first_of(lane.parameter))>;
    return unit_lane<Unit, units, S, P, Lane>(lane, unit);
}

/// Stands for a lane where only the signature of a hook matters.
struct any_lane {};
template <class Unit>
inline constexpr bool units_have_generic_after_step = has_after_step<Unit>&& requires(any_lane lane) {
    Unit::template after_step<double>(0, lane);
};

/// Calls a hook for all units, in their order, and returns the strongest action.
template <class Unit, int units, class Hook>
MYRIAD_FUNCTION action strongest_action(auto& lane, Hook&& hook) {
    action strongest = action::proceed;
    detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
        auto own = detail::lane_of_unit<Unit, units>(lane, unit);
        const action wanted = detail::action_of([&]() MYRIAD_LAMBDA { return hook(unit, own); });
        if (wanted > strongest) strongest = wanted;
    });
    return strongest;
}

/// The summaries of all units.
template <class Unit, int units>
constexpr auto summaries_of_units() {
    constexpr int count = n_summary<Unit>;
    return []<int... i>(std::integer_sequence<int, i...>) {
        return std::array<summary, sizeof...(i)>{summary(
            i / count * n_unit_observed<Unit> + Unit::summaries[i % count].quantity, Unit::summaries[i % count].kind,
            n_accessory<Unit> + i / count * n_unit_accessory<Unit> + Unit::summaries[i % count].accessory)...};
    }
    (std::make_integer_sequence<int, units * count>{});
}

/// The summaries of a thread's units. Their receivers are numbered as in a system of `units` units; see `receiver`.
template <class Whole, int units>
struct part_summaries {};
template <class Whole, int units>
requires has_summaries<Whole>
struct part_summaries<Whole, units> {
    static constexpr auto summaries = detail::summaries_of_units<typename Whole::unit_type, units>();
    static_assert(check_summaries<Whole>());
};

/// Refuses a diffusion with a wrong signature, and shows the right one. The arguments' values are unused.
template <class Unit, class R, class T, class Inputs>
constexpr bool check_unit_diffusion(const T* t = nullptr, const state_of_unit<Unit, R>* y = nullptr,
                                    Inputs* p = nullptr) {
    static_cast<void>(t), static_cast<void>(y), static_cast<void>(p);
    static_assert(
        requires {
            { Unit::template diffusion<R>(int{}, *t, *y, *p) } -> std::same_as<vec<R, n_unit_state<Unit>>>;
        },
        "diffusion of coupled units has a wrong signature: it must be `template <class R> MYRIAD_FUNCTION static "
        "myriad::vec<R, n_unit_state> diffusion(int unit, auto t, const auto& y, const auto& p)`, with a factor for "
        "each state of a unit, of which it sees the unit's own alone, and public");
    return true;
}
template <class Unit, class R, class T, class Inputs>
inline constexpr bool unit_diffusion_fits = check_unit_diffusion<Unit, R, T, Inputs>();

/// The factors of the noise of one unit, whose states are `own`.
template <class Unit, class R>
MYRIAD_FUNCTION auto factors_of_unit(int unit, const auto& t, const R* own, const auto& p) {
    static_assert(unit_diffusion_fits<Unit, R, std::remove_cvref_t<decltype(t)>, std::remove_reference_t<decltype(p)>>);
    return Unit::template diffusion<R>(unit, t, state_of_unit<Unit, R>{own}, p);
}

/// Hooks are called for all units in their order, and the strongest action counts; `after_event` for the unit whose
/// event it is. See `forwarded_hooks`.
template <class Unit, int units>
struct unit_hooks {
    static constexpr bool after_step_is_generic = units_have_generic_after_step<Unit>, acts_at_all_events = false;

    template <class R>
    MYRIAD_FUNCTION static auto events(auto t, const auto& y, const auto& p) {
        constexpr int count = n_unit_event<Unit>;
        vec<R, units * count> values;
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            const unit_states<Unit, units, const R> states{detail::first_of(y), unit};
            const vec<R, count> of_unit =
                Unit::template events<R>(unit, t, states, detail::inputs_of_unit<Unit, units>(p, unit));
            for (int e = 0; e < count; ++e) values[unit * count + e] = of_unit[e];
        });
        return values;
    }
    template <class R>
    MYRIAD_FUNCTION static auto observe(auto t, const auto& y, const auto& p) {
        constexpr int count = n_unit_observed<Unit>;
        vec<R, units * count> values;
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            const unit_states<Unit, units, const R> states{detail::first_of(y), unit};
            const vec<R, count> of_unit =
                Unit::template observe<R>(unit, t, states, detail::inputs_of_unit<Unit, units>(p, unit));
            for (int c = 0; c < count; ++c) values[unit * count + c] = of_unit[c];
        });
        return values;
    }

    template <class R>
    MYRIAD_FUNCTION static auto diffusion(auto t, const auto& y, const auto& p) {
        constexpr int count = n_unit_state<Unit>;
        vec<R, units * count> factors;
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            const auto of_unit = detail::factors_of_unit<Unit, R>(unit, t, detail::first_of(y) + unit * count,
                                                                  detail::inputs_of_unit<Unit, units>(p, unit));
            for (int c = 0; c < count; ++c) factors[unit * count + c] = of_unit[c];
        });
        return factors;
    }

    MYRIAD_FUNCTION static void initialise(auto& lane) {
        of_each(lane, [](int unit, auto& own) MYRIAD_LAMBDA { Unit::initialise(unit, own); });
    }
    MYRIAD_FUNCTION static action after_step(auto& lane) {
        return detail::strongest_action<Unit, units>(
            lane, [](int unit, auto& own) MYRIAD_LAMBDA { return Unit::after_step(unit, own); });
    }
    template <class R>
    MYRIAD_FUNCTION static mask_of<R> after_step(auto& lane) {
        mask_of<R> stops = mask_of<R>(false);
        of_each(lane, [&](int unit, auto& own) MYRIAD_LAMBDA {
            if constexpr (std::is_void_v<decltype(Unit::template after_step<R>(unit, own))>) {
                Unit::template after_step<R>(unit, own);
            } else {
                const mask_of<R> stops_too = Unit::template after_step<R>(unit, own);
                stops = stops || stops_too;
            }
        });
        return stops;
    }
    MYRIAD_FUNCTION static action after_event(int event, auto& lane) {
        const int unit = event / n_unit_event<Unit>;
        auto own = detail::lane_of_unit<Unit, units>(lane, unit);
        return detail::action_of(
            [&]() MYRIAD_LAMBDA { return Unit::after_event(unit, event - unit * n_unit_event<Unit>, own); });
    }
    MYRIAD_FUNCTION static action after_stop(int stop, int number, auto& lane) {
        return detail::strongest_action<Unit, units>(
            lane, [&](int unit, auto& own) MYRIAD_LAMBDA { return Unit::after_stop(unit, stop, number, own); });
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        of_each(lane, [](int unit, auto& own) MYRIAD_LAMBDA { Unit::finalise(unit, own); });
    }

private:
    template <class Hook>
    static MYRIAD_FUNCTION void of_each(auto& lane, Hook&& hook) {
        detail::each_unit<Unit, units>([&](int unit) MYRIAD_LAMBDA {
            auto own = detail::lane_of_unit<Unit, units>(lane, unit);
            hook(unit, own);
        });
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
