// SPDX-License-Identifier: MIT
// The engine that also sets and reduces the instances of studies on the GPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "myriad/cuda/chunk_engine.cuh"
#include "myriad/cuda/study_work.cuh"
#include "myriad/host/backend/backend.hpp"

namespace myriad::cuda {

template <class R>
class study_engine final : public chunk_engine<R> {
    using base = chunk_engine<R>;
    using base::count_, base::device_, base::first_, base::launcher_, base::stream_, base::walk;
    using typename base::arguments;

public:
    using base::base;
    ~study_engine() override {
        try {
            const current_device here(device_);
            study_.release();
        } catch (const error&) {  // CUDA may be gone at exit
        }
    }

    void generate(const arguments& host, std::shared_ptr<const generation> how, std::int64_t first,
                  std::int64_t count) override {
        const current_device here(device_);
        base::begin_chunk(host, first, count);
        arguments now = host;
        base::clear_arrays(
            now, [](array_kind kind) { return kind == array_kind::bookkeeping || kind == array_kind::samples; });
        base::set_shared(host.shared, how->calls_model);
        walk(now, [](auto*& array, auto* on_device, std::int64_t, array_access, array_kind) { array = on_device; });
        const instance_range range{count, host.first_index + first};
        const auto find = [&](const void* array) { return place_of(host, array); };
        const study_kernels by = launcher_.study();
        study_.fill(by, how, find, range, now.ended, now.status, stream_.get());
        if (how->calls_model)
            study_.generate(by, static_cast<const instance_arrays<array_pointer, R>&>(now), range,
                            base::shared_on_device_, how->seed, stream_.get());
    }
    void fetch(const arguments& host, const device_values& what, std::byte* to) override {
        const current_device here(device_);
        const value_array all = on_device(host, what);
        const auto* const from = static_cast<const std::byte*>(study_.gathered(launcher_.study(), all, stream_.get()));
        base::copy_to_host(to, from, cuda::bytes_of(what.type) * static_cast<std::size_t>(all.size * all.inner));
    }
    std::vector<std::int64_t> reduce(const arguments& host, const device_values& what,
                                     const device_reduction& how) override {
        const current_device here(device_);
        base::finish_download();
        const auto* const statuses = static_cast<const status*>(place_of(host, host.status).values);
        return study_.reduce(launcher_.study(), on_device(host, what), statuses, how, stream_.get());
    }
    void fetch_first(const arguments& host, std::int64_t count) override {
        const current_device here(device_);
        arguments to = host;
        walk(to, [&](auto*& target, auto* source, std::int64_t components, array_access, array_kind) {
            MYRIAD_GPU_CALL(gpu::copy_rows(target, bytes_of(target, host.size), source, bytes_of(source, count_),
                                           bytes_of(source, count), static_cast<std::size_t>(components),
                                           gpu::direction::to_host, stream_.get()));
        });
        base::wait();
    }
    /// Copies all of every `stride`th instance but its samples to its place in the arrays on the host.
    void fetch_every(const arguments& host, std::int64_t stride) {
        const current_device here(device_);
        arguments to = host;
        walk(to, [&](auto*& target, auto* source, std::int64_t components, array_access, array_kind kind) {
            if (kind == array_kind::samples) return;
            const std::size_t distance = bytes_of(target, stride);
            for (std::int64_t c = 0; c < components; ++c)
                MYRIAD_GPU_CALL(gpu::copy_rows(target + c * host.size, distance, source + c * count_, distance,
                                               sizeof *target, static_cast<std::size_t>((count_ + stride - 1) / stride),
                                               gpu::direction::to_host, stream_.get()));
        });
        base::wait();
    }
    void rest() override {
        {
            const current_device here(device_);
            study_.release();
        }
        base::rest();
    }

private:
    /// The array on the device that the host's arguments have at that place.
    study_work::place place_of(const arguments& host, const void* array) {
        study_work::place found;
        const auto look = [&](auto*& there, auto* on_device, std::int64_t, array_access, array_kind) {
            if (there == array) found = {on_device, value_type_of(on_device)};
        };
        arguments copy = host;
        walk(copy, look);
        base::walk_records(copy, look);
        require(found.values != nullptr, "an array of a study is not on the device");
        return found;
    }
    value_array on_device(const arguments& host, const device_values& what) {
        const instance_range range{count_, host.first_index + first_};
        if (what.rule != nullptr) return study_.values_of(launcher_.study(), what, range, stream_.get());
        value_array all{nullptr, what.type, count_, what.inner};
        if (what.array == nullptr) return all;
        const study_work::place there = place_of(host, what.array);
        all.values = static_cast<const std::byte*>(there.values) +
                     cuda::bytes_of(there.type) * static_cast<std::size_t>(what.component * count_);
        if (what.ends_with_phases) {
            all.phases = static_cast<const std::int32_t*>(place_of(host, host.phase).values);
            all.from_phase = what.from_phase;
        }
        return all;
    }

    study_work study_;
};

}  // namespace myriad::cuda
