// SPDX-License-Identifier: MIT
// Goes through the recorded steps of instances from the last to the first, for gradients by an adjoint: the lanes of a
// pack, or the thread of a GPU.
#pragma once

#include <cstdint>

#include "myriad/kernel/adjoint/adjoint_call.hpp"
#include "myriad/kernel/adjoint/transposed_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Instances of an adjoint call that lanes go through together. Computes the values of quantities or the gradient.
/// Besides what transposed_step.hpp asks for, `Adjoint` has n_quantity `quantities` of time, state and parameters, and
/// `transposed_quantities`; and n_action actions of events and stops: `act` gives the state after one, `transposed_act`
/// and `slope_of_event` have derivatives by time behind the others. `between_jumps` is the number of the
/// accessory that tells the equations a time between the last jump and the next, negative if they do not jump. A record
/// at the time of an action has the state before it.
template <class Adjoint, class Method, class S, bool wants_values>
class adjoint_pack {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int n = n_state<Adjoint>, n_wrt = Adjoint::n_wrt, n_quantity = Adjoint::n_quantity;
    static constexpr int n_action = Adjoint::n_action, lanes = lanes_of<S>;

public:
    /// Of the instances from `first` on, before `end`.
    adjoint_pack(const adjoint_call& call, std::int64_t first, std::int64_t end) : call_(call) {
        p_.shared = call.shared;
        p_.shared_integer = call.shared_integer;
        for (int i = 0; i < lanes; ++i) {
            const bool there = first + i < end;
            instance_[i] = there ? first + i : first;
            next_step_[i] = there ? call.stored[instance_[i]] - 2 : -1;
            next_sample_[i] = there ? call.samples - 1 : -1;
            is_there_[i] = there && call.stored[instance_[i]] > 0;
            for (int c = 0; c < n_parameter<Adjoint>; ++c)
                set_lane(p_.parameter[c], i, call.parameter[c][instance_[i]]);
            read(i, next_step_[i] >= 0 ? next_step_[i] + 1 : 0);
        }
        y_ = before_action<n_action>();
        loss_ = {};
    }

    /// Goes through all steps.
    void run() {
        if (call_.sample_time == nullptr) add_sample_at_end();
        while (read_steps()) {
            interpolates_ = false;
            add_samples();
            if constexpr (!wants_values) step_back();
        }
        add_samples_at_start();
        if constexpr (!wants_values) store_gradient();
    }

private:
    const adjoint_call& call_;
    std::int64_t instance_[lanes], next_step_[lanes], next_sample_[lanes];
    bool is_there_[lanes];
    mask active_;  // lanes that have a step
    S t_, t_end_, h_;
    vec<S, n> before_, y_, y_end_;  // at the start before and after an action, and at the end before one
    vec<mask, n_action> acted_;
    inputs<Adjoint, S> p_{};
    loss_derivatives<Adjoint, S> loss_;
    vec<S, n> inside_;  // by the state at the start of the step, from states inside it
    transposed_step<Adjoint, Method, S> step_;
    bool interpolates_ = false;

    /// Lets the equations take the branches that hold between the jumps before and after the step.
    void choose_branches() {
        if constexpr (Adjoint::between_jumps >= 0) p_.accessory[Adjoint::between_jumps] = fma(S(R(0.5)), h_, t_);
    }
    /// Reads a record of lane i.
    void read(int i, std::int64_t record) {
        const std::int64_t cell = record * call_.size + instance_[i];
        set_lane(t_, i, call_.time[cell]);
        for (int c = 0; c < n; ++c) set_lane(before_[c], i, call_.state[c][cell]);
        const bool is_last = record + 1 >= call_.stored[instance_[i]];
        for (int a = 0; a < n_action; ++a) {
            const double after = is_last ? call_.acted_in_all[a][instance_[i]] : call_.acted[a][cell + call_.size];
            set_lane(acted_[a], i, after > call_.acted[a][cell]);
        }
    }
    /// The state before action a; after all actions if a is n_action. Of actions at one time each sees what the earlier
    /// ones have done.
    template <int a>
    vec<S, n> before_action() const {
        vec<S, n> y = before_;
        if constexpr (a > 0)
            static_for<0, a>([&](auto b) {
                if (!any(acted_[b])) return;
                const auto after = Adjoint::template act<S>(t_, y, p_, b);
                for (int c = 0; c < n; ++c) y[c] = select(acted_[b], after[c], y[c]);
            });
        return y;
    }
    /// Goes back through the actions at the start of the step. The time of an event moves with the state before it:
    /// what Galan, Feehery and Barton, Appl. Numer. Math. 31 (1999) 17-47, have for sensitivities, transposed.
    void transpose_actions(const mask& which) {
        if constexpr (n_action > 0)
            static_for<0, n_action>([&](auto i) { transpose_action<n_action - 1 - decltype(i)::value>(which); });
    }
    template <int a>
    void transpose_action(const mask& in) {
        const mask acted = in & acted_[a];
        if (!any(acted)) return;
        constexpr int last = n + n_wrt;
        constexpr constant_index<a> action;
        const auto before = before_action<a>();
        auto product = Adjoint::template transposed_act<S>(t_, before, p_, loss_.state, action);
        if constexpr (Adjoint::is_event[a]) {
            const auto slope = detail::evaluate_rhs<Adjoint>(t_, before, p_);
            const auto slope_after = detail::evaluate_rhs<Adjoint>(t_, y_, p_);
            const auto event = Adjoint::template slope_of_event<S>(t_, before, p_, action);
            S by_time = product[last], rate = event[last];
            for (int c = 0; c < n; ++c) {
                by_time = fma(product[c], slope[c], fma(-loss_.state[c], slope_after[c], by_time));
                rate = fma(event[c], slope[c], rate);
            }
            const S factor = -by_time / rate;
            for (int c = 0; c < last; ++c) product[c] = fma(factor, event[c], product[c]);
        }
        for (int c = 0; c < n; ++c) loss_.state[c] = select(acted, product[c], loss_.state[c]);
        for (int c = 0; c < n_wrt; ++c) loss_.wrt[c] = loss_.wrt[c] + select(acted, product[n + c], S(R(0)));
    }
    /// Reads the steps before. Returns false if no lane has one.
    bool read_steps() {
        t_end_ = t_;
        y_end_ = before_;
        inside_ = {};
        bool some = false;
        for (int i = 0; i < lanes; ++i) {
            if constexpr (wants_values)  // only steps with samples
                while (next_step_[i] > 0 && !has_sample(i)) --next_step_[i];
            const bool has = next_step_[i] >= 0;
            set_lane(active_, i, has);
            some = some || has;
            if (!has) continue;
            if constexpr (wants_values) {
                read(i, next_step_[i] + 1);
                set_lane(t_end_, i, get_lane(t_, i));
                for (int c = 0; c < n; ++c) set_lane(y_end_[c], i, get_lane(before_[c], i));
            }
            read(i, next_step_[i]--);
        }
        y_ = before_action<n_action>();
        h_ = t_end_ - t_;
        choose_branches();
        return some;
    }

    /// Whether the next step of lane i may have a sample.
    bool has_sample(int i) const {
        if (next_sample_[i] < 0) return false;
        const double begin = call_.time[next_step_[i] * call_.size + instance_[i]];
        const double end = call_.time[(next_step_[i] + 1) * call_.size + instance_[i]];
        const double t = call_.sample_time[next_sample_[i]];
        return begin <= end ? t > begin : t < begin;
    }
    void step_back() {
        if (!interpolates_) step_.begin(t_, h_, y_, p_, false);
        vec<S, n> end;
        for (int c = 0; c < n; ++c) end[c] = select(active_, loss_.state[c], S(R(0)));
        step_.transpose(end, p_, interpolates_, loss_);
        for (int c = 0; c < n; ++c) loss_.state[c] = loss_.state[c] + inside_[c];
        transpose_actions(active_);
    }
    void store_gradient() const {
        for (int i = 0; i < lanes; ++i) {
            if (!is_there_[i]) continue;
            double* const to = call_.gradient + instance_[i] * (n + n_wrt);
            for (int c = 0; c < n; ++c) to[c] = get_lane(loss_.state[c], i) + 0.0;  // no zero below zero
            for (int c = 0; c < n_wrt; ++c) to[n + c] = get_lane(loss_.wrt[c], i) + 0.0;
        }
    }

    /// A sample of every lane that has one.
    struct sample {
        S time;
        mask is, at_end;  // at the end of the step
        vec<S, n_quantity> weight;
        double* value[lanes];
    };
    bool take(sample& s, int i, bool at_end, bool& some) {
        const std::int64_t k = next_sample_[i]--, place = (instance_[i] * call_.samples + k) * n_quantity;
        if (call_.sample_time != nullptr) set_lane(s.time, i, call_.sample_time[k]);
        set_lane(s.is, i, true);
        set_lane(s.at_end, i, at_end);
        s.value[i] = call_.values == nullptr ? nullptr : call_.values + place;
        for (int q = 0; q < n_quantity; ++q)
            set_lane(s.weight[q], i, call_.weights == nullptr ? R(0) : call_.weights[place + q]);
        return some = true;
    }
    sample none(const S& t) const {
        sample s{t, mask(false), mask(false), {}, {}};
        return s;
    }
    /// Takes the sample at the end, where the last steps end.
    void add_sample_at_end() {
        sample s = none(t_);
        bool some = false;
        for (int i = 0; i < lanes; ++i)
            if (is_there_[i]) take(s, i, true, some);
        loss_.state = add_sample(s, y_);
        if constexpr (!wants_values) transpose_actions(s.is);
    }
    /// Takes the samples of this step, the last ones first.
    void add_samples() {
        for (;;) {
            sample s = none(t_end_);
            bool some = false, inside = false;
            for (int i = 0; i < lanes; ++i) {
                if (!get_lane(active_, i) || next_sample_[i] < 0) continue;
                const double t = call_.sample_time[next_sample_[i]], end = get_lane(t_end_, i);
                const double sign = get_lane(h_, i) < 0 ? -1 : 1;
                if (sign * (t - get_lane(t_, i)) <= 0) continue;
                const bool at_end = sign * (t - end) >= 0;
                inside = inside || !at_end;
                take(s, i, at_end, some);
            }
            if (!some) return;
            if (inside && !interpolates_) {
                step_.begin(t_, h_, y_, p_, true);
                interpolates_ = true;
            }
            vec<S, n> y = y_end_;
            const mask between = s.is & !s.at_end;
            const S theta = select(between, (s.time - t_) / h_, S(R(1)));
            if (inside) {
                const vec<S, n> found = step_.interpolate(y_, theta);
                for (int c = 0; c < n; ++c) y[c] = select(between, found[c], y[c]);
            }
            const vec<S, n> g = add_sample(s, y);
            vec<S, n> within;
            for (int c = 0; c < n; ++c) {
                loss_.state[c] = loss_.state[c] + select(s.at_end, g[c], S(R(0)));
                within[c] = select(between, g[c], S(R(0)));
                inside_[c] = inside_[c] + within[c];
            }
            if (!wants_values && inside) step_.add_inside(theta, within);
        }
    }
    /// Takes the samples at the very start.
    void add_samples_at_start() {
        for (;;) {
            sample s = none(t_);
            bool some = false;
            for (int i = 0; i < lanes; ++i)
                if (is_there_[i] && next_sample_[i] >= 0 && call_.sample_time[next_sample_[i]] == get_lane(t_, i))
                    take(s, i, true, some);
            if (!some) return;
            const vec<S, n> g = add_sample(s, before_);
            for (int c = 0; c < n; ++c) loss_.state[c] = loss_.state[c] + g[c];
        }
    }
    /// Stores the quantities of samples with that state, or returns the derivatives of the loss by it.
    vec<S, n> add_sample(const sample& s, const vec<S, n>& y) {
        vec<S, n> g = {};
        if constexpr (wants_values) {
            const auto found = Adjoint::template quantities<S>(s.time, y, p_);
            for (int i = 0; i < lanes; ++i)
                for (int q = 0; q < n_quantity && get_lane(s.is, i); ++q) s.value[i][q] = get_lane(found[q], i);
            return g;
        }
        const auto product = Adjoint::template transposed_quantities<S>(s.time, y, p_, s.weight);
        for (int c = 0; c < n; ++c) g[c] = select(s.is, product[c], S(R(0)));
        for (int c = 0; c < n_wrt; ++c) loss_.wrt[c] = loss_.wrt[c] + select(s.is, product[n + c], S(R(0)));
        return g;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
