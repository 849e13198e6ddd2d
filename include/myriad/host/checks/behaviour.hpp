// SPDX-License-Identifier: MIT
// Calls every function of a model for one instance. Host code, for studies.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include "myriad/host/checks/instance_inputs.hpp"
#include "myriad/host/checks/shown_values.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/model/lane.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A fraction from 0 to 1 that differs for each place and number.
inline double scattered(int at, int number) {
    const double turns = 0.618033988749894848 * at + 0.754877666246692760 * number;
    return turns - std::floor(turns);
}

template <class Model, class R>
class behaviour {
public:
    behaviour(const argument_head<R>& a, std::int64_t i, const shown_place& place, void* to,
              void (*take)(void* to, const shown_value&))
        : place_(place), to_(to), take_(take) {
        static_cast<inputs<Model, R>&>(data_) = detail::inputs_of<Model>(a, i);
        for (int c = 0; c < MYRIAD_LENGTH(n_accessory<Model>); ++c) data_.accessory[c] = a.accessory[c * a.size + i];
        for (int c = 0; c < MYRIAD_LENGTH(n_integer_accessory<Model>); ++c)
            data_.integer_accessory[c] = a.integer_accessory[c * a.size + i];
        data_.y = detail::state_of<Model>(a, i);
        data_.t_begin = detail::begin_of(a, i);
        data_.t_end = a.t_end != nullptr ? a.t_end[i] : a.common_t_end;
        data_.index = a.first_index + i;
        data_.phase = 0;
        data_.h = R(0);
        const R length = data_.t_end - data_.t_begin;
        data_.h_next = std::isfinite(length) ? length / R(1024) : R(1) / R(1024);
        for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j) data_.event_count[j] = 0;
        int salt = 0;
        for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) prepare(data_.y[c], ++salt);
        for (int c = 0; c < MYRIAD_LENGTH(n_parameter<Model>); ++c) prepare(data_.parameter[c], ++salt);
        for (int c = 0; c < MYRIAD_LENGTH(n_accessory<Model>); ++c) prepare(data_.accessory[c], ++salt);
        data_.t = data_.t_begin;
    }

    void show() {
        const auto take_all = [&](model_function function, const auto& values, int count, shown_kind kind) {
            for (int c = 0; c < count; ++c) take(function, 0, kind, c, values[c]);
        };
        if (place_.at == 0) {
            take_all(model_function::start, data_.y, MYRIAD_LENGTH(n_state<Model>), shown_kind::state);
            take_all(model_function::start, data_.parameter, MYRIAD_LENGTH(n_parameter<Model>), shown_kind::parameter);
        }
        if constexpr (has_initialise<Model>)
            act(
                model_function::initialise, 0, [](auto& lane) { Model::initialise(lane); }, data_);
        if (place_.at > 0) move();
        const inputs<Model, R>& p = data_;
        const R t = data_.t;
        if constexpr (has_delays<Model>) {
            detail::recall<Model>(t, data_.y, p);
            for (int j = 0; j < MYRIAD_LENGTH(n_delayed<Model>); ++j)
                take(model_function::rhs, 0, shown_kind::result, j, detail::lag_of<Model>(j, t, data_.y, p));
        }
        take_all(model_function::rhs, Model::template rhs<R>(t, data_.y, p), MYRIAD_LENGTH(n_state<Model>),
                 shown_kind::state);
        if constexpr (has_events<Model>)
            take_all(model_function::events, Model::template events<R>(t, data_.y, p), MYRIAD_LENGTH(n_event<Model>),
                     shown_kind::result);
        if constexpr (has_observe<Model>)
            take_all(model_function::observe, Model::template observe<R>(t, data_.y, p), n_observed<Model>,
                     shown_kind::result);
        static_for<0, n_summary<Model>>([&](auto r) {
            constexpr unmarked_summary what = summary_at<Model, decltype(r)::value>;
            take(model_function::summary, r, shown_kind::result, 0,
                 (what.quantity * 8 + static_cast<int>(what.kind)) * 4096 + what.accessory);
        });
        if constexpr (has_stops<Model>) {
            for (int j = 0; j < MYRIAD_LENGTH(n_stop<Model>); ++j)
                take(model_function::stop_time, j, shown_kind::result, place_.at,
                     Model::template stop_time<R>(j, place_.at, p));
        }
        if constexpr (has_triggers<Model>) show_conditions();
        if constexpr (has_generic_after_step<Model, R>) {
            change(model_function::after_step, 0, [](auto& lane) {
                if constexpr (std::is_void_v<decltype(Model::template after_step<R>(lane))>) {
                    Model::template after_step<R>(lane);
                } else {
                    return Model::template after_step<R>(lane) ? action::end_phase : action::proceed;
                }
            });
        } else if constexpr (has_after_step<Model>) {
            change(model_function::after_step, 0, [](auto& lane) { return Model::after_step(lane); });
        }
        if constexpr (has_after_event<Model>) {
            for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j)
                change(model_function::after_event, j, [j](auto& lane) { return Model::after_event(j, lane); });
        }
        show_stops(data_);
        if constexpr (has_triggers<Model>) {
            for (int j = 0; j < MYRIAD_LENGTH(n_trigger<Model>); ++j)
                change(model_function::after_trigger, j, [j](auto& lane) { return Model::after_trigger(j, lane); });
        }
        if constexpr (has_finalise<Model>)
            change(model_function::finalise, 0, [](auto& lane) { Model::finalise(lane); });
    }

private:
    /// Sets a number that only a user's generator sets, and changes it by some roundings; a whole number may count
    /// something.
    void prepare(R& x, int salt) const {
        if (x != x) x = static_cast<R>(0.5 + detail::scattered(1, salt));
        if (place_.rounding == 0 || x == std::floor(x)) return;
        const double by = std::floor(7 * detail::scattered(place_.rounding, salt)) - 3;
        x *= R(1) + static_cast<R>(by) * std::numeric_limits<R>::epsilon();
    }
    /// Goes to a place near the start, by a tenth of what each state has: models need not know others.
    void move() {
        const R length = data_.t_end - data_.t_begin;
        data_.t += static_cast<R>(detail::scattered(place_.at, 0)) * (std::isfinite(length) ? length : R(1));
        for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c) {
            const auto by = static_cast<R>(detail::scattered(place_.at, c + 1));
            data_.y[c] += data_.y[c] == R(0) ? by / R(64) : data_.y[c] * (by - R(0.5)) / R(8);
        }
    }

    template <class T>
    void take(model_function function, int number, shown_kind kind, int component, const T& value) const {
        take_(to_, {function, number, kind, component, static_cast<double>(value)});
    }
    /// A value that an action has changed by more than roundings.
    void take_changed(model_function function, int number, shown_kind kind, int component, R before, R after) const {
        const R most = R(4096) * std::numeric_limits<R>::epsilon() * std::fmax(std::fabs(before), std::fabs(after));
        const bool both_unset = before != before && after != after;
        if (!both_unset && !(std::fabs(after - before) <= most)) take(function, number, kind, component, after);
    }

    /// Calls an action on these data, and takes what it changes.
    template <class Hook>
    void act(model_function function, int number, const Hook& hook, lane_data<Model, R>& data) const {
        const lane_data<Model, R> before = data;
        const action wanted = detail::run_on_lane(data, 0, hook);
        const auto changed = [&](shown_kind kind, const auto& from, const auto& to, int count) {
            for (int c = 0; c < count; ++c) take_changed(function, number, kind, c, from[c], to[c]);
        };
        changed(shown_kind::state, before.y, data.y, MYRIAD_LENGTH(n_state<Model>));
        changed(shown_kind::accessory, before.accessory, data.accessory, MYRIAD_LENGTH(n_accessory<Model>));
        if constexpr (writes_parameters<Model>)
            changed(shown_kind::parameter, before.parameter, data.parameter, MYRIAD_LENGTH(n_parameter<Model>));
        for (int c = 0; c < MYRIAD_LENGTH(n_integer_accessory<Model>); ++c)
            if (before.integer_accessory[c] != data.integer_accessory[c])
                take(function, number, shown_kind::integer_accessory, c, data.integer_accessory[c]);
        if constexpr (writes_time_domain<Model>) {
            take_changed(function, number, shown_kind::t_begin, 0, before.t_begin, data.t_begin);
            take_changed(function, number, shown_kind::t_end, 0, before.t_end, data.t_end);
        }
        take_changed(function, number, shown_kind::next_step, 0, before.h_next, data.h_next);
        if (wanted != action::proceed) take(function, number, shown_kind::wish, 0, static_cast<int>(wanted));
    }
    /// The same on a copy, which is where the functions of the model were called; then what the action has set a time
    /// for.
    template <class Hook>
    void change(model_function function, int number, const Hook& hook) {
        lane_data<Model, R> data = data_;
        act(function, number, hook, data);
        show_stops(data);
    }
    /// Calls the action of each stop that has a time, at that time, as the loop does: one that is not due may have
    /// nothing to take from a queue. Once for each stop.
    void show_stops(const lane_data<Model, R>& from) {
        if constexpr (has_after_stop<Model>) {
            for (int j = 0; j < MYRIAD_LENGTH(n_stop<Model>); ++j) {
                const inputs<Model, R>& p = from;
                const R time = Model::template stop_time<R>(j, place_.at, p);
                if (stop_is_shown_[static_cast<std::size_t>(j)] || !std::isfinite(time)) continue;
                stop_is_shown_[static_cast<std::size_t>(j)] = true;
                lane_data<Model, R> data = from;
                data.t = time;
                act(
                    model_function::after_stop, j, [&, j](auto& lane) { return Model::after_stop(j, place_.at, lane); },
                    data);
            }
        }
    }

    /// The conditions for some of the signs that their event functions may have.
    void show_conditions() const {
        mask_set<bool, n_event<Model>> positive;
        for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j)
            positive.set(j, detail::scattered(place_.at, j) < (place_.at % 3 + 1) * 0.25);
        for (int k = 0; k < MYRIAD_LENGTH(n_trigger<Model>); ++k)
            take(model_function::condition, k, shown_kind::result, 0,
                 Model::condition(k, event_signs<n_event<Model>>(positive)) ? 1 : 0);
    }

    shown_place place_;
    void* to_;
    void (*take_)(void* to, const shown_value&);
    lane_data<Model, R> data_{};
    std::vector<bool> stop_is_shown_ = std::vector<bool>(static_cast<std::size_t>(MYRIAD_LENGTH(n_stop<Model>)));
};

/// See `behaviour_function`.
template <class Model, class R>
void show_behaviour(const argument_head<R>& a, std::int64_t i, const shown_place& place, void* to,
                    void (*take)(void* to, const shown_value&)) {
    behaviour<Model, R>(a, i, place, to, take).show();
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
