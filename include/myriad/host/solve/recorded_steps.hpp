// SPDX-License-Identifier: MIT
// The recorded steps of a group of instances, and the adjoint of them, for any model. Compiled in the library. Host
// code only.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <vector>

#include "myriad/host/backend/cpu_adjoint.hpp"
#include "myriad/host/backend/cpu_kernel.hpp"
#include "myriad/host/core/weak.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/ensemble/sample_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The adjoint of a model and a method, compiled for some instruction set.
using cpu_adjoint = std::function<detail::run_statistics(const detail::adjoint_call&, const detail::run_options&)>;

template <openmp::instruction_set set, class Model, class Method>
auto adjoint_for_set() -> detail::run_statistics (*)(const detail::adjoint_call&, const detail::run_options&) {
    using tag = openmp::for_set<set>;
    detail::run_statistics (*const compiled)(tag, const detail::adjoint_call&, const detail::run_options&) =
        &openmp::adjoint_on<Model, Method>;
    if (if_defined(compiled) == nullptr) return nullptr;
    return [](const detail::adjoint_call& call, const detail::run_options& o) {
        return openmp::adjoint_on<Model, Method>(tag{}, call, o);
    };
}
/// The adjoint that fits the CPU; without a function if there is none.
template <class Model, class Method>
cpu_adjoint adjoint_for() {
    using openmp::instruction_set;
    const std::array compiled{adjoint_for_set<instruction_set::avx512, Model, Method>(),
                              adjoint_for_set<instruction_set::avx2, Model, Method>(),
                              adjoint_for_set<instruction_set::sse2, Model, Method>(),
                              adjoint_for_set<instruction_set::generic, Model, Method>()};
    compiled_sets sets{};
    bool any = false;
    for (std::size_t s = 0; s < sets.size(); ++s) any |= sets[s] = compiled[s] != nullptr;
    if (!any) return {};
    return compiled[static_cast<std::size_t>(choose_instruction_set(sets))];
}

/// Throws `error` if an adjoint cannot have such times and options, or if the ensemble has been integrated.
void check_adjoint_call(const ensemble_data<double>& e, const std::vector<double>& times, const options& o);

/// Copies states, parameters, shared values and time domains of the instances from `first` on, as many as `to` has.
void copy_inputs(const ensemble_data<double>& from, std::int64_t first, ensemble_data<double>& to);

/// All steps of a group of instances.
class recorded_steps {
public:
    explicit recorded_steps(int n_state) : n_state_(n_state) {}

    /// How many instances a group may have: those whose records take 8 MiB for each thread, about what its part of the
    /// caches holds.
    std::int64_t most_instances() const;
    /// The options of an integration that keeps its steps.
    options options_for(const options& o) const;
    /// Takes what was integrated, which has to live on. Returns false if there were more steps than room; there is more
    /// room from now on.
    bool keep(const ensemble_data<double>& group, const sample_data<double>& samples, int threads);
    /// Computes the states at the times, or at the end if there are none, in `values`; or, if that is null, the
    /// gradients that follow from `weights`. Throws `error`, and what functions of the model throw.
    void run(const cpu_adjoint& adjoint, const std::vector<double>& times, double* values, const double* weights,
             double* gradient) const;

private:
    int n_state_, threads_ = 1;
    std::int64_t room_ = 256;  // records of an instance
    const ensemble_data<double>* group_ = nullptr;
    const sample_data<double>* samples_ = nullptr;
};

}  // namespace myriad::host::inline MYRIAD_ABI
