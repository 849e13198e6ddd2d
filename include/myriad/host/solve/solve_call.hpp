// SPDX-License-Identifier: MIT
// One call of `solve`, for any model, whether it is known when a program is compiled or only when it runs: the checks,
// the integration and the notes, in their order. Compiled in the library. Host code only.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "myriad/host/backend/cpu_kernel.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/checks/instance_functions.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/chunks/results_on_gpu.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/ensemble/sample_data.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/options/option_checks.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/host/solve/prepared_call.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/model_facts.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// A model and a method, as far as calls have to know them, and what integrates them.
template <class R>
struct called_model {
    const model_shape* shape;
    const model_components* components;
    call_facts facts;
    instance_functions<R> functions;
    cpu_kernel<R> on_cpu = {};                   ///< of a call on the CPU; without a function if there is none
    std::vector<engine_source<R>> on_gpus = {};  ///< of a call on GPUs, for each of them
    /// Called in threads before they call the functions, if it is not empty.
    std::function<void()> enter_thread = {};

    /// Whether something can end a phase before t_end.
    bool may_end_early(const options& o) const {
        return shape->writes_time_domain || facts.hooks_may_stop || events_may_stop(o);
    }
    /// Throws `error` if an option is invalid.
    void check_options(const options& o) const;
    /// Throws `error` if the program has no kernel for devices of that kind, or may not use them.
    void check_kernel(device::kind which) const;
    /// Bytes of memory that an instance and a call for it take.
    double bytes_per_instance(const options& o) const;
    /// Checks the options against the first `count` instances: sample times, event tolerances, Jacobians. Throws
    /// `error`. Returns how many phases are left to them.
    phases_left check_uses(ensemble_data<R>& data, const options& o, std::int64_t count) const;
    /// The check of their values.
    data_check<R> values_of(ensemble_data<R>& data, const options& o, std::int64_t count) const {
        return {data, o, count, may_end_early(o)};
    }
    /// Adds the notes of a call with these arguments, whose results are in the ensemble.
    void add_notes(report_of<R>& result, ensemble_data<R>& data, const options& o,
                   const argument_head<R>& arguments) const;
    /// Whether notes look at what is in the ensemble.
    bool looks_at_results() const { return functions.rhs != nullptr || facts.tangents.n_vectors > 0; }
    /// Has the model's `generate` set all instances. Throws `error` if it has none, and what it throws.
    void generate(ensemble_data<R>& data, std::uint64_t seed) const;
};
extern template struct called_model<double>;
extern template struct called_model<float>;

template <class R>
class solve_call {
public:
    /// Takes the ensemble for this call on one device or on several GPUs, checks all that can be checked before the
    /// integration, and prepares it. Throws `error`. All other arguments must outlive the call.
    solve_call(const std::vector<device>& where, const options& o, const called_model<R>& model, ensemble_data<R>& data,
               sample_data<R>& samples, record_data<R>& records, new_samples are = new_samples::cleared);

    /// Integrates on the devices, and reports. Throws `error` if an input is invalid, and what the progress function
    /// throws. If `stay` is not null, results stay on the GPU, the only device, where they fit.
    void integrate(report_of<R>& result, results_on_gpu<R>* stay = nullptr);
    /// Adds the notes that follow from what is left in the ensemble; of a call that was `cut_short`, only the others.
    void add_notes(report_of<R>& result, bool cut_short = false) const;

    any_arguments<R>& arguments() { return prepared_->arguments; }
    std::shared_ptr<prepared_call<R>> prepared() const { return prepared_; }

private:
    /// The ensemble, once the options are checked.
    static ensemble_data<R>& checked(const std::vector<device>& where, const options& o, const called_model<R>& model,
                                     ensemble_data<R>& data);
    bool is_on_cpu() const { return where_.front().which() == device::kind::cpu; }

    const std::vector<device> where_;
    const options& options_;
    const called_model<R>& model_;
    ensemble_data<R>& data_;
    occupancy::claim claim_;
    phases_left left_;
    data_check<R> check_;
    std::shared_ptr<prepared_call<R>> prepared_;
};
extern template class solve_call<double>;
extern template class solve_call<float>;

}  // namespace myriad::host::inline MYRIAD_ABI
