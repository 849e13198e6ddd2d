// SPDX-License-Identifier: MIT
// The study of a model: the only part that is compiled for each model and method. Host code only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/core/declarations.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/host/options/option_checks.hpp"
#include "myriad/host/report/notes.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/solve/prepared_arguments.hpp"
#include "myriad/host/solve/solve.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/study/generator.hpp"
#include "myriad/study/chunk_solver.hpp"
#include "myriad/study/component_names.hpp"
#include "myriad/study/study.hpp"

namespace myriad {

namespace studies::inline MYRIAD_ABI {

template <template <class> class numbering, class Model>
void add_components(std::vector<component>& all, component_kind kind) {
    for (int c = 0; c < numbering<Model>::count; ++c)
        all.push_back({kind, c, std::string(numbering<Model>::label(c).enumerator)});
}
template <class Model>
component_names names_of_components() {
    std::vector<component> all;
    add_components<host::state_numbering, Model>(all, component_kind::state);
    add_components<host::parameter_numbering, Model>(all, component_kind::parameter);
    add_components<host::accessory_numbering, Model>(all, component_kind::accessory);
    add_components<host::integer_accessory_numbering, Model>(all, component_kind::integer_accessory);
    add_components<host::shared_numbering, Model>(all, component_kind::shared);
    add_components<host::shared_integer_numbering, Model>(all, component_kind::shared_integer);
    return {std::string(host::enumeration_name<Model>()), std::move(all)};
}

/// What sets instances after the axes: a function of the user's, where `first` is the number of the first one, or the
/// model's own.
template <class Model, class R>
struct generator {
    std::string name;
    std::function<void(std::int64_t first, ensemble<Model, R>& instances)> function = {};
    bool calls_model = false;
};

/// Calls the model's `generate` for all instances, in parallel. Rethrows what it throws.
template <class Model, class R>
void call_generate(host::ensemble_data<R>& data, std::uint64_t seed) {
    if constexpr (detail::generates<Model, R>) {
        detail::instance_arrays<detail::array_pointer, R> arrays{};
        arrays.state = data.state.data();
        arrays.parameter = data.parameter.data();
        arrays.accessory = data.accessory.data();
        arrays.integer_accessory = data.integer_accessory.data();
        const detail::instance_range range{data.size, data.first_index};
        const detail::shared_parameters<R> shared{data.shared.data(), data.shared_integer.data()};
        std::mutex mutex;
        std::exception_ptr failure;
        host::in_parallel(data.size, 4096, [&](std::int64_t begin, std::int64_t end) {
            try {
                for (std::int64_t i = begin; i < end; ++i)
                    detail::generate_instance<Model, R>(arrays, range, shared, seed, i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                failure = std::current_exception();
            }
        });
        if (failure) std::rethrow_exception(failure);
    }
}

template <class Model, class Method, class R>
class instances_of final : public model_instances<R> {
public:
    instances_of(std::int64_t size, std::shared_ptr<const generator<Model, R>> generate)
        : instances_(size), generate_(std::move(generate)) {}

    host::ensemble_data<R>& data() override { return host::ensemble_access::data(instances_); }
    void restart() override { instances_.restart(); }
    void generate(std::int64_t first, std::uint64_t seed) override {
        if (generate_->function) generate_->function(first, instances_);
        if (generate_->calls_model) call_generate<Model, R>(data(), seed);
    }
    ensemble<Model, R>& all() { return instances_; }
    report_of<R> solve(const device& where, const options& o) override {
        report<Model, R> made = myriad::solve<Method>(where, instances_, o);
        records_ = std::move(made.records);
        return made;
    }
    const R* recorded(component_kind kind, int number) const override {
        return kind == component_kind::state ? records_.state(number).data() : records_.accessory(number).data();
    }
    const std::int32_t* recorded_integers(int number) const override {
        return records_.integer_accessory(number).data();
    }
    const R* record_times() const override { return records_.time().data(); }
    const R* sampled(int number) const override { return instances_.samples().state(number).data(); }
    const R* sample_times() const override { return instances_.samples().time().data(); }
    const std::int32_t* samples_stored() const override { return instances_.samples().stored().data(); }

private:
    ensemble<Model, R> instances_;
    phase_records<Model, R> records_;
    std::shared_ptr<const generator<Model, R>> generate_;
};

template <class Model, class Method, class R>
class instances_on_device final : public device_instances<R> {
public:
    instances_on_device(std::int64_t few, const device& where, const study_plan& plan,
                        std::shared_ptr<const studies::generator<Model, R>> generate)
        : options_(plan.asked.options), few_(few, std::move(generate)),
          prepared_(with_domains(few_, plan.asked.axes), options_, host::traits_of<Method>),
          how_{where.number(), options_.block_size, options_.shared_placement, options_.schedule} {
        const auto make = host::require_kernel<Model, Method, R>(where).make_engine;
        kind_ = reinterpret_cast<host::engine_key>(make);
        auto idle = host::take_idle_engine(kind_, how_);
        engine_ = idle != nullptr ? std::move(idle) : make(how_);
        const auto& a = arguments_;
        const auto numbers = [](const std::int16_t* columns, int count) {
            return std::vector<int>(columns, columns + count);
        };
        results_ = {.records = a.record.values,
                    .record_integers = a.record.integers,
                    .samples = a.sample.values,
                    .sample_times = a.sample.time,
                    .samples_stored = a.sample.stored,
                    .states = numbers(a.record.state_column, detail::n_state<Model>),
                    .accessories = numbers(a.record.accessory_column, detail::n_accessory<Model>),
                    .integers = numbers(a.record.integer_accessory_column, detail::n_integer_accessory<Model>),
                    .sampled = numbers(a.sample.column, detail::n_state<Model>),
                    .time = a.record.time_column};
    }
    ~instances_on_device() override {
        if (fine_) host::give_idle_engine(kind_, how_, std::move(engine_));
    }

    model_instances<R>& looked_at() override { return few_; }
    const detail::instance_arrays<detail::array_pointer, R>& arrays() const override { return arguments_; }
    const result_arrays& results() const override { return results_; }
    void check(std::int64_t count) override {
        const detail::default_arithmetic here;
        before_ = host::check_uses<Method>(few_.all(), options_, count);
        host::find_phases_left(few_.all(), options_, count).require_for(0, options_.phases);
        host::input_check<Model, R>(few_.all(), options_, count).run();
    }
    std::vector<std::string> notes(std::int64_t count) override {
        const detail::default_arithmetic here;
        use([&](auto& e) { e.fetch_first(arguments_, count); });
        host::ensemble_access::touch(few_.all());
        report<Model, R> found;
        if (options_.counting == counting::on)
            host::set_work(found, host::work_count{}, host::counted_work(few_.data(), count));
        host::note_tolerances<Method>(found, options_);
        host::note_event_tolerances(found, few_.all(), options_, before_, count);
        host::note_stiffness<Method>(found, few_.all(), options_);
        host::note_exponents<Method>(found, few_.all(), options_);
        return found.notes;
    }
    std::int64_t affordable() override {
        std::int64_t bytes = 64;  // for what is drawn again, gathered and scheduled
        const auto add = [&](auto* array, std::int64_t components, auto...) {
            bytes += components * static_cast<std::int64_t>(sizeof(*array));
        };
        auto arguments = arguments_;  // a copy
        detail::for_each_array(arguments, add);
        detail::for_each_record(arguments, add);
        return engine_->affordable(2 * bytes);
    }
    void generate(const std::shared_ptr<const cuda::generation>& how, std::int64_t first, std::int64_t count) override {
        use([&](auto& e) { e.generate(arguments_, how, first, count); });
    }
    void integrate() override {
        use([&](auto& e) {
            e.integrate(arguments_);
            e.wait();
        });
    }
    void fetch(const cuda::device_values& what, std::byte* to) override {
        use([&](auto& e) { e.fetch(arguments_, what, to); });
    }
    std::vector<std::int64_t> reduce(const cuda::device_values& what, const cuda::device_reduction& how) override {
        std::vector<std::int64_t> found;
        use([&](auto& e) { found = e.reduce(arguments_, what, how); });
        return found;
    }

private:
    /// The instances, with the arrays that a call needs.
    static ensemble<Model, R>& with_domains(instances_of<Model, Method, R>& few, const axes& all) {
        set_instances<R>(few, all, 0);
        return few.all();
    }
    /// An engine that has failed is not used again.
    template <class Work>
    void use(Work&& work) {
        const bool before = std::exchange(fine_, false);
        work(static_cast<cuda::engine<Model, R>&>(*engine_));
        fine_ = before;
    }

    const options& options_;
    instances_of<Model, Method, R> few_;
    host::prepared_arguments<Model, R> prepared_;
    detail::kernel_arguments<Model, R>& arguments_ = prepared_.get();
    cuda::engine_options how_;
    host::engine_key kind_ = nullptr;
    std::unique_ptr<cuda::any_engine> engine_;
    result_arrays results_;
    host::functions_within_tolerance<Model> before_;
    bool fine_ = true;
};

template <class Model, class Method, class R>
class model_of final : public any_model {
public:
    const component_names& names() const override { return names_; }
    std::string method() const override { return std::string(host::enumeration_name<Method>()); }
    element real() const override { return element_of<R>; }
    void check(const device& where, const options& o) const override {
        host::check_options<Model, Method, R>(o);
        host::require_kernel<Model, Method, R>(where);
    }
    double bytes_per_instance(const options& o) const override {
        host::memory_need need = host::ensemble_data<R>::memory_of(host::shape_of<Model>, 1);
        host::add_memory_of_call<Model, R>(need, 1, nullptr, o, host::traits_of<Method>);
        return need.bytes();
    }
    std::unique_ptr<chunk_solver> make_solver(const study_plan& plan) const override {
        return std::make_unique<chunk_solver_of<R>>(plan, [generate = generate_](std::int64_t size) {
            return std::make_unique<instances_of<Model, Method, R>>(size, generate);
        });
    }
    std::unique_ptr<chunk_solver> make_device_solver(const study_plan& plan, const device& where) const override {
        const bool endless = host::may_end_early<Model, R>(plan.asked.options);
        if (where.which() == device::kind::cpu || generate_->function || !can_be_on_device(plan.asked, endless))
            return nullptr;
        return std::make_unique<device_solver_of<R>>(
            plan, generate_->calls_model, [&plan, where, generate = generate_](std::int64_t few) {
                return std::make_unique<instances_on_device<Model, Method, R>>(few, where, plan, generate);
            });
    }
    std::string generator() const override { return generate_->name; }
    bool generates_itself() const override { return generate_->calls_model; }

    void set_generator(studies::generator<Model, R> generate) {
        generate_ = std::make_shared<const studies::generator<Model, R>>(std::move(generate));
    }

private:
    component_names names_ = names_of_components<Model>();
    std::shared_ptr<const studies::generator<Model, R>> generate_ =
        std::make_shared<const studies::generator<Model, R>>();
};

}  // namespace studies::inline MYRIAD_ABI

/// The study of a model by a method, with real type R: all that it can do is in `any_study`, but for instances that a
/// function generates.
///
///     myriad::study<duffing, myriad::cash_karp> sweep;
///     sweep.axis("k", myriad::linspace(0.2, 0.3, 46'080));
///     sweep.set("B", 0.3);
///     sweep.set("x", -0.5);
///     sweep.set("v", -0.1);
///     sweep.time_domain(0, 2 * std::numbers::pi);
///     sweep.keep.end = {"x"};
///     const std::vector<double> x = sweep.run().values("x_end");
template <class Model, class Method, class R = double>
class study : public any_study {
public:
    study() : study(std::make_shared<studies::model_of<Model, Method, R>>()) {}

    /// Instances are set by a function, too, after the axes, which it sees and may change: all of `instances`, which
    /// are a part of the study and begin with its instance `first`. What it sets must depend on the number of an
    /// instance alone; it is called by several threads at a time, for different parts. How many instances there are,
    /// axes say, or `repeat`. `name` stands for the function in the study's description: give another one when it
    /// changes.
    void generate(std::string name, std::function<void(std::int64_t first, ensemble<Model, R>& instances)> function) {
        require(!name.empty() && function != nullptr,
                "a generator needs a name, which changes with it, and a function");
        model_->set_generator({std::move(name), std::move(function)});
    }
    /// Instances are set by the model, too, after the axes: by its function `generate`, where they are integrated, so
    /// that nothing of each instance is copied to a GPU. `name` stands for that function: give another one when it
    /// changes.
    ///
    ///     MYRIAD_FUNCTION static void generate(auto& instance) {  // see generated_instance
    ///         instance.y[x] = instance.random.normal(0, 0.1);
    ///     }
    void generate(std::string name) {
        static_assert(detail::generates<Model, R>,
                      "the model has no generate to set instances: it must be `MYRIAD_FUNCTION static void "
                      "generate(auto& instance)`, and public");
        require(!name.empty(), "a generator needs a name, which changes with it");
        model_->set_generator({.name = std::move(name), .calls_model = true});
    }

private:
    explicit study(std::shared_ptr<studies::model_of<Model, Method, R>> model)
        : any_study(model), model_(std::move(model)) {}

    std::shared_ptr<studies::model_of<Model, Method, R>> model_;
};

}  // namespace myriad
