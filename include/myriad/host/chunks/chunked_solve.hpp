// SPDX-License-Identifier: MIT
// `solve` on a GPU: in chunks, so that one is prepared by the host, others are copied, and one is integrated at the
// same time.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/chunks/chunk_plan.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/chunks/progress_relay.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The engines of one call and the arguments that they work on, without the model's type.
class chunk_source {
public:
    virtual std::unique_ptr<cuda::any_engine> take() = 0;
    virtual void give(std::unique_ptr<cuda::any_engine> e) = 0;
    virtual chunk_plan plan(const options& o, const cuda::any_engine& worker) = 0;
    virtual void reserve(cuda::any_engine& e, std::int64_t count) = 0;
    /// Copies a chunk to the device, and integrates it.
    virtual void begin(cuda::any_engine& e, std::int64_t first, std::int64_t count, cuda::past of_instances) = 0;
    virtual void download(cuda::any_engine& e) = 0;

protected:
    ~chunk_source() = default;
};

/// The engines that `make(options)` creates for a model's kernels; `kind` tells them from those for others.
template <class Arguments, class Make>
class chunks_of final : public chunk_source {
public:
    chunks_of(engine_key kind, Make make, const cuda::engine_options& how, Arguments& arguments)
        : kind_(kind), make_(std::move(make)), how_(how), arguments_(arguments) {}

    std::unique_ptr<cuda::any_engine> take() override {
        auto idle = take_idle_engine(kind_, how_);
        return idle != nullptr ? std::move(idle) : make_(how_);
    }
    void give(std::unique_ptr<cuda::any_engine> e) override { give_idle_engine(kind_, how_, std::move(e)); }
    chunk_plan plan(const options& o, const cuda::any_engine& worker) override { return {o, arguments_, worker}; }
    void reserve(cuda::any_engine& e, std::int64_t count) override { typed(e).reserve(arguments_, count); }
    void begin(cuda::any_engine& e, std::int64_t first, std::int64_t count, cuda::past of_instances) override {
        typed(e).upload(arguments_, first, count, of_instances);
        typed(e).integrate(arguments_);
    }
    void download(cuda::any_engine& e) override { typed(e).download(arguments_); }

private:
    /// All engines of this object are its maker's.
    static cuda::engine_for<Arguments>& typed(cuda::any_engine& e) {
        return static_cast<cuda::engine_for<Arguments>&>(e);
    }

    engine_key kind_;
    Make make_;
    cuda::engine_options how_;
    Arguments& arguments_;
};

/// One call of `solve` on a GPU.
template <class R>
void solve_in_chunks(const options& o, chunk_source& source, ensemble_data<R>& instances, data_check<R>& check,
                     progress_relay& relay, report_of<R>& result);
extern template void solve_in_chunks(const options&, chunk_source&, ensemble_data<double>&, data_check<double>&,
                                     progress_relay&, report_of<double>&);
extern template void solve_in_chunks(const options&, chunk_source&, ensemble_data<float>&, data_check<float>&,
                                     progress_relay&, report_of<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
