// SPDX-License-Identifier: MIT
// Tools of tangents and sensitivities beside the variational equations: what neighbouring solutions differ in, hooks of
// a model called with dual numbers, and the QR decomposition that keeps tangent vectors linearly independent.
#pragma once

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/scalar/dual.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Shared values of which one has a derivative; tables among them are constants.
template <class Model, class S>
struct moving_shared {
    shared_values<Model, real_of<S>> all;
    int moving;  ///< the one

    MYRIAD_FUNCTION operator const real_of<S>*() const { return all; }
    template <class I>
    MYRIAD_FUNCTION dual<S> operator[](I i) const {
        return dual<S>(S(all[i]), S(real_of<S>(static_cast<int>(i) == moving ? 1 : 0)));
    }
};
/// The arguments of a model's functions with such values.
template <class Model, class S>
struct moving_inputs : inputs<Model, dual<S>> {
    moving_shared<Model, S> shared;
};
template <class Model, class S>
struct moving_shared_lane : lane<Model, dual<S>> {
    moving_shared<Model, S> shared;
    MYRIAD_FUNCTION moving_shared_lane(detail::lane_data<Model, dual<S>>& d, int moving)
        : lane<Model, dual<S>>(d), shared{d.shared, moving} {}
};

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::detail {

/// What a neighbouring solution differs in: its state alone, a value of the model, or an end of its time domain.
enum class moving : char { state, parameter, shared, t_begin, t_end };
struct moving_component {
    moving kind;
    int number;
};

/// Directions of the state alone, for which everything that hooks write outside the state is constant.
template <int vectors>
struct state_directions {
    static constexpr int count = vectors;
    static constexpr bool carries_accessories = false;  ///< whether accessories have derivatives
    static constexpr bool keeps_times = false;          ///< whether what the times of events depend on is kept
    static constexpr bool move_time_domain = false;     ///< whether t_begin or t_end have derivatives
    template <int>
    static constexpr moving_component at = {moving::state, 0};
};

}  // namespace myriad::detail

namespace myriad::detail::inline MYRIAD_TARGET {

/// Where the derivatives of accessories in direction i begin among the accessories.
template <class Model>
MYRIAD_FUNCTION int first_moving_accessory(int i) {
    return (1 + i) * n_accessory<Model>;
}

/// The first `size` components of a vector, or those from `from` on.
template <int size, class S, int n>
MYRIAD_FUNCTION vec<S, size> part(const vec<S, n>& v, int from = 0) {
    vec<S, size> out;
    MYRIAD_UNROLL
    for (int c = 0; c < size; ++c) out[c] = v[from + c];
    return out;
}
template <int size, class S, int n>
MYRIAD_FUNCTION void set_part(vec<S, n>& v, int from, const vec<S, size>& to) {
    MYRIAD_UNROLL
    for (int c = 0; c < size; ++c) v[from + c] = to[c];
}

/// y + e direction: functions of it have their derivatives in that direction.
template <class S, int n>
MYRIAD_FUNCTION vec<dual<S>, n> along(const vec<S, n>& y, const vec<S, n>& direction) {
    vec<dual<S>, n> moving;
    MYRIAD_UNROLL
    for (int c = 0; c < n; ++c) moving[c] = dual<S>(y[c], direction[c]);
    return moving;
}
template <class S, int n>
MYRIAD_FUNCTION vec<S, n> derivatives(const vec<dual<S>, n>& v) {
    vec<S, n> out;
    MYRIAD_UNROLL
    for (int c = 0; c < n; ++c) out[c] = v[c].derivative;
    return out;
}

/// The derivatives of an input by itself: one in the direction of that component, known to be zero in all others.
template <class Directions, class S>
MYRIAD_FUNCTION partials<S, Directions::count> unit_derivatives(moving kind, int number) {
    return partials<S, Directions::count>::each([&](auto i) MYRIAD_LAMBDA {
        constexpr moving_component its = Directions::template at<i.value>;
        return its.kind == kind && its.number == number ? partial<S>(S(real_of<S>(1))) : partial<S>::none();
    });
}

/// The inputs of Model, taken from the inputs of a model W that has additional accessories.
template <class Model, class W, class S>
MYRIAD_FUNCTION inputs<Model, S> inputs_in(const lane<W, S>& l) {
    inputs<Model, S> p;
    p.parameter = part<n_parameter<Model>>(l.parameter);
    if constexpr (!accessories_are_outputs<Model>) {
        p.accessory = part<n_accessory<Model>>(l.accessory);
        p.integer_accessory = l.integer_accessory;
    }
    p.shared = l.shared.values;
    p.shared_integer = l.shared_integer.values;
    if constexpr (has_delays<Model>) p.delayed = part<n_delayed<Model>>(l.delayed);
    return p;
}

/// The parameters and accessories of `from`, inputs or a lane of a model W that has additional accessories, with their
/// derivatives in direction i.
template <class Model, class Directions, int i, class S, class From>
MYRIAD_FUNCTION vec<dual<S>, n_parameter<Model>> moving_parameters(const From& from) {
    constexpr moving_component its = Directions::template at<i>;
    vec<dual<S>, n_parameter<Model>> moved;
    MYRIAD_UNROLL
    for (int c = 0; c < n_parameter<Model>; ++c)
        moved[c] = dual<S>(from.parameter[c], S(real_of<S>(its.kind == moving::parameter && its.number == c ? 1 : 0)));
    return moved;
}
template <class Model, class Directions, int i, class S, class From>
MYRIAD_FUNCTION vec<dual<S>, n_accessory<Model>> moving_accessories(const From& from) {
    vec<dual<S>, n_accessory<Model>> moved;
    MYRIAD_UNROLL
    for (int c = 0; c < n_accessory<Model>; ++c) {
        moved[c] = dual<S>(from.accessory[c]);
        if constexpr (Directions::carries_accessories)
            moved[c].derivative = from.accessory[first_moving_accessory<Model>(i) + c];
    }
    return moved;
}

/// The inputs of Model in direction i, taken from inputs or a lane of W: as they are if nothing of them moves.
template <class Model, class Directions, int i, class S, class From>
MYRIAD_FUNCTION decltype(auto) inputs_along(const From& from) {
    constexpr moving_component its = Directions::template at<i>;
    constexpr bool accessories_move =
        Directions::carries_accessories && n_accessory < Model >> 0 && !accessories_are_outputs<Model>;
    if constexpr (its.kind != moving::parameter && its.kind != moving::shared && !accessories_move &&
                  !has_delays<Model>) {
        if constexpr (requires { from.h_next; }) {
            return detail::inputs_in<Model>(from);
        } else {
            return static_cast<const From&>(from);
        }
    } else {
        using given = std::conditional_t<its.kind == moving::shared, moving_inputs<Model, S>, inputs<Model, dual<S>>>;
        given p;
        p.parameter = detail::moving_parameters<Model, Directions, i, S>(from);
        if constexpr (!accessories_are_outputs<Model>) {
            p.accessory = detail::moving_accessories<Model, Directions, i, S>(from);
            p.integer_accessory = from.integer_accessory;
        }
        if constexpr (its.kind == moving::shared) p.shared.moving = its.number;
        static_cast<inputs<Model, dual<S>>&>(p).shared = from.shared.values;
        if constexpr (its.kind == moving::shared) p.shared.all = from.shared.values;
        p.shared_integer = from.shared_integer.values;
        return p;
    }
}

/// Numbers with derivatives in all directions.
template <class Directions, class S>
using moving_number = dual<S, partials<S, Directions::count>>;

/// Shared values with their derivatives in all directions; tables among them are constants.
template <class Model, class Directions, class S>
struct all_moving_shared {
    shared_values<Model, real_of<S>> all;

    MYRIAD_FUNCTION operator const real_of<S>*() const { return all; }
    template <class I>
    MYRIAD_FUNCTION moving_number<Directions, S> operator[](I i) const {
        return {S(all[i]), detail::unit_derivatives<Directions, S>(moving::shared, static_cast<int>(i))};
    }
};
template <class Model, class Directions, class S>
struct all_moving_inputs : inputs<Model, moving_number<Directions, S>> {
    all_moving_shared<Model, Directions, S> shared;
};

/// The inputs of Model with their derivatives in all directions.
template <class Model, class Directions, class S>
MYRIAD_FUNCTION auto inputs_along_all(const auto& from) {
    using number = moving_number<Directions, S>;
    all_moving_inputs<Model, Directions, S> p;
    static_for<0, n_parameter<Model>>([&](auto c) MYRIAD_LAMBDA {
        p.parameter[c] = number(from.parameter[c], detail::unit_derivatives<Directions, S>(moving::parameter, c));
    });
    if constexpr (!accessories_are_outputs<Model>) {
        static_for<0, n_accessory<Model>>([&](auto c) MYRIAD_LAMBDA {
            p.accessory[c] = number(from.accessory[c], partials<S, Directions::count>::each([&](auto i) MYRIAD_LAMBDA {
                                        return partial<S>(from.accessory[detail::first_moving_accessory<Model>(i) + c]);
                                    }));
        });
        p.integer_accessory = from.integer_accessory;
    }
    static_cast<inputs<Model, number>&>(p).shared = p.shared.all = from.shared.values;
    p.shared_integer = from.shared_integer.values;
    return p;
}

template <class Model, class Directions>
struct varied_past;  // varied_past.hpp

/// The lane of Model alone, in dual numbers: its state has the given direction as derivative, its time has dt, and
/// everything else moves as direction i says.
template <class Model, class Directions, int i, class W, class S>
MYRIAD_FUNCTION lane_data<Model, dual<S>> moving_lane(const lane<W, S>& l, const vec<S, n_state<Model>>& direction,
                                                      const S& dt) {
    lane_data<Model, dual<S>> d;
    d.parameter = detail::moving_parameters<Model, Directions, i, S>(l);
    d.accessory = detail::moving_accessories<Model, Directions, i, S>(l);
    d.integer_accessory = l.integer_accessory;
    d.shared = l.shared.values;
    d.shared_integer = l.shared_integer.values;
    d.t = dual<S>(l.t, dt);
    d.t_begin = l.t_begin;
    d.t_end = l.t_end;
    if constexpr (Directions::move_time_domain) {
        d.t_begin.derivative = Directions::template of_begin<S, i>();
        d.t_end.derivative = Directions::template of_end<S, i>(l);
    }
    d.h = l.h;
    d.h_next = l.h_next;
    d.y = along(part<n_state<Model>>(l.y), direction);
    d.index = static_cast<index_of<dual<S>>>(l.index);
    d.phase = l.phase;
    d.event_count = l.event_count;
    if constexpr (has_delays<Model>) {
        const auto p = detail::inputs_along<Model, Directions, i, S>(l);
        d.delayed = varied_past<Model, Directions>::template along<i>(p, l, d.t, d.y);
    }
    return d;
}

/// Copies back the values that a hook left in Model's own lane.
template <class Model, class W, class S>
MYRIAD_FUNCTION void take_values(lane<W, S>& l, const lane_data<Model, dual<S>>& d) {
    MYRIAD_UNROLL
    for (int c = 0; c < n_state<Model>; ++c) l.y[c] = d.y[c].value;
    MYRIAD_UNROLL
    for (int c = 0; c < n_accessory<Model>; ++c) l.accessory[c] = d.accessory[c].value;
    l.integer_accessory = d.integer_accessory;
    l.h_next = d.h_next.value;
    if constexpr (writes_parameters<Model>) {
        MYRIAD_UNROLL
        for (int c = 0; c < n_parameter<Model>; ++c) l.parameter[c] = d.parameter[c].value;
    }
    if constexpr (writes_time_domain<Model>) {
        l.t_begin = d.t_begin.value;
        l.t_end = d.t_end.value;
    }
}

/// Calls `hook` with Model's own lane once for each of the directions, with the direction and its dt as derivatives of
/// state and time, and returns the derivatives of the state after the hook. The values after the hook are the same
/// every time.
template <class Model, class Directions, class W, class S, class Hook>
MYRIAD_FUNCTION vec<S, Directions::count * n_state<Model>> move_through(
    lane<W, S>& l, const vec<S, Directions::count * n_state<Model>>& directions, const vec<S, Directions::count>& dt,
    Hook&& hook) {
    constexpr int n = n_state<Model>, count = Directions::count;
    vec<S, count * n> left;
    lane_data<Model, dual<S>> own;
    static_for<0, count>([&](auto i) MYRIAD_LAMBDA {
        constexpr moving_component its = Directions::template at<i.value>;
        own = detail::moving_lane<Model, Directions, i.value>(l, part<n>(directions, i * n), dt[i]);
        if constexpr (its.kind == moving::shared) {
            moving_shared_lane<Model, S> view(own, its.number);
            hook(view);
        } else {
            lane<Model, dual<S>> view(own);
            hook(view);
        }
        set_part(left, i * n, derivatives(own.y));
        if constexpr (Directions::carries_accessories)
            set_part(l.accessory, first_moving_accessory<Model>(i), derivatives(own.accessory));
    });
    detail::take_values<Model>(l, own);
    return left;
}

/// The same for a hook called at given times, in the directions after Model's state; updates them.
template <class Model, class Directions, class W, class S, class Hook>
MYRIAD_FUNCTION void move_directions(lane<W, S>& l, Hook&& hook) {
    constexpr int n = n_state<Model>, count = Directions::count;
    vec<S, count> at_once;
    MYRIAD_UNROLL
    for (int i = 0; i < count; ++i) at_once[i] = S(real_of<S>(0));
    set_part(l.y, n, detail::move_through<Model, Directions>(l, part<count * n>(l.y, n), at_once, hook));
}

/// Makes `count` vectors of n components, from v[from] on, orthonormal, and calls `stretch(i, length)` with the
/// diagonal of R in their QR decomposition. Modified Gram-Schmidt, each vector against the others twice, which leaves
/// them orthogonal to rounding however close they had come (Giraud, Langou, Rozloznik, Comput. Math. Appl. 50 (2005)
/// 1069).
template <int n, int count, class R, int size, class Stretch>
MYRIAD_FUNCTION void orthonormalise(vec<R, size>& v, int from, Stretch&& stretch) {
    for (int i = 0; i < count; ++i) {
        const int own = from + i * n;
        R scale = R(0);  // so that no square underflows
        for (int c = 0; c < n; ++c) scale = max(scale, abs(v[own + c]));
        for (int c = 0; c < n; ++c) v[own + c] = v[own + c] / scale;
        for (int sweep = 0; sweep < 2; ++sweep) {
            for (int j = 0; j < i; ++j) {
                const int other = from + j * n;
                R overlap = R(0);
                for (int c = 0; c < n; ++c) overlap = fma(v[other + c], v[own + c], overlap);
                for (int c = 0; c < n; ++c) v[own + c] = fma(-overlap, v[other + c], v[own + c]);
            }
        }
        R square = R(0);
        for (int c = 0; c < n; ++c) square = fma(v[own + c], v[own + c], square);
        const R length = sqrt(square);
        for (int c = 0; c < n; ++c) v[own + c] = v[own + c] / length;
        stretch(i, scale * length);
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
