// SPDX-License-Identifier: MIT
// The study of a model: with its instances the only part that is compiled for each model and method. Host code only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/backend/cpu_kernel.hpp"
#include "myriad/host/core/declarations.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/host/options/option_checks.hpp"
#include "myriad/host/solve/prepared_arguments.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/study/generator.hpp"
#include "myriad/study/chunk_solver.hpp"
#include "myriad/study/component_names.hpp"
#include "myriad/study/instances_on_device.hpp"
#include "myriad/study/instances_on_host.hpp"
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

/// The compiler of a program, which is that of its models.
#if defined(__clang__)
inline constexpr const char* compiler_name = __VERSION__;
#else
inline constexpr const char* compiler_name = "g++ " __VERSION__;
#endif

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
    std::unique_ptr<chunk_solver> make_solver(const study_plan& plan, const device&) const override {
        return std::make_unique<chunk_solver_of<R>>(plan, [generate = generate_](std::int64_t size) {
            return std::make_unique<instances_on_host<Model, Method, R>>(size, generate);
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
    arithmetic arithmetic_on(const device& where) const override {
        if (where.which() != device::kind::cpu) return arithmetic::of_kernel("", compiler_name);
        return arithmetic::of_kernel(host::name_of(host::choose_cpu_kernel<Model, Method, R>().set), compiler_name);
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
