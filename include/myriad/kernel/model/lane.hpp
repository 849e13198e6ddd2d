// SPDX-License-Identifier: MIT
// The arguments of a model's functions: `inputs` for rhs and events (the argument p), `lane` for the hooks, and the
// data behind both, with the copying of single lanes out of a pack and back.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/past.hpp"
#include "myriad/kernel/scalar/select.hpp"
#include "myriad/kernel/scalar/wide_integer.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The number of an instance, and of each of a pack: of 64 bits, also where integers of the lanes' width have 32.
template <class S>
struct index_type {
    using type = std::int64_t;
};
template <class S>
requires(lanes_of<S> > 1) struct index_type<S> {
    using pack = integer_of<S>;
    using type =
        std::conditional_t<sizeof(typename pack::value_type) == sizeof(std::int64_t), pack, wide_integer<pack>>;
};
template <class S>
using index_of = typename index_type<S>::type;

template <class Model, class S>
struct lane_data;

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

/// The accessories, if `there`.
template <class Model, class S, bool there>
struct accessories {
    /// `p.accessory[a]`: real accessories of the instance.
    vec<S, detail::n_accessory<Model>> accessory;
    /// `p.integer_accessory[a]`: its integer accessories.
    vec<integer_of<S>, detail::n_integer_accessory<Model>> integer_accessory;
};
/// None, where the model declares that accessories are outputs.
template <class Model, class S>
struct accessories<Model, S, false> {};

/// Shared values, reals or integers: a pointer that refuses indices of other kinds of components.
template <class Model, class T>
struct shared_values {
    static constexpr bool integers = std::is_integral_v<T>;
    static constexpr int size = integers ? detail::n_shared_integer<Model> : detail::n_shared<Model>;
    const T* values;

    shared_values() = default;
    MYRIAD_FUNCTION shared_values(const T* all) : values(all) {}
    MYRIAD_FUNCTION operator const T*() const { return values; }

    template <class I>
    MYRIAD_FUNCTION const T& operator[](I i) const MYRIAD_WARN_OF_INDEX(static_cast<int>(i), size) {
        if constexpr (integers) {
            static_assert(detail::shared_integer_index_fits<Model, I>);
        } else {
            static_assert(detail::shared_index_fits<Model, I>);
        }
        return values[detail::checked_index<size>(static_cast<int>(i))];
    }
};

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

/// For a team of threads, where its inputs lie in its memory: model/part_of_units.hpp. Empty for other models.
template <class Model>
struct place_of_inputs {};

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

/// The argument p of rhs and events: `p[i]` is parameter i of the instance, `p.shared[i]` a value common to all
/// instances. It has no accessories in a model that declares them outputs.
template <class Model, class S>
struct inputs : accessories<Model, S, !detail::accessories_are_outputs<Model>>,
                values_of_past<Model, S, detail::has_delays<Model>>,
                detail::place_of_inputs<Model> {
    using real = real_of<S>;  ///< double or float
    /// The parameters of the instance; `p[k]` is short for `p.parameter[k]`.
    vec<S, detail::n_parameter<Model>> parameter;
    shared_values<Model, real> shared;                  ///< `p.shared[B]`: real values that all instances share
    shared_values<Model, std::int32_t> shared_integer;  ///< `p.shared_integer[i]`: integers that all share

    /// Parameter i; an enumerator of another enumeration does not compile.
    template <class I>
    MYRIAD_FUNCTION const S& operator[](I i) const
        MYRIAD_WARN_OF_INDEX(static_cast<int>(i), detail::n_parameter<Model>) {
        static_assert(
            !detail::is_state_index<Model, I>,
            "a state is looked for among the inputs: the arguments of rhs, events and observe are the time, the states "
            "and the inputs, in this order, `auto t, const myriad::vec<R, n_state>& y, const auto& p`");
        static_assert(detail::parameter_index_fits<Model, I>);
        return parameter[static_cast<int>(i)];
    }
};

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

/// All data of one instance (or one pack of them) that hooks may see.
template <class Model, class S>
struct lane_data : inputs<Model, S>, accessories<Model, S, accessories_are_outputs<Model>> {
    S t, t_begin, t_end;
    S h;       // the last step
    S h_next;  // the next trial step
    vec<S, n_state<Model>> y;
    index_of<S> index;
    integer_of<S> phase;
    vec<integer_of<S>, n_event<Model>> event_count;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

/// The argument of a hook: references into the data, constant where the model may not write. Times and steps are in the
/// model's unit of time; `h` is negative when integrating backwards. `index` is the number of the instance, `phase`
/// counts from zero at the ensemble's start, `event_count[i]` the detections of event i in this phase. Parameters are
/// writable if the model declares `writes_parameters`, the time domain if it declares `writes_time_domain`: a phase
/// continues to a new t_end, backwards if need be; a new t_begin takes effect in the next phase.
template <class Model, class S>
struct lane : past_of_hook<Model, S, detail::has_delays<Model>> {
    /// A reference, constant where the model may not write.
    template <class T, bool writable>
    using ref = std::conditional_t<writable, T&, const T&>;

    const S& t;                                         ///< time
    ref<S, detail::writes_time_domain<Model>> t_begin;  ///< begin of the time domain; with `phase_length` of the phase
    ref<S, detail::writes_time_domain<Model>> t_end;    ///< end of the time domain; with `phase_length` of the phase
    const S& h;                                         ///< length of the step just taken; 0 before the first
    S& h_next;                                          ///< length of the next trial step, which a hook may change
    vec<S, detail::n_state<Model>>& y;                  ///< the state
    /// The parameters of the instance.
    ref<vec<S, detail::n_parameter<Model>>, detail::writes_parameters<Model>> parameter;
    shared_values<Model, real_of<S>> shared;                                    ///< values that all instances share
    shared_values<Model, std::int32_t> shared_integer;                          ///< integers that all instances share
    vec<S, detail::n_accessory<Model>>& accessory;                              ///< the model's own storage
    vec<integer_of<S>, detail::n_integer_accessory<Model>>& integer_accessory;  ///< its integers
    const detail::index_of<S>& index;                               ///< number of the instance in the ensemble
    const integer_of<S>& phase;                                     ///< number of the phase, from the ensemble's start
    const vec<integer_of<S>, detail::n_event<Model>>& event_count;  ///< detections of each event in this phase

    /// Made by the library.
    MYRIAD_FUNCTION explicit lane(detail::lane_data<Model, S>& d)
        : past_of_hook<Model, S, detail::has_delays<Model>>(d), t(d.t), t_begin(d.t_begin), t_end(d.t_end), h(d.h),
          h_next(d.h_next), y(d.y), parameter(d.parameter), shared(d.shared), shared_integer(d.shared_integer),
          accessory(d.accessory), integer_accessory(d.integer_accessory), index(d.index), phase(d.phase),
          event_count(d.event_count) {}
};

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

/// Copies lane i out of a vector of packs; `set_lanes` writes it back.
template <class R, class S, extent n>
MYRIAD_FUNCTION vec<R, n> get_lanes(const vec<S, n>& v, int i) {
    vec<R, n> out;
    MYRIAD_UNROLL
    for (int c = 0; c < MYRIAD_LENGTH(n); ++c) out[c] = static_cast<R>(get_lane(v[c], i));
    return out;
}
template <class R, class S, extent n>
MYRIAD_FUNCTION void set_lanes(vec<S, n>& v, int i, const vec<R, n>& lane) {
    MYRIAD_UNROLL
    for (int c = 0; c < MYRIAD_LENGTH(n); ++c) set_lane(v[c], i, lane[c]);
}

/// Whether the first components of two states are equal (a NaN equals nothing).
template <class R, extent n>
MYRIAD_FUNCTION bool same_values(const vec<R, n>& a, const vec<R, n>& b, int count = MYRIAD_LENGTH(n)) {
    bool same = true;
    MYRIAD_UNROLL
    for (int c = 0; c < count; ++c) same = same && a[c] == b[c];
    return same;
}

/// How a member of `lane_data` is used.
template <bool written_by_hooks, bool read_by_rhs>
struct member_use {
    static constexpr bool written = written_by_hooks;              // by hooks
    static constexpr bool acts = written_by_hooks && read_by_rhs;  // by hooks, and rhs or events may read it
};

/// Calls `visit(member_use, the member in each of the data...)` for every member of `lane_data`.
template <class Model, class Visit, class... Data>
MYRIAD_FUNCTION void for_each_member(Visit&& visit, Data&... d) {
    constexpr bool read = !accessories_are_outputs<Model>;
    visit(member_use<true, true>{}, d.y...);
    visit(member_use<true, read>{}, d.accessory...);
    visit(member_use<true, read>{}, d.integer_accessory...);
    visit(member_use<writes_parameters<Model>, true>{}, d.parameter...);
    visit(member_use<writes_time_domain<Model>, false>{}, d.t_begin...);
    visit(member_use<writes_time_domain<Model>, false>{}, d.t_end...);
    visit(member_use<true, false>{}, d.h_next...);
    visit(member_use<false, true>{}, d.t...);
    visit(member_use<false, true>{}, d.shared...);
    visit(member_use<false, true>{}, d.shared_integer...);
    if constexpr (has_delays<Model>) {
        visit(member_use<false, false>{}, d.delayed...);
        visit(member_use<false, false>{}, d.past...);
        visit(member_use<jump_numbers<Model> != 0, false>{}, d.later...);
    }
    visit(member_use<false, false>{}, d.h...);
    visit(member_use<false, false>{}, d.index...);
    visit(member_use<false, false>{}, d.phase...);
    visit(member_use<false, false>{}, d.event_count...);
}

/// Copies lane i of a member out of a pack; `put_lane` writes it back.
template <class R, class S>
MYRIAD_FUNCTION void copy_lane(R& to, const S& from, int i) {
    to = static_cast<R>(get_lane(from, i));
}
template <class R, class S, extent n>
MYRIAD_FUNCTION void copy_lane(vec<R, n>& to, const vec<S, n>& from, int i) {
    to = get_lanes<R>(from, i);
}
template <class Model, class T>
MYRIAD_FUNCTION void copy_lane(shared_values<Model, T>& to, const shared_values<Model, T>& from, int) {
    to = from;
}
template <class S, class R>
MYRIAD_FUNCTION void put_lane(S& to, int i, const R& from) {
    set_lane(to, i, from);
}
template <class S, class R, extent n>
MYRIAD_FUNCTION void put_lane(vec<S, n>& to, int i, const vec<R, n>& from) {
    set_lanes(to, i, from);
}

/// Lane i of a pack as the data of one instance.
template <class Model, class S>
MYRIAD_FUNCTION lane_data<Model, real_of<S>> extract_lane(const lane_data<Model, S>& d, int i) {
    lane_data<Model, real_of<S>> one;
    detail::for_each_member<Model>(
        [&](auto, auto& to, const auto& from) MYRIAD_LAMBDA { detail::copy_lane(to, from, i); }, one, d);
    return one;
}

/// The inputs of lane i for functions of one instance: a copy of a pack's, the data themselves of one instance.
template <class Model, class S>
MYRIAD_FUNCTION decltype(auto) inputs_of_lane(const lane_data<Model, S>& d, int i) {
    if constexpr (lanes_of < S >> 1) {
        return detail::extract_lane(d, i);
    } else {
        return static_cast<const inputs<Model, S>&>(d);
    }
}

/// Writes back the members that a hook may have changed.
template <class Model, class S>
MYRIAD_FUNCTION void insert_lane(lane_data<Model, S>& d, int i, const lane_data<Model, real_of<S>>& one) {
    detail::for_each_member<Model>(
        [&](auto use, auto& to, const auto& from) MYRIAD_LAMBDA {
            if constexpr (use.written) detail::put_lane(to, i, from);
        },
        d, one);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
