// SPDX-License-Identifier: MIT
// Computes a chunk of a study's instances: sets them as the axes say, integrates them, and copies what is kept. Either
// in an ensemble on the host, or, where all can be done there, on a GPU, which is told nothing of single instances.
// Only the few functions of `model_instances` and `device_instances` depend on the model. Host code only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/study/store.hpp"
#include "myriad/study/study_plan.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// How an integration went.
struct solved {
    std::array<std::int64_t, status_count> by_status{};
    std::vector<std::string> notes;
};

/// Instances of a study on one device, one part after the other. One thread uses it at a time.
class chunk_solver {
public:
    virtual ~chunk_solver() = default;
    /// Sets instances [first, first + count) to what the axes and the generator say.
    virtual void prepare(std::int64_t first, std::int64_t count) = 0;
    /// Integrates them; `progress` is told how many of them are done. Throws what `myriad::solve` throws.
    virtual solved integrate(const device& where, const std::function<void(std::int64_t done)>& progress) = 0;
    /// Copies a variable of all of them, in row-major order, the instance outermost.
    virtual void copy(const quantity& what, std::byte* to) const = 0;
    /// Frees the memory of the instances.
    virtual void clear() = 0;
    /// Whether it works on a device by itself: what it throws is then the device's failure.
    virtual bool on_device() const { return false; }
    /// Most instances that the device has memory for.
    virtual std::int64_t most_at_a_time() { return std::numeric_limits<std::int64_t>::max(); }
    /// Whether it does a reduction of the plan itself, so that its input need not be copied; if so, adds it to `to`.
    virtual bool reduce(std::size_t /*number*/, reduction_state& /*to*/) { return false; }
};

/// An ensemble of the model and what is recorded of it.
template <class R>
class model_instances {
public:
    virtual ~model_instances() = default;
    virtual host::ensemble_data<R>& data() = 0;
    /// Forgets what was integrated, and the samples.
    virtual void restart() = 0;
    /// Lets the user's generator set them; `first` is the number of the first one in the study.
    virtual void generate(std::int64_t first, std::uint64_t seed) = 0;
    /// Integrates them and keeps the records.
    virtual report_of<R> solve(const device& where, const options& o) = 0;
    /// One component at all recorded phases, one phase after the other.
    virtual const R* recorded(component_kind kind, int number) const = 0;
    virtual const std::int32_t* recorded_integers(int number) const = 0;
    virtual const R* record_times() const = 0;
    /// One state, or the times, at all samples, one sample after the other.
    virtual const R* sampled(int number) const = 0;
    virtual const R* sample_times() const = 0;
    virtual const std::int32_t* samples_stored() const = 0;
};

/// Sets all instances to what axes and the generator say; `first` is the number of the first one in the study.
template <class R>
void set_instances(model_instances<R>& instances, const axes& all, std::int64_t first);
extern template void set_instances(model_instances<double>&, const axes&, std::int64_t);
extern template void set_instances(model_instances<float>&, const axes&, std::int64_t);

/// The solver of a model with real type R. The plan must outlive it.
template <class R>
class chunk_solver_of final : public chunk_solver {
public:
    using maker = std::function<std::unique_ptr<model_instances<R>>(std::int64_t size)>;

    chunk_solver_of(const study_plan& plan, maker make) : plan_(plan), make_(std::move(make)) {}

    void prepare(std::int64_t first, std::int64_t count) override;
    solved integrate(const device& where, const std::function<void(std::int64_t done)>& progress) override;
    void copy(const quantity& what, std::byte* to) const override;
    void clear() override { instances_.reset(); }

private:
    const study_plan& plan_;
    maker make_;
    std::unique_ptr<model_instances<R>> instances_;
    std::int64_t first_ = 0;
};
extern template class chunk_solver_of<double>;
extern template class chunk_solver_of<float>;

/// Where kernels put records and samples: pointers of the host's arguments, and the columns of components there, -1 for
/// those that have none.
struct result_arrays {
    const void *records = nullptr, *record_integers = nullptr, *samples = nullptr, *sample_times = nullptr,
               *samples_stored = nullptr;
    std::vector<int> states = {}, accessories = {}, integers = {}, sampled = {};
    int time = -1;
};

/// Instances of a study on a GPU, and a few of them on the host, for checks and notes that look at instances.
template <class R>
class device_instances {
public:
    virtual ~device_instances() = default;
    /// Those on the host: they have the arrays that those on the device have.
    virtual model_instances<R>& looked_at() = 0;
    virtual const detail::instance_arrays<detail::array_pointer, R>& arrays() const = 0;
    virtual const result_arrays& results() const = 0;
    /// Throws what `solve` throws for the first `count` instances on the host.
    virtual void check(std::int64_t count) = 0;
    /// Notes about the first `count` instances on the device, which replace those on the host.
    virtual std::vector<std::string> notes(std::int64_t count) = 0;
    /// Instances that half of the device's free memory has room for.
    virtual std::int64_t affordable() = 0;
    /// See `cuda::engine`.
    virtual void generate(const std::shared_ptr<const cuda::generation>& how, std::int64_t first,
                          std::int64_t count) = 0;
    /// Integrates them, and waits until that is done; calls `watch` meanwhile, which may throw, and so ends it.
    virtual void integrate(const std::function<void()>& watch) = 0;
    virtual void fetch(const cuda::device_values& what, std::byte* to) = 0;
    virtual std::vector<std::int64_t> reduce(const cuda::device_values& what, const cuda::device_reduction& how) = 0;
};

/// The solver that sets, integrates and reduces instances on a GPU. The plan must outlive it.
template <class R>
class device_solver_of final : public chunk_solver {
public:
    using maker = std::function<std::unique_ptr<device_instances<R>>(std::int64_t size)>;

    /// `calls_model`: the model's `generate` sets instances after the axes.
    device_solver_of(const study_plan& plan, bool calls_model, maker make)
        : plan_(plan), calls_model_(calls_model), make_(std::move(make)) {}

    void prepare(std::int64_t first, std::int64_t count) override;
    solved integrate(const device& where, const std::function<void(std::int64_t done)>& progress) override;
    void copy(const quantity& what, std::byte* to) const override;
    void clear() override;
    bool on_device() const override { return true; }
    std::int64_t most_at_a_time() override;
    bool reduce(std::size_t number, reduction_state& to) override;

private:
    void start();
    std::shared_ptr<const cuda::generation> describe();
    cuda::device_values values_of(const quantity& what) const;

    const study_plan& plan_;
    bool calls_model_;
    maker make_;
    std::vector<detail::axis_rule> rules_;  // of the entries of the axes
    std::shared_ptr<const cuda::generation> how_;
    std::unique_ptr<device_instances<R>> instances_;
    std::int64_t first_ = 0, count_ = 0;
    bool noted_ = false;
};
extern template class device_solver_of<double>;
extern template class device_solver_of<float>;

/// Whether the inputs of a study without a generator on the host can be left to a GPU. `endless`: something can end a
/// phase before t_end.
bool can_be_on_device(const study_request& asked, bool endless);

/// A model, a method and a real type: what a study needs of them.
class any_model {
public:
    virtual ~any_model() = default;
    virtual const component_names& names() const = 0;
    virtual std::string method() const = 0;
    virtual element real() const = 0;
    /// Throws `error` if an option is invalid, or if the device has no kernel for them.
    virtual void check(const device& where, const options& o) const = 0;
    /// Bytes of memory that a call takes on the host for one instance.
    virtual double bytes_per_instance(const options& o) const = 0;
    /// A solver for that device.
    virtual std::unique_ptr<chunk_solver> make_solver(const study_plan& plan, const device& where) const = 0;
    /// One that sets and reduces instances on the GPU; null if that cannot be.
    virtual std::unique_ptr<chunk_solver> make_device_solver(const study_plan& /*plan*/,
                                                             const device& /*where*/) const {
        return nullptr;
    }
    /// What the last digits depend on there.
    virtual arithmetic arithmetic_on(const device& where) const = 0;
    /// What stands for the generator of instances; empty if there is none.
    virtual std::string generator() const = 0;
    /// Whether that is the model's own.
    virtual bool generates_itself() const { return false; }
};

}  // namespace myriad::studies::inline MYRIAD_ABI
