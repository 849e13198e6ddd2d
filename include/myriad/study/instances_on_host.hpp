// SPDX-License-Identifier: MIT
// Instances of a study in the host's memory: what sets them after the axes, and an ensemble of the model. Host code
// only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/core/declarations.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/solve/solve.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/study/generator.hpp"
#include "myriad/study/chunk_solver.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// What sets instances after the axes: a function of the user's, where `first` is the number of the first one, or the
/// model's own.
template <class Model, class R>
struct generator {
    std::string name;
    std::function<void(std::int64_t first, ensemble<Model, R>& instances)> function = {};
    bool calls_model = false;
};

/// Calls the model's `generate` for all instances, in parallel. Rethrows what it throws.
template <class Model, class R>
void call_generate(host::ensemble_data<R>& data, std::uint64_t seed) {
    if constexpr (detail::generates<Model, R>) {
        detail::instance_arrays<detail::array_pointer, R> arrays{};
        arrays.state = data.state.data();
        arrays.parameter = data.parameter.data();
        arrays.accessory = data.accessory.data();
        arrays.integer_accessory = data.integer_accessory.data();
        const detail::instance_range range{data.size, data.first_index};
        const detail::shared_parameters<R> shared{data.shared.data(), data.shared_integer.data()};
        std::mutex mutex;
        std::exception_ptr failure;
        host::in_parallel(data.size, 4096, [&](std::int64_t begin, std::int64_t end) {
            try {
                for (std::int64_t i = begin; i < end; ++i)
                    detail::generate_instance<Model, R>(arrays, range, shared, seed, i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                failure = std::current_exception();
            }
        });
        if (failure) std::rethrow_exception(failure);
    }
}

template <class Model, class Method, class R>
class instances_on_host final : public model_instances<R> {
public:
    instances_on_host(std::int64_t size, std::shared_ptr<const generator<Model, R>> generate)
        : instances_(size), generate_(std::move(generate)) {}

    host::ensemble_data<R>& data() override { return host::ensemble_access::data(instances_); }
    void restart() override { instances_.restart(); }
    void generate(std::int64_t first, std::uint64_t seed) override {
        if (generate_->function) generate_->function(first, instances_);
        if (generate_->calls_model) call_generate<Model, R>(data(), seed);
    }
    ensemble<Model, R>& all() { return instances_; }
    report_of<R> solve(const device& where, const options& o) override {
        report<Model, R> made = myriad::solve<Method>(where, instances_, o);
        records_ = std::move(made.records);
        return made;
    }
    const R* recorded(component_kind kind, int number) const override {
        return kind == component_kind::state ? records_.state(number).data() : records_.accessory(number).data();
    }
    const std::int32_t* recorded_integers(int number) const override {
        return records_.integer_accessory(number).data();
    }
    const R* record_times() const override { return records_.time().data(); }
    const R* sampled(int number) const override { return instances_.samples().state(number).data(); }
    const R* sample_times() const override { return instances_.samples().time().data(); }
    const std::int32_t* samples_stored() const override { return instances_.samples().stored().data(); }

private:
    ensemble<Model, R> instances_;
    phase_records<Model, R> records_;
    std::shared_ptr<const generator<Model, R>> generate_;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
