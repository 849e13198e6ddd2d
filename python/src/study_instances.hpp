// SPDX-License-Identifier: MIT
// The instances of a study in an ensemble of a model that is known only at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "myriad/host/threads/parallel.hpp"
#include "myriad/study/chunk_solver.hpp"
#include "run.hpp"

namespace myriad::python {

using studies::component_kind;

/// A model out of a library, and what the study does not set: the components that an interpreter has besides.
struct study_kernel {
    study_kernel(const library& with, component_names its_names)
        : kernel(&with), names(std::move(its_names)), shape(with.facts(), names) {}

    /// Options with values for the states and events that an interpreter has besides.
    options fitted(options o) const {
        for (per_component* const tolerances : {&o.relative_tolerance, &o.absolute_tolerance}) {
            if (tolerances->size() == 1) continue;  // for all states
            std::vector<double> all(static_cast<std::size_t>(shape.n_state), 1);
            for (std::size_t c = 0; c < tolerances->size(); ++c) all.at(c) = (*tolerances)[c];
            *tolerances = std::move(all);
        }
        o.events.resize(static_cast<std::size_t>(shape.n_event));
        return o;
    }

    const library* kernel;
    component_names names;
    named_shape shape;
};

/// A model of a study, and the values of its tables, which are its last shared parameters.
struct model_of_study {
    component_names names;
    std::vector<double> tables;
    std::string generator = {};  ///< what its `generate` does; empty for a model that has none
};

template <class R>
class study_instances final : public studies::model_instances<R> {
public:
    study_instances(const model_of_study& model, const study_kernel& kernel, std::int64_t size)
        : model_(model), kernel_(kernel), instances_(kernel.kernel->facts(), kernel.names, size) {}

    host::ensemble_data<R>& data() override { return instances_.data; }
    void restart() override {
        instances_.samples.clear();
        instances_.data.restart();
    }
    ensemble<R>& all() { return instances_; }
    /// Sets what is no one's to set, and lets the model set the rest, if its kernel is a CPU's.
    void generate(std::int64_t, std::uint64_t seed) override {
        auto& d = instances_.data;
        const auto clear = [](auto& array, const std::vector<std::string>& used) {
            for (int c = static_cast<int>(used.size()); c < array.components(); ++c) array.fill_component(c, R(0));
        };
        clear(d.state, model_.names.states);
        clear(d.parameter, model_.names.parameters);
        clear(d.accessory, model_.names.accessories);
        const std::size_t first = model_.names.shared.size() - model_.tables.size();
        for (std::size_t i = 0; i < model_.tables.size(); ++i)
            d.shared.data()[first + i] = static_cast<R>(model_.tables[i]);
        if (!model_.generator.empty() && kernel_.kernel->gpu() == nullptr) call_generate(seed);
    }
    report_of<R> solve(const device& where, const options& o) override {
        made_ = python::solve<R>({{kernel_.kernel, where}}, instances_, kernel_.fitted(o), results_are::on_host);
        return *made_;
    }
    const R* recorded(component_kind kind, int number) const override {
        const auto& r = made_->records;
        return r.values.component(kind == component_kind::state ? r.find(r.state, number, "state")
                                                                : r.find(r.accessory, number, "accessory"));
    }
    const std::int32_t* recorded_integers(int number) const override {
        const auto& r = made_->records;
        return r.integers.component(r.find(r.integer_accessory, number, "integer accessory"));
    }
    const R* record_times() const override { return made_->records.values.component(made_->records.time); }
    const R* sampled(int number) const override { return instances_.samples.component(number); }
    const R* sample_times() const override { return instances_.samples.time.data(); }
    const std::int32_t* samples_stored() const override { return instances_.samples.stored.data(); }

private:
    void call_generate(std::uint64_t seed) {
        require(kernel_.kernel->cpu().generate != nullptr,
                "the model's struct has no generate to set instances: it must be `MYRIAD_FUNCTION static void "
                "generate(auto& instance)`, and public");
        auto& d = instances_.data;
        any_arguments<R> arguments{};
        arguments.size = d.size;
        arguments.first_index = d.first_index;
        arguments.state = d.state.data();
        arguments.parameter = d.parameter.data();
        arguments.accessory = d.accessory.data();
        arguments.integer_accessory = d.integer_accessory.data();
        arguments.shared = {d.shared.data(), d.shared_integer.data()};
        host::in_parallel(d.size, 4096, [&, &kernel = *kernel_.kernel](std::int64_t begin, std::int64_t end) {
            current_tape = kernel.model();
            kernel.cpu().generate(&arguments, seed, begin, end);
        });
    }

    const model_of_study& model_;
    const study_kernel& kernel_;
    ensemble<R> instances_;
    std::unique_ptr<report<R>> made_;
};

}  // namespace myriad::python
