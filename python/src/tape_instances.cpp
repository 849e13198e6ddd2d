// SPDX-License-Identifier: MIT
// What checks and notes call of a traced model for single instances, by its tape: of models with any number of
// components, whatever kernel integrates them.
// clang-format off
#include "tape_model.hpp"  // before the kernel body
// clang-format on

#include "tape_instances.hpp"

#include <memory>

#include "myriad/host/checks/event_resolution.hpp"
#include "myriad/host/checks/instance_inputs.hpp"

namespace myriad::python {

namespace {

/// The components of a kind in one instance.
template <class T>
struct components_of_instance {
    const T* values;
    std::int64_t size, instance;

    T operator[](int c) const { return values[c * size + instance]; }
};
/// The inputs of rhs and events, in the arrays of an ensemble.
template <class R>
struct inputs_of_instance {
    inputs_of_instance(const detail::argument_head<R>& a, std::int64_t i)
        : parameter{a.parameter, a.size, i}, accessory{a.accessory, a.size, i}, integer_accessory{a.integer_accessory,
                                                                                                  a.size, i},
          shared(a.shared.real), shared_integer(a.shared.integer) {}

    components_of_instance<R> parameter, accessory;
    components_of_instance<std::int32_t> integer_accessory;
    const R* shared;
    const std::int32_t* shared_integer;
};

template <class S, class R>
void evaluate(const tape_function& f, const S& t, const S* y, const inputs_of_instance<R>& p, S* results) {
    run_tape<S>(f, function_source<S, const S*, inputs_of_instance<R>>{t, y, p, results});
}

/// How many results a function has.
int results_of(const tape_function& f) {
    int count = 0;
    for (const tape_step* step = f.begin; step != f.end; ++step) count += step->code == tape_code::store_result;
    return count;
}

template <class T>
std::unique_ptr<T[]> zeros(int count) {
    return std::unique_ptr<T[]>(new T[static_cast<std::size_t>(count)]());
}

template <class R>
void write_resolution(const detail::argument_head<R>& a, std::int64_t i, R* finest) {
    const tape_function& events = current_tape->events;
    const int n = results_of(current_tape->rhs), m = results_of(events);
    const auto y = zeros<dual<R>>(n), g = zeros<dual<R>>(m);
    const auto origin = zeros<R>(n), g0 = zeros<R>(m);
    for (int c = 0; c < n; ++c)
        y[static_cast<std::size_t>(c)] = dual<R>(a.state[c * a.size + i], a.state[c * a.size + i]);
    const R t = detail::begin_of(a, i);
    const inputs_of_instance<R> p(a, i);
    evaluate(events, dual<R>(t, t), y.get(), p, g.get());
    evaluate(events, R(0), origin.get(), p, g0.get());
    for (int j = 0; j < m; ++j)
        finest[j] = host::event_resolution(g[static_cast<std::size_t>(j)], g0[static_cast<std::size_t>(j)]);
}

template <class R>
void linearise(const detail::argument_head<R>& a, std::int64_t i, R t, const R* state, R* slopes, R* jacobian) {
    const int n = results_of(current_tape->rhs);
    const inputs_of_instance<R> p(a, i);
    evaluate(current_tape->rhs, t, state, p, slopes);
    const auto y = zeros<dual<R>>(n), f = zeros<dual<R>>(n);
    for (int j = 0; j < n; ++j) {
        for (int c = 0; c < n; ++c) y[static_cast<std::size_t>(c)] = dual<R>(state[c], R(c == j ? 1 : 0));
        evaluate(current_tape->rhs, dual<R>(t), y.get(), p, f.get());
        for (int c = 0; c < n; ++c) jacobian[c * n + j] = f[static_cast<std::size_t>(c)].derivative;
    }
}

template <class Model, class R>
void generate(const detail::argument_head<R>& a, std::uint64_t seed, std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) detail::generate_instance<Model, R>(a, a, a.shared, seed, i);
}
template <class Model, class R>
constexpr detail::instance_functions<R> functions_of_model{.generate = &generate<Model, R>};
template <class Model, class R>
constexpr detail::behaviour_function<R> behaviour_of_model = &detail::show_behaviour<Model, R>;

template <class Model>
constexpr called_instances instances_of{&functions_of_model<Model, double>, &behaviour_of_model<Model, double>};

}  // namespace

called_instances instances_of_tape(const tape& model) {
    if (model.length.delayed > 0) return instances_of<tape_models::with_delays>;
    if (model.length.stop > 0 || model.length.trigger > 0) return instances_of<tape_models::with_triggers>;
    return instances_of<tape_models::in_packs>;
}

template <class R>
detail::instance_functions<R> functions_of_tape(const tape& model, double (*stability_limit)()) {
    detail::instance_functions<R> all;
    if (model.length.delayed > 0) return all;  // they know no past
    if (stability_limit != nullptr) {
        all.rhs = [](const detail::argument_head<R>& a, std::int64_t i, R t, const R* y, R* slopes) {
            evaluate(current_tape->rhs, t, y, inputs_of_instance<R>(a, i), slopes);
        };
        all.stability_limit = stability_limit;
    }
    all.linearise = &linearise<R>;
    // not before `initialise`
    if (!model.events.empty() && model.initialise.empty()) all.event_resolution = &write_resolution<R>;
    return all;
}
template detail::instance_functions<double> functions_of_tape(const tape&, double (*)());
template detail::instance_functions<float> functions_of_tape(const tape&, double (*)());

}  // namespace myriad::python
