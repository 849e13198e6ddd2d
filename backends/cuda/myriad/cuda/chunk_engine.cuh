// SPDX-License-Identifier: MIT
// The engine of the CUDA backend: device memory, transfers and kernels for one chunk of an ensemble, all in one stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/chunk_layout.cuh"
#include "myriad/cuda/launch.cuh"
#include "myriad/cuda/resources.cuh"
#include "myriad/cuda/schedule.cuh"
#include "myriad/cuda/staging.cuh"
#include "myriad/cuda/stop_line.cuh"
#include "myriad/cuda/transfers.cuh"
#include "myriad/host/backend/backend.hpp"

namespace myriad::cuda {

template <class R>
class chunk_engine : public engine<R> {
protected:
    using arguments = any_arguments<R>;

public:
    chunk_engine(const engine_options& options, model_kernels kernels)
        : device_(options.device), now_current_(std::in_place, options.device),
          launcher_(options.device, options, std::move(kernels)),
          scheduler_(options.schedule, launcher_.traits().costs_differ) {
        launcher_.listen_to(stop_line_.word());
        now_current_.reset();
    }
    ~chunk_engine() override {
        try {
            now_current_.emplace(device_);  // until the other members are destroyed
        } catch (const error&) {            // CUDA may be gone at exit
        }
        gpu::synchronise(stream_.get());
    }

    void reserve(const arguments& host, std::int64_t count) override {
        const current_device here(device_);
        arguments all = host;
        const auto arrays = [&](auto&& add) { for_each_array(all, add); };
        const auto records = [&](auto&& add) { for_each_record(all, add); };
        std::size_t per_instance = scheduler_.bytes_per_instance(), to_stage = 0;
        const auto add = [&](auto* array, std::int64_t components, array_access, array_kind) {
            per_instance += bytes_of(array, components);
            if (!is_pinned(array)) to_stage += bytes_of(array, components * count);
        };
        arrays(add);
        records(add);
        grow(memory_, bytes_for(count, arrays), per_instance);
        grow(records_, bytes_for(count, records), per_instance);
        scheduler_.reserve(count, host.phases, launcher_);
        if (to_stage > little_transfer::most && !has_staged_) {
            // Created now, as that waits for all work on the device: one for an upload, one for a download, one on
            // request.
            const pooled_staging up(device_), down(device_), next(device_);
            has_staged_ = true;
        }
    }

    void upload(const arguments& host, std::int64_t first, std::int64_t count, past of_instances) override {
        upload(host, first, count, of_instances, [](const void*) { return false; });
    }
    /// The same without the components, by the address of their first value, that are `elsewhere`.
    template <class Elsewhere>
    void upload(const arguments& host, std::int64_t first, std::int64_t count, past of_instances,
                Elsewhere&& elsewhere) {
        const current_device here(device_);
        begin_chunk(host, first, count);
        arguments from = host;
        const bool fresh_samples = of_instances == past::none || !has_samples(host);
        const auto is_cleared = [&](array_kind kind) {
            return (kind == array_kind::bookkeeping && of_instances == past::none) ||
                   (kind == array_kind::samples && fresh_samples);
        };
        row_list list;
        walk(from, [&](auto*& source, auto* target, std::int64_t components, array_access, array_kind kind) {
            if (is_cleared(kind)) return;
            std::int64_t done = 0;  // components
            const auto add_until = [&](std::int64_t end) {
                if (end > done)
                    list.push_back(rows_of(source + done * host.size, host.size, target + done * count_, end - done));
                done = end + 1;
            };
            for (std::int64_t c = 0; c < components; ++c)
                if (elsewhere(source + c * host.size)) add_until(c);
            add_until(components);
        });
        copy_directly(take_pinned(list), gpu::direction::to_device, stream_.get());
        if (little_transfer::takes(list)) {
            little_.upload(list, stream_.get());
        } else {
            pooled_staging(device_)->upload(list, stream_.get());
        }
        // After the copies: clearing needs multiprocessors, so that the copies would wait for kernels of other chunks.
        clear_arrays(from, is_cleared);
        set_shared(host.shared);
    }

    void integrate(const arguments& host) override {
        require(count_ > 0, "nothing was uploaded yet", host::cure, "call upload before integrate");
        const current_device here(device_);
        if (fetching_ && !(*fetching_)->asked_for_all()) finish_download();
        arguments now = host;
        walk(now, [](auto*& array, auto* on_device, std::int64_t, array_access, array_kind) { array = on_device; });
        now.size = count_;
        now.first_index = host.first_index + first_;
        now.shared = shared_on_device_;
        walk_records(now, [&](auto*& array, auto* on_device, std::int64_t components, array_access, array_kind) {
            clear(on_device, components);
            array = on_device;
        });
        prepare_sample_times(now.sample);
        stop_line_.clear(stream_.get());
        MYRIAD_GPU_CALL(gpu::record(begun_.get(), stream_.get()));
        scheduler_.launch(launcher_, now, stream_.get());
        MYRIAD_GPU_CALL(gpu::record(done_.get(), stream_.get()));
    }

    void download(const arguments& host, bool (*wanted)(void*, array_kind, std::int64_t), void* context) override {
        require(count_ > 0, "nothing was uploaded yet", host::cure, "call upload before download");
        const current_device here(device_);
        row_list list;
        const auto add = [&](auto* target, auto* source, std::int64_t components, array_kind kind) {
            if (wanted == nullptr) {
                list.push_back(rows_of(target, host.size, source, components));
                return;
            }
            for (std::int64_t c = 0; c < components; ++c)
                if (wanted(context, kind, c))
                    list.push_back(rows_of(target + c * host.size, host.size, source + c * count_, 1));
        };
        finish_download();
        arguments to = host;
        walk(to, [&](auto*& target, auto* source, std::int64_t components, array_access access, array_kind kind) {
            if (access != array_access::read) add(target, source, components, kind);
        });
        row_list of_arrays = std::exchange(list, {});
        walk_records(to, [&](auto*& target, auto* source, std::int64_t components, array_access, array_kind kind) {
            add(target, source, components, kind);
        });
        // Records have memory of their own, which may precede that of the arrays.
        const bool after = records_.data() > memory_.data();
        row_list& lower = after ? of_arrays : list;
        const row_list& upper = after ? list : of_arrays;
        lower.insert(lower.end(), upper.begin(), upper.end());
        copy_directly(take_pinned(lower), gpu::direction::to_host, stream_.get());
        if (little_transfer::takes(lower)) {
            little_.begin_download(lower, stream_.get());
        } else {
            fetching_ = std::make_unique<pooled_staging>(device_);
            (*fetching_)->begin_download(lower, stream_.get());
        }
    }

    place_on_device find(const arguments& host, const void* value) override {
        place_on_device found;
        const auto look = [&]<class T>(T*& array, auto* on_device, std::int64_t components, array_access access,
                                       array_kind) {
            const auto bytes = static_cast<const std::byte*>(value) - reinterpret_cast<const std::byte*>(array);
            const auto values = static_cast<std::int64_t>(bytes) / static_cast<std::int64_t>(sizeof(T));
            const std::int64_t component = values / host.size, instance = values % host.size - first_;
            if (bytes >= 0 && component < components && instance >= 0 && instance < count_)
                found = {reinterpret_cast<std::byte*>(on_device + component * count_ + instance), access};
        };
        arguments all = host;
        walk(all, look);
        walk_records(all, look);
        return found;
    }
    void* native_stream() override { return static_cast<void*>(stream_.get()); }
    /// Copies from this device's memory to the host's, and waits.
    void copy_to_host(void* to, const std::byte* from, std::size_t bytes) {
        const current_device here(device_);
        finish_download();
        const row_list list{{static_cast<std::byte*>(to), const_cast<std::byte*>(from), bytes, 1, bytes}};
        if (is_pinned(to)) {
            copy_directly(list, gpu::direction::to_host, stream_.get());
        } else if (little_transfer::takes(list)) {
            little_.begin_download(list, stream_.get());
        } else {
            fetching_ = std::make_unique<pooled_staging>(device_);
            (*fetching_)->begin_download(list, stream_.get());
        }
        wait();
    }
    /// For further work on the device.
    gpu::stream_handle in_stream() const { return stream_.get(); }

    void wait() override {
        const current_device here(device_);
        finish_download();
        check(gpu::synchronise(stream_.get()), "the integration on the GPU");
    }
    bool idle() override {
        const current_device here(device_);
        const gpu::result status = gpu::query(stream_.get());
        if (status == gpu::result::not_ready) return false;
        check(status, "the integration on the GPU");
        return true;
    }
    void stop(detail::stop_request how) override {
        const current_device here(device_);
        stop_line_.ask(how);
    }
    void* mark() override {
        const current_device here(device_);
        MYRIAD_GPU_CALL(gpu::record(mark_.get(), stream_.get()));
        return mark_.get();
    }
    void wait_for(work& other) override {
        void* const reached = other.mark();
        const current_device here(device_);
        MYRIAD_GPU_CALL(gpu::wait_for(stream_.get(), static_cast<gpu::event_handle>(reached)));
    }
    double kernel_seconds() override {
        const current_device here(device_);
        check(gpu::synchronise(done_.get()), "the integration on the GPU");
        float milliseconds = 0;
        MYRIAD_GPU_CALL(gpu::find_milliseconds(&milliseconds, begun_.get(), done_.get()));
        return 1e-3 * static_cast<double>(milliseconds);
    }
    any_engine::interval kernel_interval(void* clock) override {
        const current_device here(device_);
        check(gpu::synchronise(done_.get()), "the integration on the GPU");
        const auto seconds = [&](const event& e) {
            float milliseconds = 0;
            MYRIAD_GPU_CALL(gpu::find_milliseconds(&milliseconds, static_cast<gpu::event_handle>(clock), e.get()));
            return 1e-3 * static_cast<double>(milliseconds);
        };
        return {seconds(begun_), seconds(done_)};
    }
    void* start_clock() override {
        const current_device here(device_);
        MYRIAD_GPU_CALL(gpu::record(clock_.get(), stream_.get()));
        return clock_.get();
    }
    kernel_facts facts() const override { return launcher_.facts(); }
    std::int64_t full_load() const override {
        int multiprocessors = 0;
        MYRIAD_GPU_CALL(gpu::find_attribute(&multiprocessors, gpu::device_attribute::multiprocessors, device_));
        const kernel_facts all = facts();
        return std::int64_t{multiprocessors} * all.blocks_per_multiprocessor * all.block_size /
               all.threads_per_instance;
    }
    void rest() override {
        const current_device here(device_);
        const std::size_t held = memory_.bytes() + records_.bytes() + scheduler_.bytes(),
                          always_fine = std::size_t{32} << 20;
        if (held <= always_fine) return;
        std::size_t free = 0, total = 0;
        MYRIAD_GPU_CALL(gpu::find_memory(&free, &total));
        if (held <= total / 1024) return;
        count_ = 0;
        memory_.release();
        records_.release();
        scheduler_.release();
    }

    std::int64_t affordable(std::int64_t bytes) const override {
        const current_device here(device_);
        std::size_t free = 0, total = 0;
        MYRIAD_GPU_CALL(gpu::find_memory(&free, &total));
        const double taken = static_cast<double>(bytes) + static_cast<double>(scheduler_.bytes_per_instance());
        return static_cast<std::int64_t>(0.9 * static_cast<double>(free) / taken);
    }

protected:
    /// Before the instances of another chunk are put on the device: makes room for them.
    void begin_chunk(const arguments& host, std::int64_t first, std::int64_t count) {
        finish_download();
        first_ = first;
        count_ = count;
        scheduler_.forget_costs();
        reserve(host, count);
    }
    /// Stores the shared parameters where the kernel reads them, and in device memory too if they are `in_memory`.
    void set_shared(const shared_parameters<R>& shared, bool in_memory = false) {
        launcher_.set_shared(shared);
        if (in_memory || launcher_.facts().shared_placement != shared_placement::constant_bank) upload_shared(shared);
    }

    /// Calls `visit(host pointer, device pointer, components, access, kind)` for every array.
    template <class Visit>
    void walk(arguments& host, Visit&& visit) {
        auto* next = static_cast<std::byte*>(memory_.data());
        for_each_array(host, placing(next, count_, visit));
    }
    template <class Visit>
    void walk_records(arguments& host, Visit&& visit) {
        auto* next = static_cast<std::byte*>(records_.data());
        for_each_record(host, placing(next, count_, visit));
    }
    template <class T>
    array_rows rows_of(T* host, std::int64_t size, T* device, std::int64_t components) const {
        return {reinterpret_cast<std::byte*>(host + first_), reinterpret_cast<std::byte*>(device),
                bytes_of(host, count_), static_cast<std::size_t>(components), bytes_of(host, size)};
    }
    /// Removes the rows in pinned memory from a list, unless the list is small enough for a single transfer.
    static row_list take_pinned(row_list& list) {
        if (little_transfer::takes(list)) return {};
        const auto in_pages = [](const array_rows& rows) { return !is_pinned(rows.host); };
        const auto first = std::stable_partition(list.begin(), list.end(), in_pages);
        row_list pinned(first, list.end());
        list.erase(first, list.end());
        return pinned;
    }

    void finish_download() {
        little_.finish_download();
        if (const auto lent = std::move(fetching_)) (*lent)->finish_download();
    }

    /// Clears the arrays of the kinds for which `is_cleared` holds: bookkeeping to zero.
    template <class Test>
    void clear_arrays(arguments& from, Test&& is_cleared) {
        std::byte *zeros = nullptr, *end_of_zeros = nullptr;
        walk(from, [&](auto*&, auto* target, std::int64_t components, array_access, array_kind kind) {
            if (!is_cleared(kind)) return;
            if (kind == array_kind::samples) return clear(target, components);
            auto* const begin = reinterpret_cast<std::byte*>(target);
            if (zeros == nullptr) zeros = begin;
            end_of_zeros = begin + bytes_of(target, components * count_);
        });
        // Bookkeeping arrays are contiguous.
        if (zeros != nullptr)
            MYRIAD_GPU_CALL(gpu::fill(zeros, 0, static_cast<std::size_t>(end_of_zeros - zeros), stream_.get()));
    }
    /// Sets reals to NaN, which means that nothing was written, and integers to 0.
    template <class T>
    void clear(T* device, std::int64_t components) {
        const int byte = std::is_floating_point_v<T> ? 0xff : 0;
        MYRIAD_GPU_CALL(gpu::fill(device, byte, bytes_of(device, components * count_), stream_.get()));
    }

    bool has_samples(const arguments& host) const {
        if (host.sample.stored == nullptr) return false;
        for (std::int64_t i = first_; i < first_ + count_; ++i)
            if (host.sample.stored[i] != 0) return true;
        return false;
    }

    /// Waits first, so that no memory in use is freed.
    void grow(device_memory& memory, std::size_t bytes, std::size_t per_instance) {
        if (bytes <= memory.bytes()) return;
        wait();
        memory.reserve(bytes, per_instance, memory_.bytes() + records_.bytes());
    }

    template <class Sample>
    void prepare_sample_times(Sample& sample) {
        if (sample.times == nullptr) return;
        const std::size_t bytes = static_cast<std::size_t>(sample.count) * sizeof(R);
        if (bytes > sample_times_.bytes()) wait();
        sample_times_.reserve(bytes);
        MYRIAD_GPU_CALL(gpu::copy(sample_times_.data(), sample.times, bytes, gpu::direction::to_device, stream_.get()));
        sample.times = static_cast<const R*>(sample_times_.data());
    }

    void upload_shared(const shared_parameters<R>& shared) {
        const model_numbers& of = launcher_.traits().model;
        const std::size_t real = static_cast<std::size_t>(of.n_shared) * sizeof(R),
                          integer = static_cast<std::size_t>(of.n_shared_integer) * sizeof(std::int32_t);
        shared_.reserve(padded(real + 256 + integer, 1));
        auto* const reals = static_cast<R*>(shared_.data());
        auto* const integers =
            reinterpret_cast<std::int32_t*>(static_cast<std::byte*>(shared_.data()) + padded(real, 1));
        if (real > 0) MYRIAD_GPU_CALL(gpu::copy(reals, shared.real, real, gpu::direction::to_device, stream_.get()));
        if (integer > 0)
            MYRIAD_GPU_CALL(gpu::copy(integers, shared.integer, integer, gpu::direction::to_device, stream_.get()));
        shared_on_device_ = {reals, integers};
    }

    int device_;
    std::optional<current_device> now_current_;  // while the members below are created and destroyed
    kernel_launcher<R> launcher_;
    device_memory memory_, records_, sample_times_, shared_;
    phase_scheduler<R> scheduler_;
    stream stream_;
    stop_line stop_line_;
    event begun_{event::kind::timed}, done_{event::kind::timed}, clock_{event::kind::timed}, mark_{event::kind::plain};
    little_transfer little_;
    std::unique_ptr<pooled_staging> fetching_;  // of the download in progress, if it is larger
    bool has_staged_ = false;
    shared_parameters<R> shared_on_device_{};
    std::int64_t first_ = 0, count_ = 0;
};

}  // namespace myriad::cuda
