// SPDX-License-Identifier: MIT
// Compares two models bit by bit: their functions for plain numbers, packs and dual numbers, and their hooks, on data
// drawn at random. Used by test_cpp.py with a model of the examples and its traced counterpart.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>
#include <type_traits>

#include <myriad/model.hpp>

#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/pack.hpp"

namespace same_bits {

namespace detail = myriad::detail;

inline std::mt19937_64 generator(1);
inline double drawn() { return std::uniform_real_distribution<double>(0.1, 2.0)(generator); }

template <class S>
void draw(S& value) {
    if constexpr (std::is_integral_v<S>) {
        value = static_cast<S>(generator() % 3);
    } else if constexpr (std::is_class_v<S> && requires { value.derivative; }) {
        draw(value.value);
        draw(value.derivative);
    } else if constexpr (std::is_floating_point_v<S>) {
        value = static_cast<S>(drawn());
    } else {
        for (int i = 0; i < S::lanes; ++i) S::set_lane(value, i, static_cast<typename S::value_type>(drawn()));
    }
}
template <class S, int n>
void draw(myriad::vec<S, n>& values) {
    for (int i = 0; i < n; ++i) draw(values[i]);
}

template <class A, class B>
bool same(const A& a, const B& b) {
    if constexpr (std::is_empty_v<A>) return std::is_empty_v<B>;
    return sizeof(a) == sizeof(b) && std::memcmp(&a, &b, sizeof(a)) == 0;
}

/// Numbers of components, which must agree before bits are compared.
template <class A, class B>
constexpr bool same_shape() {
    return detail::n_state<A> == detail::n_state<B> && detail::n_parameter<A> == detail::n_parameter<B> &&
           detail::n_shared<A> == detail::n_shared<B> && detail::n_shared_integer<A> == detail::n_shared_integer<B> &&
           detail::n_accessory<A> == detail::n_accessory<B> &&
           detail::n_integer_accessory<A> == detail::n_integer_accessory<B> &&
           detail::n_event<A> == detail::n_event<B> && detail::n_observed<A> == detail::n_observed<B>;
}

/// rhs, events and observe of both models for states of kind S, parameters and time of kind P.
template <class A, class B, class S, class P = S>
bool same_functions() {
    myriad::vec<myriad::real_of<S>, detail::n_shared<A> + 1> shared;
    draw(shared);
    bool equal = true;
    for (int sample = 0; sample < 100; ++sample) {
        myriad::inputs<A, P> p;
        P t;
        myriad::vec<S, detail::n_state<A>> y;
        draw(t), draw(y), draw(p.parameter);
        if constexpr (!detail::accessories_are_outputs<A>) draw(p.accessory), draw(p.integer_accessory);
        p.shared = &shared[0];
        myriad::inputs<B, P> q;
        q.parameter = p.parameter;
        q.shared = p.shared.values;
        if constexpr (!detail::accessories_are_outputs<A> && !detail::accessories_are_outputs<B>) {
            q.accessory = p.accessory;
            q.integer_accessory = p.integer_accessory;
        }
        equal = equal && same(A::template rhs<S>(t, y, p), B::template rhs<S>(t, y, q));
        if constexpr (detail::n_event < A >> 0)
            equal = equal && same(A::template events<S>(t, y, p), B::template events<S>(t, y, q));
        if constexpr (detail::n_observed < A >> 0)
            equal = equal && same(A::template observe<S>(t, y, p), B::template observe<S>(t, y, q));
    }
    return equal;
}

inline constexpr std::int32_t whole_numbers[] = {1, 2, 3};

template <class Model>
detail::lane_data<Model, double> drawn_lane(const double* shared, int sample) {
    detail::lane_data<Model, double> d;
    std::memset(static_cast<void*>(&d), 0, sizeof d);
    draw(d.t), draw(d.h), draw(d.y), draw(d.parameter), draw(d.accessory);
    draw(d.integer_accessory), draw(d.event_count);
    d.shared = shared, d.shared_integer = whole_numbers, d.t_end = 3, d.phase = sample % 2, d.h_next = 0.5;
    for (int i = 0; i < detail::n_event<Model>; ++i) d.event_count[i] = sample % 7;
    if constexpr (detail::n_integer_accessory < Model >> 0) d.integer_accessory[0] = sample % 60;
    return d;
}

template <class T>
void assign(T& to, const T& from) {
    to = from;
}
template <class A, class B, class T>
void assign(myriad::shared_values<B, T>& to, const myriad::shared_values<A, T>& from) {
    to = from.values;
}

/// Calls a hook of both models on equal lanes, and compares what it left and returned.
template <class A, class B, class Call>
bool same_hook(Call&& call, const double* shared) {
    bool equal = true;
    for (int sample = 0; sample < 200; ++sample) {
        auto a = drawn_lane<A>(shared, sample);
        detail::lane_data<B, double> b{};
        detail::for_each_member<A>([](auto, auto& to, const auto& from) { assign(to, from); }, b, a);
        myriad::lane<A, double> lane_a(a);
        myriad::lane<B, double> lane_b(b);
        using result = decltype(call.template operator()<A>(lane_a));
        static_assert(std::is_same_v<result, decltype(call.template operator()<B>(lane_b))>);
        if constexpr (std::is_void_v<result>) {
            call.template operator()<A>(lane_a);
            call.template operator()<B>(lane_b);
        } else {
            equal = equal && call.template operator()<A>(lane_a) == call.template operator()<B>(lane_b);
        }
        detail::for_each_member<A>([&](auto, const auto& x, const auto& y) { equal = equal && same(x, y); }, a, b);
    }
    return equal;
}

/// Prints the name and what differs; 1 if something does.
template <class A, class B>
int compare(const char* name) {
    static_assert(same_shape<A, B>());
    static_assert(detail::has_initialise<A> == detail::has_initialise<B> &&
                  detail::has_after_step<A> == detail::has_after_step<B> &&
                  detail::has_after_event<A> == detail::has_after_event<B> &&
                  detail::has_finalise<A> == detail::has_finalise<B>);
    static_assert(detail::hooks_fit<A, double> && detail::hooks_fit<B, double>);
    int different = 0;
    const auto check = [&](const char* what, bool equal) {
        if (!equal) std::printf("%s: %s differs\n", name, what), ++different;
    };
    using pack = myriad::pack<double, 1>;
    check("a function of plain numbers", same_functions<A, B, double>());
    check("a function of packs", same_functions<A, B, pack>());
    check("a function of dual numbers", same_functions<A, B, myriad::dual<double>, double>());
    myriad::vec<double, detail::n_shared<A> + 1> values;
    draw(values);
    const double* shared = &values[0];
    if constexpr (detail::has_initialise<A>)
        check("initialise", same_hook<A, B>([]<class M>(auto& lane) { return M::initialise(lane); }, shared));
    if constexpr (detail::has_after_step<A> && detail::has_generic_after_step<A>)
        check("after_step",
              same_hook<A, B>([]<class M>(auto& lane) { return M::template after_step<double>(lane); }, shared));
    if constexpr (detail::has_after_event<A>)
        for (int event = 0; event < detail::n_event<A>; ++event)
            check("after_event",
                  same_hook<A, B>([=]<class M>(auto& lane) { return M::after_event(event, lane); }, shared));
    if constexpr (detail::has_finalise<A>)
        check("finalise", same_hook<A, B>([]<class M>(auto& lane) { return M::finalise(lane); }, shared));
    std::printf("%s compared\n", name);
    return different;
}

}  // namespace same_bits
