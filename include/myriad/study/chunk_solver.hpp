// SPDX-License-Identifier: MIT
// Computes a chunk of a study's instances: fills an ensemble from the axes, integrates it, and copies what is kept.
// Only the few functions of `model_instances` depend on the model. Host code only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"
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
    virtual void generate(std::int64_t first) = 0;
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
    void set_components();
    void set_domains();

    const study_plan& plan_;
    maker make_;
    std::unique_ptr<model_instances<R>> instances_;
    std::int64_t first_ = 0;
};
extern template class chunk_solver_of<double>;
extern template class chunk_solver_of<float>;

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
    /// What stands for the generator of instances; empty if there is none.
    virtual std::string generator() const = 0;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
