// SPDX-License-Identifier: MIT
// The model that runs a tape, with as many components as that has.
#pragma once

// clang-format off
#include "tape_vectors.hpp"  // before the kernel body
// clang-format on

#include <limits>
#include <type_traits>

#include "myriad/kernel/model/action_queue.hpp"
#include "myriad/python/kernel_library.hpp"

namespace myriad::python {

template <class R>
inline constexpr bool is_dual = requires(R x) {
    x.derivative;
};

/// Numbers of any kind as reals, lane by lane, and back.
template <class R, class I>
inline R real_lanes(const I& from) {
    if constexpr (is_dual<R>) {
        return R(real_lanes<decltype(R::value)>(from));
    } else {
        R to{};
        for (int i = 0; i < lanes_of<R>; ++i)
            detail::set_lane(to, i, static_cast<real_of<R>>(detail::get_lane(from, i)));
        return to;
    }
}
/// The whole number that a register holds.
inline std::int64_t whole(double x) {
    return x < 0x1p63 ? static_cast<std::int64_t>(x) : std::numeric_limits<std::int64_t>::max();
}
template <class I, class R>
inline void store_integer(I& to, const R& from) {
    for (int i = 0; i < lanes_of<R>; ++i)
        detail::set_lane(to, i, static_cast<std::int32_t>(whole(detail::get_lane(from, i))));
}

/// The elementary functions, compiled once for each kind of numbers, in tape_functions.cpp.
template <class R>
void apply_function(tape_code code, const R& x, const R& y, R& result);
/// The same for operations of whole numbers.
template <class R>
void apply_to_whole_numbers(tape_code code, bool is_long, const R& x, const R& y, R& result);

/// What a hook of a tape wants for its instances.
template <class R>
struct tape_wishes {
    mask_of<R> end_phase{}, end_instance{};
};
/// An action that waits: what the function of a trigger puts or drops, and what is taken from the queue.
struct tape_action {
    int put = -1, drop = -1;  ///< the number of the action
    double time = 0.0, priority = -std::numeric_limits<double>::infinity();
    vec<double, tape_values> value;
};

/// The arguments of rhs and events.
template <class R, class States, class Inputs>
struct function_source {
    static constexpr bool in_hook = false;
    const R& t;
    const States& y;
    const Inputs& p;
    R* results;
};
/// The arguments of a hook; `waiting` where there is an action that waits.
template <class R, class Lane>
struct hook_source {
    static constexpr bool in_hook = true;
    Lane& p;
    tape_wishes<R>& wishes;
    tape_action* waiting = nullptr;
};

/// The argument of `generate`: an instance of a study.
template <class Instance>
struct generate_source {
    static constexpr bool in_hook = false;
    Instance& p;
};

inline void run_on_waiting_action(const tape_step& step, tape_action& waiting, double& x);

/// Runs a function. One copy for each kind of arguments, since kernels call it at every stage.
template <class R, class Source>
[[gnu::noinline]] void run_tape(const tape_function& f, const Source& s) {
    tape_array<R> registers(static_cast<std::size_t>(f.registers));
    R* const r = registers.data();
    const auto truth = [](const auto& mask) { return myriad::select(mask, R(1), R(0)); };
    for (const tape_step* step = f.begin; step != f.end; ++step) {
        const auto [value, to, a, b, c, code] = *step;
        switch (code) {
            case tape_code::constant:
                r[to] = R(static_cast<real_of<R>>(value));
                break;
            case tape_code::negate:
                r[to] = -r[a];
                break;
            case tape_code::fma:
                r[to] = myriad::fma(r[a], r[b], r[c]);
                break;
            case tape_code::select:
                r[to] = myriad::select(r[a] != R(0), r[b], r[c]);
                break;
            case tape_code::both:
                r[to] = r[a] * r[b];
                break;
            case tape_code::either:
                r[to] = myriad::max(r[a], r[b]);
                break;
            case tape_code::opposite:
                r[to] = R(1) - r[a];
                break;
            case tape_code::is_finite:
                r[to] = truth(myriad::is_finite(r[a]));
                break;
            case tape_code::lookup:
                r[to] = myriad::lookup(static_cast<const real_of<R>*>(s.p.shared) + static_cast<std::int64_t>(value), c,
                                       a, r[b]);
                break;
            case tape_code::find_interval:
                r[to] = myriad::find_interval(
                    static_cast<const real_of<R>*>(s.p.shared) + static_cast<std::int64_t>(value), a, r[b]);
                break;
#define MYRIAD_TAPE_CASE(name, op) \
    case tape_code::name:          \
        r[to] = r[a] op r[b];      \
        break;
                MYRIAD_TAPE_INFIX(MYRIAD_TAPE_CASE)
#undef MYRIAD_TAPE_CASE
#define MYRIAD_TAPE_CASE(name, op)   \
    case tape_code::name:            \
        r[to] = truth(r[a] op r[b]); \
        break;
                MYRIAD_TAPE_COMPARISON(MYRIAD_TAPE_CASE)
#undef MYRIAD_TAPE_CASE
            case tape_code::load_parameter:
                r[to] = s.p.parameter[a];
                break;
            case tape_code::load_shared:
                r[to] = R(static_cast<const real_of<R>*>(s.p.shared)[a]);
                break;
            case tape_code::load_shared_integer:
                r[to] = R(static_cast<real_of<R>>(static_cast<const std::int32_t*>(s.p.shared_integer)[a]));
                break;
            case tape_code::load_accessory:
                r[to] = s.p.accessory[a];
                break;
            case tape_code::load_integer_accessory:
                r[to] = real_lanes<R>(s.p.integer_accessory[a]);
                break;
            default:
                if (code >= tape_code::powr && code <= tape_code::floor_divide) {
                    apply_function(code, r[a], r[b], r[to]);
                } else if (code >= tape_code::wrapping_add && code <= tape_code::remainder) {
                    apply_to_whole_numbers(code, c != 0, r[a], r[b], r[to]);
                } else if constexpr (Source::in_hook) {
                    run_in_hook<R>(*step, s, r);
                } else if constexpr (requires { s.p.random; }) {
                    run_in_generate(*step, s.p, r);
                } else if (code == tape_code::load_state) {
                    r[to] = s.y[a];
                } else if (code == tape_code::load_time) {
                    r[to] = s.t;
                } else if (code == tape_code::store_result) {
                    s.results[a] = r[to];
                }
        }
    }
}
/// The operations that only hooks have.
template <class R, class Source>
inline void run_in_hook(const tape_step& step, const Source& s, R* r) {
    auto& lane = s.p;
    R& x = r[step.to];
    const int c = step.a;
    switch (step.code) {
        case tape_code::load_state:
            x = lane.y[c];
            break;
        case tape_code::load_time:
            x = lane.t;
            break;
        case tape_code::load_step:
            x = lane.h;
            break;
        case tape_code::load_next_step:
            x = lane.h_next;
            break;
        case tape_code::load_t_begin:
            x = lane.t_begin;
            break;
        case tape_code::load_t_end:
            x = lane.t_end;
            break;
        case tape_code::load_phase:
            x = real_lanes<R>(lane.phase);
            break;
        case tape_code::load_instance:
            x = real_lanes<R>(lane.index);
            break;
        case tape_code::load_event_count:
            x = real_lanes<R>(lane.event_count[c]);
            break;
        case tape_code::store_state:
            lane.y[c] = x;
            break;
        case tape_code::store_parameter:
            lane.parameter[c] = x;
            break;
        case tape_code::store_accessory:
            lane.accessory[c] = x;
            break;
        case tape_code::store_integer_accessory:
            store_integer(lane.integer_accessory[c], x);
            break;
        case tape_code::store_next_step:
            lane.h_next = x;
            break;
        case tape_code::store_end_phase:
            s.wishes.end_phase = x != R(0);
            break;
        case tape_code::store_end_instance:
            s.wishes.end_instance = x != R(0);
            break;
        default:
            if constexpr (std::is_same_v<R, double>) run_on_waiting_action(step, *s.waiting, x);
    }
}
/// The operations of actions that wait.
inline void run_on_waiting_action(const tape_step& step, tape_action& waiting, double& x) {
    switch (step.code) {
        case tape_code::load_waiting:
            x = waiting.value[step.a];
            break;
        case tape_code::store_waiting:
            waiting.value[step.a] = x;
            break;
        case tape_code::store_put:
            waiting.put = step.a;
            waiting.time = x;
            break;
        case tape_code::store_drop:
            waiting.drop = step.a;
            break;
        case tape_code::store_result:
            waiting.priority = x;
            break;
        default:
            break;
    }
}

/// The operations that only `generate` has.
template <class R, class Instance>
inline void run_in_generate(const tape_step& step, Instance& instance, R* r) {
    R& x = r[step.to];
    const int c = step.a;
    switch (step.code) {
        case tape_code::load_state:
            x = instance.y[c];
            break;
        case tape_code::load_instance:
            x = static_cast<R>(instance.index);
            break;
        case tape_code::uniform:
            x = instance.random.uniform(r[step.a], r[step.b]);
            break;
        case tape_code::normal:
            x = instance.random.normal(r[step.a], r[step.b]);
            break;
        case tape_code::store_state:
            instance.y[c] = x;
            break;
        case tape_code::store_parameter:
            instance.parameter[c] = x;
            break;
        case tape_code::store_accessory:
            instance.accessory[c] = x;
            break;
        case tape_code::store_integer_accessory:
            instance.integer_accessory[c] = static_cast<std::int32_t>(whole(x));
            break;
        default:
            break;
    }
}

template <bool one_by_one>
struct tape_model {
    static constexpr bool writes_parameters = true;
    static constexpr bool rare_events = true;
    static constexpr bool large_rhs = true;
    static constexpr bool scalar_only = one_by_one;
    static constexpr int pack_batches = tape_batches;
    static constexpr extent n_state = tape_extent::state, n_parameter = tape_extent::parameter,
                            n_accessory = tape_extent::accessory, n_event = tape_extent::event,
                            n_integer_accessory = tape_extent::integer_accessory;
    enum shared { n_shared = 1 };
    enum shared_integer { n_shared_integer = 1 };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_state> slopes;
        if constexpr (is_dual<R>) {  // the derivative by the time, which the tape does not read
            if (current_tape->autonomous && detail::any(R(t).derivative != decltype(R::derivative)(0))) return slopes;
        }
        run(current_tape->rhs, t, y, p, &slopes[0]);
        return slopes;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_event> values;
        run(current_tape->events, t, y, p, &values[0]);
        return values;
    }
    /// The entries of the Jacobian.
    template <class S>
    static void derivatives(const S& t, const myriad::vec<S, n_state>& y, const auto& p, S* entries) {
        run(current_tape->jacobian, t, y, p, entries);
    }

    MYRIAD_FUNCTION static void initialise(auto& lane) { hook(current_tape->initialise, lane); }
    template <class R>
    MYRIAD_FUNCTION static auto after_step(auto& lane) {
        tape_wishes<R> wishes;
        wishes.end_phase = R(0) != R(0);
        if (!current_tape->after_step.empty())
            run_tape<R>(current_tape->after_step,
                        hook_source<R, std::remove_reference_t<decltype(lane)>>{lane, wishes});
        return wishes.end_phase;
    }
    MYRIAD_FUNCTION static myriad::action after_event(int event, auto& lane) {
        return hook(current_tape->after_event[event], lane);
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { hook(current_tape->finalise, lane); }
    MYRIAD_FUNCTION static void generate(auto& instance) {
        using source = generate_source<std::remove_reference_t<decltype(instance)>>;
        run_tape<typename std::remove_cvref_t<decltype(instance)>::real>(current_tape->generate, source{instance});
    }

protected:
    template <class R>
    MYRIAD_FUNCTION static void run(const tape_function& f, const auto& t, const myriad::vec<R, n_state>& y,
                                    const auto& p, R* results) {
        if (f.empty()) return;
        const R time(t);
        run_tape<R>(f,
                    function_source<R, myriad::vec<R, n_state>, std::remove_cvref_t<decltype(p)>>{time, y, p, results});
    }
    /// A hook of one instance.
    MYRIAD_FUNCTION static myriad::action hook(const tape_function& f, auto& lane, tape_action* waiting = nullptr) {
        using R = std::remove_cvref_t<decltype(lane.h_next)>;
        tape_wishes<R> wishes;
        if (f.empty()) return myriad::action::proceed;
        run_tape<R>(f, hook_source<R, std::remove_reference_t<decltype(lane)>>{lane, wishes, waiting});
        if (wishes.end_instance) return myriad::action::end_instance;
        return wishes.end_phase ? myriad::action::end_phase : myriad::action::proceed;
    }
};

/// The places of the queue of the tape.
struct tape_layout : tape_queue {
    static constexpr int most_values = tape_values;
    tape_layout() : tape_queue(current_tape->queue) {}
};
/// The sides of event functions, as the states that a condition reads.
template <class Sides>
struct states_of_sides {
    const Sides& positive;
    double operator[](int j) const { return positive[j] ? 1.0 : 0.0; }
};
/// The inputs of a function that reads none.
struct no_inputs {
    const double *parameter = nullptr, *accessory = nullptr, *shared = nullptr;
    const std::int32_t *integer_accessory = nullptr, *shared_integer = nullptr;
};

/// The same with stops and triggers.
struct triggered_tape_model : tape_model<true> {
    using queue = basic_action_queue<tape_layout>;
    static constexpr extent n_stop = tape_extent::stop, n_trigger = tape_extent::trigger;

    template <class R>
    [[gnu::noinline]] static R stop_time(int stop, int number, const auto& p) {
        if (stop == current_tape->due) return queue::next_time(p);
        R time = infinity_of<R>;
        read(current_tape->stop_time[stop], R(number), &time, p, time);
        return time;
    }
    [[gnu::noinline]] static myriad::action after_stop(int stop, int, auto& lane) {
        if (stop != current_tape->due) return hook(current_tape->after_stop[stop], lane);
        tape_action waiting;
        const auto priority = [&](int action) {
            tape_action one;
            hook(current_tape->priority[action], lane, &one);
            return one.priority;
        };
        const auto taken = queue::take(lane, priority, current_tape->seed);
        if (taken.action < 0) return myriad::action::proceed;
        waiting.value = taken.value;
        return hook(current_tape->late_action[taken.action], lane, &waiting);
    }
    [[gnu::noinline]] static bool condition(int trigger, const auto& positive) {
        double holds = 0.0;
        read(current_tape->condition[trigger], 0.0, states_of_sides<std::remove_cvref_t<decltype(positive)>>{positive},
             no_inputs{}, holds);
        return holds != 0.0;
    }
    static bool initial_value(int trigger) { return !current_tape->false_at_first[trigger]; }
    static bool persistent(int trigger) { return !current_tape->lapsing[trigger]; }
    [[gnu::noinline]] static myriad::action after_trigger(int trigger, auto& lane) {
        tape_action waiting;
        const myriad::action wanted = hook(current_tape->after_trigger[trigger], lane, &waiting);
        if (waiting.drop >= 0) queue::cancel(lane, waiting.drop);
        const bool fits = waiting.put < 0 || queue::put(lane, waiting.put, waiting.time, waiting.value);
        return fits ? wanted : myriad::action::overflow;
    }

private:
    /// The one result of a function.
    template <class R, class States, class Inputs>
    static void read(const tape_function& f, const R& t, const States& y, const Inputs& p, R& result) {
        if (!f.empty()) run_tape<R>(f, function_source<R, States, Inputs>{t, y, p, &result});
    }
};

/// The models of MYRIAD_TAPE_KINDS.
namespace tape_models {
using in_packs = tape_model<false>;
using with_triggers = triggered_tape_model;
}  // namespace tape_models

/// The factors of a stiff method's matrix: as the kernel of a model that is compiled would have them.
template <class S>
class tape_factors {
    static constexpr extent n_state = tape_extent::state;
    static_assert(largest_dense_matrix == detail::largest_matrix_in_registers<double> &&
                  most_matrix_updates == detail::most_updates);
    using dense_factors = detail::lu_factors<S, n_state>;
    using R = real_of<S>;

public:
    tape_factors()
        : of_(current_tape->matrix), n_(current_tape->length.state), a_(static_cast<std::size_t>(of_.factor_entries)),
          sizes_(static_cast<std::size_t>(is_dense() ? 0 : n_)), dense_(1) {
        if (is_dense()) ::new (static_cast<void*>(dense_.data())) dense_factors;
    }
    tape_factors(const tape_factors&) = delete;
    tape_factors& operator=(const tape_factors&) = delete;
    ~tape_factors() {
        if (is_dense()) dense_[0].~dense_factors();
    }

    /// Factorises shift I - J. Returns false in lanes where that is singular.
    template <class Model>
    mask_of<S> factorise(const S& t, const S& shift, const vec<S, n_state>& y, const inputs<Model, S>& p) {
        return is_dense() ? factorise_dense<Model>(t, shift, y, p) : factorise_sparse<Model>(t, shift, y, p);
    }
    void solve(vec<S, n_state>& b) const {
        if (is_dense()) return detail::solve_factorised(dense_[0], b);
        for (int s = 0; s < n_; ++s) {
            const S x = b[of_.pivot[s]];
            for (int l = of_.lower_begin[s]; l < of_.lower_begin[s + 1]; ++l) {
                S& other = b[of_.lower_row[l]];
                other = fma(-a_[of_.lower_entry[l]], x, other);
            }
        }
        for (int s = n_ - 1; s >= 0; --s) {
            const int row = of_.pivot[s];
            S x = b[row];
            for (int u = of_.upper_begin[s]; u < of_.upper_begin[s + 1]; ++u)
                x = fma(-a_[of_.upper_entry[u]], b[of_.upper_column[u]], x);
            b[row] = x * a_[of_.diagonal[row]];
        }
    }

private:
    bool is_dense() const { return of_.factor_entries == 0; }

    template <class Model>
    mask_of<S> factorise_dense(const S& t, const S& shift, const vec<S, n_state>& y, const inputs<Model, S>& p) {
        auto& a = dense_[0].a;
        if (of_.entries == 0) {
            detail::dual_jacobian<Model>(t, y, p, a);
        } else {
            each_entry<Model>(t, y, p, [&](int e, const S& derivative) { a[of_.row[e]][of_.column[e]] = derivative; });
        }
        for (int i = 0; i < n_; ++i) {
            for (int j = 0; j < n_; ++j) a[i][j] = -a[i][j];
            a[i][i] = shift + a[i][i];
        }
        return detail::factorise(dense_[0]);
    }
    template <class Model>
    mask_of<S> factorise_sparse(const S& t, const S& shift, const vec<S, n_state>& y, const inputs<Model, S>& p) {
        for (int e = 0; e < of_.factor_entries; ++e) a_[e] = S(R(0));
        for (int i = 0; i < n_; ++i) {
            a_[of_.diagonal[i]] = shift;
            sizes_[i] = abs(shift);
        }
        each_entry<Model>(t, y, p, [&](int e, const S& derivative) {
            S& place = a_[of_.position[e]];
            place = place - derivative;
            const int row = of_.pivot_row[e];
            if (row >= 0) sizes_[row] = sizes_[row] + abs(derivative);
        });
        mask_of<S> regular = mask_of<S>(true);
        for (int s = 0; s < n_; ++s) {
            const int row = of_.pivot[s];
            S& pivot = a_[of_.diagonal[row]];
            const S size = abs(pivot), inverse = reciprocal(pivot);
            regular = regular & (size > S(detail::least_pivot<R>) * sizes_[row]) & (abs(inverse) > S(R(0)));
            pivot = inverse;
            for (int l = of_.lower_begin[s]; l < of_.lower_begin[s + 1]; ++l) {
                const S multiplier = a_[of_.lower_entry[l]] * inverse;
                a_[of_.lower_entry[l]] = multiplier;
                for (int u = of_.upper_begin[s]; u < of_.upper_begin[s + 1]; ++u) {
                    const int update = of_.first_update[l] + u, row_of_pivot = of_.target_row[update];
                    S& target = a_[of_.target[update]];
                    const S right = a_[of_.upper_entry[u]];
                    target = fma(-multiplier, right, target);
                    if (row_of_pivot >= 0)
                        sizes_[row_of_pivot] = fma(abs(multiplier), abs(right), sizes_[row_of_pivot]);
                }
            }
        }
        return regular;
    }
    /// Calls put(e, derivative) for the entries of the Jacobian: by the tape's function, or by dual numbers, one
    /// evaluation of the right-hand side for each group of columns.
    template <class Model, class Put>
    void each_entry(const S& t, const vec<S, n_state>& y, const inputs<Model, S>& p, Put&& put) {
        if (!current_tape->jacobian.empty()) {
            tape_array<S> found(static_cast<std::size_t>(of_.entries));
            Model::derivatives(t, y, p, found.data());
            for (int e = 0; e < of_.entries; ++e) put(e, found[e]);
            return;
        }
        for (int g = 0; g < of_.groups; ++g) {
            auto seeded = detail::constants<dual<S>>(y);
            for (int j = 0; j < n_; ++j) seeded[j].derivative = S(of_.group_of_column[j] == g ? R(1) : R(0));
            const auto columns = detail::directional_derivative<Model>(dual<S>(t), seeded, p);
            for (int k = of_.begin[g]; k < of_.begin[g + 1]; ++k)
                put(of_.in_group[k], columns[of_.row[of_.in_group[k]]]);
        }
    }

    const tape_matrix& of_;
    int n_;
    tape_array<S> a_, sizes_;  // of each pivot's row: the sum of the sizes of the terms that add up to the pivot
    tape_array<dense_factors> dense_;
};

}  // namespace myriad::python

namespace myriad::detail {

template <class Model, class S>
requires(python::is_name<n_state<Model>>) struct stage_factors_of<Model, S> {
    using type = python::tape_factors<S>;
};

/// The arguments of an interpreter, whose arrays stay where they are.
template <class Model, class R>
requires(python::is_name<n_state<Model>>) struct argument_arrays<Model, R> {
    static constexpr int words = python::tape_events / 32 + 1;
    const R *relative_tolerance, *absolute_tolerance;
    const event_arguments<R>* event;
    std::uint32_t rising[words]{}, falling[words]{};
    const std::int16_t *state_column, *accessory_column, *integer_accessory_column, *sample_column;

    void point_to(const any_arguments<R>& from) {
        const argument_offsets<R> at = from.offsets();
        const auto take = [&](auto*& array, int offset) {
            array = reinterpret_cast<std::remove_reference_t<decltype(array)>>(from.arrays + offset);
        };
        take(relative_tolerance, at.relative_tolerance);
        take(absolute_tolerance, at.absolute_tolerance);
        take(event, at.event);
        take(state_column, at.state_column);
        take(accessory_column, at.accessory_column);
        take(integer_accessory_column, at.integer_accessory_column);
        take(sample_column, at.sample_column);
        const std::uint32_t *of_rising, *of_falling;
        take(of_rising, at.rising);
        take(of_falling, at.falling);
        for (int k = 0; k <= from.model->n_event / 32; ++k) rising[k] = of_rising[k], falling[k] = of_falling[k];
    }
};

}  // namespace myriad::detail
