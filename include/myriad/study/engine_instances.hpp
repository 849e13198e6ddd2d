// SPDX-License-Identifier: MIT
// Instances of a study in the memory of a GPU's engine: what of them depends on the arguments' type alone. Host code
// only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/model/model_shape.hpp"
#include "myriad/host/threads/polling_backoff.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/chunk_solver.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The arguments are those of a call for a few instances on the host, and belong to the derived class.
template <class R, class Arguments>
class engine_instances : public device_instances<R> {
public:
    const detail::instance_arrays<detail::array_pointer, R>& arrays() const final { return *arguments_; }
    const result_arrays& results() const final { return results_; }
    std::int64_t affordable() final {
        std::int64_t bytes = 64;  // for what is drawn again, gathered and scheduled
        const auto add = [&](auto* array, std::int64_t components, auto...) {
            bytes += components * static_cast<std::int64_t>(sizeof(*array));
        };
        auto arguments = *arguments_;  // a copy
        for_each_array(arguments, add);
        for_each_record(arguments, add);
        return engine_->affordable(2 * bytes);
    }
    void generate(const std::shared_ptr<const cuda::generation>& how, std::int64_t first, std::int64_t count) final {
        use([&](auto& e) { e.generate(*arguments_, how, first, count); });
    }
    void integrate(const std::function<void()>& watch) final {
        use([&](auto& e) {
            e.integrate(*arguments_);
            try {
                for (host::polling_backoff waiting; !e.idle(); waiting.pause()) watch();
            } catch (...) {
                e.stop(detail::stop_request::end_now);
                e.wait();
                throw;
            }
            e.wait();
        });
    }
    void fetch(const cuda::device_values& what, std::byte* to) final {
        use([&](auto& e) { e.fetch(*arguments_, what, to); });
    }
    std::vector<std::int64_t> reduce(const cuda::device_values& what, const cuda::device_reduction& how) final {
        std::vector<std::int64_t> found;
        use([&](auto& e) { found = e.reduce(*arguments_, what, how); });
        return found;
    }

protected:
    /// Takes an idle engine of that kind, or has one made. The constructor of the derived class calls it.
    template <class Make>
    void take_engine(host::engine_key kind, const cuda::engine_options& how, Make&& make, Arguments& arguments,
                     const host::model_shape& shape) {
        kind_ = kind;
        how_ = how;
        engine_ = host::take_idle_engine(kind, how);
        if (engine_ == nullptr) engine_ = make(how);
        arguments_ = &arguments;
        const auto numbers = [](const std::int16_t* columns, int count) {
            return std::vector<int>(columns, columns + count);
        };
        const auto& record = arguments.record;
        const auto& sample = arguments.sample;
        results_ = {.records = record.values,
                    .record_integers = record.integers,
                    .samples = sample.values,
                    .sample_times = sample.time,
                    .samples_stored = sample.stored,
                    .states = numbers(record.state_column, shape.n_state),
                    .accessories = numbers(record.accessory_column, shape.n_accessory),
                    .integers = numbers(record.integer_accessory_column, shape.n_integer_accessory),
                    .sampled = numbers(sample.column, shape.n_state),
                    .time = record.time_column};
    }
    /// Leaves the engine to others, if it has not failed. The destructor of the derived class calls it, while the
    /// arguments are still there.
    void leave_engine() {
        if (fine_) host::give_idle_engine(kind_, how_, std::move(engine_));
        engine_.reset();
    }
    /// An engine that has failed is not used again.
    template <class Work>
    void use(Work&& work) {
        const bool before = std::exchange(fine_, false);
        work(static_cast<cuda::study_engine_for<Arguments>&>(*engine_));
        fine_ = before;
    }

private:
    host::engine_key kind_ = nullptr;
    cuda::engine_options how_;
    std::unique_ptr<cuda::any_engine> engine_;
    Arguments* arguments_ = nullptr;
    result_arrays results_;
    bool fine_ = true;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
