// SPDX-License-Identifier: MIT
// What a study does with a model, whether it is known when a program is compiled or only when it runs: instances in the
// host's memory, or, where all can be done there, on a GPU, which is told nothing of single instances. Compiled in the
// library. Host code only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/checks/shown_values.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/ensemble/sample_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/host/solve/prepared_call.hpp"
#include "myriad/host/solve/solve_call.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/study_plan.hpp"
#include "myriad/study/run/chunk_solver.hpp"
#include "myriad/study/store/store.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The memory of instances, which a front end has.
template <class R>
class instance_memory {
public:
    virtual ~instance_memory() = default;
    virtual host::ensemble_data<R>& data() = 0;
    virtual host::sample_data<R>& samples() = 0;
};

/// A model and a method with real type R. Front ends say where its memory and its kernels come from.
template <class R>
class studied_model : public any_model {
public:
    element real() const final { return element_of<R>; }
    void check(const device& where, const options& o) const final;
    std::unique_ptr<chunk_solver> make_solver(const study_plan& plan, const device& where) const final;
    std::unique_ptr<chunk_solver> make_device_solver(const study_plan& plan, const device& where) const final;
    arithmetic arithmetic_on(const device& where) const final;
    std::shared_ptr<const model_behaviour> behaviour(const study_plan& plan,
                                                     const std::vector<device>& devices) const final;

    /// The model and its kernel for that device.
    virtual host::called_model<R> called_for(const device& where, const options& o) const = 0;
    /// Memory for instances that are integrated there.
    virtual std::unique_ptr<instance_memory<R>> allocate(const device& where, std::int64_t size) const = 0;
    /// The options of a study as calls on that device take them.
    virtual options options_for(const device& /*where*/, options o) const { return o; }
    /// What calls the model's functions in memory for that device; null if that cannot be.
    virtual detail::behaviour_function<R> behaviour_for(const device& where) const = 0;
    /// The compiler of the kernel for that device.
    virtual std::string compiler_for(const device& where) const = 0;
    /// Sets what neither axes nor the model set; `first` is the number of the first instance in the study.
    virtual void set_others(instance_memory<R>& /*instances*/, std::int64_t /*first*/) const {}
    /// Whether that is to be done for all instances.
    virtual bool sets_others() const { return false; }
};
extern template class studied_model<double>;
extern template class studied_model<float>;

/// A solver of instances in the host's memory, and one that sets, integrates and reduces them on a GPU, null if that
/// cannot be. Plan and model must outlive them.
template <class R>
std::unique_ptr<chunk_solver> solver_on_host(const study_plan& plan, const studied_model<R>& model,
                                             const device& where);
template <class R>
std::unique_ptr<chunk_solver> solver_on_device(const study_plan& plan, const studied_model<R>& model,
                                               const device& where);

/// Instances in the host's memory, and what is recorded of them.
template <class R>
class host_instances {
public:
    host_instances(const studied_model<R>& model, const device& where, std::int64_t size)
        : model_(model), where_(where), memory_(model.allocate(where, size)) {}

    host::ensemble_data<R>& data() { return memory_->data(); }
    host::sample_data<R>& samples() { return memory_->samples(); }
    host::record_data<R>& records() { return records_; }
    /// Sets all to what axes and generators say, or, without a user's function, what that does not change; `first` is
    /// the number of the first one in the study.
    void set(const axes& all, std::int64_t first, bool calls_users_function = true);
    /// Integrates them and keeps the records.
    report_of<R> solve(const device& where, const options& o);

private:
    const studied_model<R>& model_;
    device where_;
    std::unique_ptr<instance_memory<R>> memory_;
    host::record_data<R> records_;
};
extern template class host_instances<double>;
extern template class host_instances<float>;

/// Instances in the memory of a GPU's engine, and a few of them on the host, for checks and notes that look at
/// instances: these have the arrays that those on the device have.
template <class R>
class device_instances {
public:
    device_instances(const studied_model<R>& model, const device& where, const study_plan& plan, std::int64_t few);
    device_instances(const device_instances&) = delete;
    device_instances& operator=(const device_instances&) = delete;
    ~device_instances();

    host_instances<R>& looked_at() { return few_; }
    const detail::any_arguments<R>& arguments() const { return call_.arguments; }
    const host::record_data<R>& records() const { return records_; }
    /// Throws what `solve` throws for the first `count` instances on the host.
    void check(std::int64_t count);
    /// Notes about the first `count` instances on the device, which replace those on the host.
    std::vector<statement> notes(std::int64_t count);
    /// Instances that half of the device's free memory has room for.
    std::int64_t affordable() const;
    /// See `cuda::engine`.
    void generate(const std::shared_ptr<const cuda::generation>& how, std::int64_t first, std::int64_t count);
    /// Integrates them, and waits until that is done; calls `watch` meanwhile, which may throw, and so ends it.
    void integrate(const std::function<void()>& watch);
    void fetch(const cuda::device_values& what, std::byte* to);
    std::vector<std::int64_t> reduce(const cuda::device_values& what, const cuda::device_reduction& how);

private:
    /// The instances on the host, with the arrays that a call needs.
    host::ensemble_data<R>& with_domains(const axes& all) {
        few_.set(all, 0);
        return few_.data();
    }
    /// An engine that has failed is not used again.
    template <class Work>
    void use(Work&& work);

    options options_;
    host::called_model<R> model_;
    host_instances<R> few_;
    host::record_data<R> records_;
    host::prepared_call<R> call_;
    std::unique_ptr<cuda::engine<R>> engine_;
    bool fine_ = true;
};
extern template class device_instances<double>;
extern template class device_instances<float>;

}  // namespace myriad::studies::inline MYRIAD_ABI
