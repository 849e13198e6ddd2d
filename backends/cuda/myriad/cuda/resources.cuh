// SPDX-License-Identifier: MIT
// RAII owners of CUDA resources: device memory, streams and events. Each belongs to the device that was current at its
// creation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "myriad/cuda/check.cuh"

namespace myriad::cuda {

/// Makes a device current for its lifetime.
class current_device {
public:
    explicit current_device(int number) {
        MYRIAD_GPU_CALL(gpu::find_device(&before_));
        if (number != before_) MYRIAD_GPU_CALL(gpu::set_device(number));
    }
    ~current_device() { gpu::set_device(before_); }
    current_device(const current_device&) = delete;
    current_device& operator=(const current_device&) = delete;

private:
    int before_ = 0;
};

/// Device memory that grows on request and then loses its contents.
class device_memory {
public:
    device_memory() = default;
    device_memory(const device_memory&) = delete;
    device_memory& operator=(const device_memory&) = delete;
    ~device_memory() { gpu::release(data_); }

    /// Makes room for `bytes`. For the error message, unless `per_instance` is zero: the bytes per instance, and those
    /// already held for instances.
    void reserve(std::size_t bytes, std::size_t per_instance = 0, std::size_t held = 0) {
        if (bytes <= bytes_) return;
        release();
        const gpu::result status = gpu::allocate(&data_, bytes);
        if (status == gpu::result::out_of_memory) {
            gpu::forget_failure();
            std::size_t free = 0, total = 0;
            MYRIAD_GPU_CALL(gpu::find_memory(&free, &total));
            statement advice;
            if (per_instance > 0) {
                const auto fits = static_cast<std::int64_t>(0.9 * static_cast<double>(free + held) /
                                                            static_cast<double>(per_instance));
                const std::string words = message(
                    "integrate fewer instances at a time, with a solver's capacity of at most ", fits,
                    " or, as solve works on three chunks at a time, an options::chunk_size of at most ", fits / 3);
                advice = statement_of(host::cure, host::message_part(host::cures::fewer_instances, words, fits / 3));
            }
            throw out_of_memory(statement_of("out of device memory: ", static_cast<double>(bytes) / 1e9,
                                             " GB are wanted and ", static_cast<double>(free) / 1e9, " of ",
                                             static_cast<double>(total) / 1e9, " GB are free", advice));
        }
        check(status, "an allocation");
        bytes_ = bytes;
    }
    void release() {
        MYRIAD_GPU_CALL(gpu::release(data_));
        data_ = nullptr;
        bytes_ = 0;
    }
    void* data() const { return data_; }
    std::size_t bytes() const { return bytes_; }

private:
    void* data_ = nullptr;
    std::size_t bytes_ = 0;
};

class stream {
public:
    stream() { MYRIAD_GPU_CALL(gpu::create_stream(&stream_)); }
    stream(const stream&) = delete;
    stream& operator=(const stream&) = delete;
    ~stream() { gpu::destroy_stream(stream_); }
    gpu::stream_handle get() const { return stream_; }

private:
    gpu::stream_handle stream_ = nullptr;
};

/// A CUDA event; a `timed` one records when it is reached.
class event {
public:
    enum class kind { plain, timed };
    explicit event(kind k) { MYRIAD_GPU_CALL(gpu::create_event(&event_, k == kind::timed)); }
    event(const event&) = delete;
    event& operator=(const event&) = delete;
    ~event() { gpu::destroy_event(event_); }
    gpu::event_handle get() const { return event_; }

private:
    gpu::event_handle event_ = nullptr;
};

}  // namespace myriad::cuda
