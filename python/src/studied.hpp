// SPDX-License-Identifier: MIT
// Models of studies that are known only at run time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "myriad/study/run/studied_model.hpp"
#include "run.hpp"

namespace myriad::python {

using studies::component_kind;

/// A model of a study, and the values of its tables, which are its last shared parameters.
struct model_of_study {
    component_names names;
    std::vector<double> tables;
    std::string generator = {};  ///< what its `generate` does; empty for a model that has none
};

/// A model out of a library.
struct study_kernel {
    study_kernel(const device& on, const library& with, component_names names)
        : where(on), kernel(&with), shape(with.facts().model, std::move(names)) {}

    device where;
    const library* kernel;
    named_shape shape;
};

/// A model with a kernel for each device that a run uses.
class study_model {
public:
    virtual ~study_model() = default;
    /// Kernels that are used already stay as they are.
    void add_kernel(const device& where, const library& kernel, component_names names) {
        kernels_.try_emplace(place_of(where), where, kernel, std::move(names));
    }

protected:
    using place = std::pair<device::kind, int>;
    static place place_of(const device& where) { return {where.which(), where.number()}; }
    const study_kernel& kernel_for(const device& where) const {
        const auto found = kernels_.find(place_of(where));
        require(found != kernels_.end(), "the study has no kernel for ", where.name());
        return found->second;
    }

    std::map<place, study_kernel> kernels_;
};

template <class R>
class study_model_of final : public studies::studied_model<R>, public study_model {
public:
    study_model_of(model_of_study model, studies::component_names names, std::string method)
        : model_(std::move(model)), names_(std::move(names)), method_(std::move(method)) {}

    const studies::component_names& names() const override { return names_; }
    std::string method() const override { return method_; }
    double bytes_per_instance(const options& o) const override {
        double most = 0;
        for (const auto& [place, k] : kernels_) {
            most = std::max(most, called_for(k.where, o).bytes_per_instance(o));
        }
        return most;
    }
    std::string generator() const override { return model_.generator; }
    bool generates_itself() const override { return !model_.generator.empty(); }

    host::called_model<R> called_for(const device& where, const options& o) const override {
        const study_kernel& k = kernel_for(where);
        return python::called_for<R>(*k.kernel, k.shape, where, o);
    }
    std::unique_ptr<studies::instance_memory<R>> allocate(const device& where, std::int64_t size) const override {
        return std::make_unique<memory>(kernel_for(where), size);
    }
    detail::behaviour_function<R> behaviour_for(const device& where) const override {
        if (where.which() != device::kind::cpu) return nullptr;
        return *static_cast<const detail::behaviour_function<R>*>(kernel_for(where).kernel->cpu().behaviour);
    }
    std::string compiler_for(const device& where) const override {
        return where.which() == device::kind::cpu ? kernel_for(where).kernel->cpu().compiler : "";
    }
    /// Sets tables.
    void set_others(studies::instance_memory<R>& instances, std::int64_t) const override {
        auto& d = instances.data();
        const std::size_t first = model_.names.shared.size() - model_.tables.size();
        for (std::size_t i = 0; i < model_.tables.size(); ++i)
            d.shared.data()[first + i] = static_cast<R>(model_.tables[i]);
    }

private:
    struct memory final : studies::instance_memory<R> {
        memory(const study_kernel& k, std::int64_t size) : all(k.kernel->facts().model, k.shape.names, size) {}
        host::ensemble_data<R>& data() override { return all.data; }
        host::sample_data<R>& samples() override { return all.samples; }
        ensemble<R> all;
    };

    model_of_study model_;
    studies::component_names names_;
    std::string method_;
};

}  // namespace myriad::python
