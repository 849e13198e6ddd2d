// SPDX-License-Identifier: MIT
// A call on a GPU whose results stay there: they are copied to the host when they are asked for, or used where they
// are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>

#include "device_library.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/chunks/results_on_gpu.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/host/solve/solve_call.hpp"
#include "run.hpp"

namespace myriad::python {

/// One call, in one chunk. Its engine, with the memory on the device, is its own for as long as it lives.
template <class R>
class resident final : public host::results_on_gpu<R> {
public:
    /// The memory of the arguments is the ensemble's, which lives longer, and the call's.
    resident(const library& kernel, const host::called_model<R>& model, const host::solve_call<R>& call,
             ensemble<R>& instances, const options& o);
    resident(const resident&) = delete;
    resident& operator=(const resident&) = delete;
    ~resident();

    /// Whether the device has room for all instances many times over, so that results may stay there, or inputs are
    /// there already and it has room for them once. Throws `error` if they are, and it has not.
    bool fit(const cuda::engine<R>& worker) override;
    void upload(cuda::engine<R>& worker, cuda::past of_instances) override;
    void keep(std::unique_ptr<cuda::engine<R>> worker, report_of<R>& result) override;
    /// Whether results are here, and not in the ensemble.
    bool has_results() const { return engine_ != nullptr; }

    /// Copies to the host, unless that is done, what belongs into the ensemble's memory there, such as a component.
    void bring(const void* values, std::size_t bytes);
    /// Copies all of every `stride`th instance but its samples to its place on the host.
    void bring_every(std::int64_t stride) { engine_->fetch_every(call_->arguments, stride); }
    /// Whether nothing of what is kept between calls was brought besides the statuses.
    bool left_bookkeeping(const host::ensemble_data<R>& data) const;
    /// Where the device has that; null if it has not.
    void* on_device(const void* values) { return engine_ ? engine_->find(call_->arguments, values).address : nullptr; }
    int number() const { return source_.how.device; }

private:
    using study_engine = cuda::study_engine<R>;  // of which all engines of a library are

    void take_inputs(study_engine& worker);
    host::work_count work();

    device_program& program_;
    host::engine_source<R> source_;
    std::shared_ptr<host::prepared_call<R>> call_;
    ensemble<R>& instances_;  // outlives the call alone
    const bool marks_invalid_;
    std::unique_ptr<study_engine> engine_;
    std::set<const void*> given_there_, brought_;
    cuda::device_memory scratch_;
};
extern template class resident<double>;
extern template class resident<float>;

}  // namespace myriad::python
