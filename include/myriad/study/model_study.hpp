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

#include "myriad/host/checks/behaviour.hpp"
#include "myriad/host/core/declarations.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/host/solve/solve.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/study/generator.hpp"
#include "myriad/study/plan/component_names.hpp"
#include "myriad/study/run/studied_model.hpp"
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
#define MYRIAD_ADD_COMPONENTS(kind, ...) add_components<host::kind##_numbering, Model>(all, component_kind::kind);
    MYRIAD_INSTANCE_KINDS(MYRIAD_ADD_COMPONENTS)
    MYRIAD_SHARED_KINDS(MYRIAD_ADD_COMPONENTS)
#undef MYRIAD_ADD_COMPONENTS
    return {std::string(host::enumeration_name<Model>()), std::move(all)};
}

/// The compiler of a program, which has compiled its models, too.
#if defined(__clang__)
inline constexpr const char* compiler_name = __VERSION__;
#else
inline constexpr const char* compiler_name = "g++ " __VERSION__;
#endif

/// What sets instances after the axes: a function of the user's, where `first` is the number of the first one, or the
/// model's own.
template <class Model, class R>
struct generator {
    std::string name;
    std::function<void(std::int64_t first, ensemble<Model, R>& instances)> function = {};
    bool calls_model = false;
};

template <class Model, class Method, class R>
class model_of final : public studied_model<R> {
public:
    const component_names& names() const override { return names_; }
    std::string method() const override { return std::string(host::enumeration_name<Method>()); }
    double bytes_per_instance(const options& o) const override {
        return host::called<Model, Method, R>().bytes_per_instance(o);
    }
    std::string generator() const override { return generate_.name; }
    bool generates_itself() const override { return generate_.calls_model; }

    host::called_model<R> called_for(const device& where, const options& o) const override {
        return host::called_for<Model, Method, R>({where}, o);
    }
    std::unique_ptr<instance_memory<R>> allocate(const device&, std::int64_t size) const override {
        return std::make_unique<memory>(size);
    }
    detail::behaviour_function<R> behaviour_for(const device&) const override {
        return &detail::show_behaviour<Model, R>;
    }
    std::string compiler_for(const device&) const override { return compiler_name; }
    void set_others(instance_memory<R>& instances, std::int64_t first) const override {
        if (sets_others()) generate_.function(first, static_cast<memory&>(instances).all);
    }
    bool sets_others() const override { return generate_.function != nullptr; }

    void set_generator(studies::generator<Model, R> generate) { generate_ = std::move(generate); }

private:
    struct memory final : instance_memory<R> {
        explicit memory(std::int64_t size) : all(size) {}
        host::ensemble_data<R>& data() override { return host::ensemble_access::data(all); }
        host::sample_data<R>& samples() override { return host::ensemble_access::samples(all); }
        ensemble<Model, R> all;
    };

    component_names names_ = names_of_components<Model>();
    studies::generator<Model, R> generate_;
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
