// SPDX-License-Identifier: MIT
// Copies between an ensemble's arrays on the host and a chunk on the device: the rows to copy, copied directly if the
// host memory is pinned, or cut into pieces that are copied through pinned buffers (cuda/staging.cuh).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "myriad/cuda/check.cuh"

namespace myriad::cuda {

/// A chunk's part of an array: rows of `width` bytes, `pitch` apart on the host and contiguous on the device.
struct array_rows {
    std::byte* host;
    std::byte* device;
    std::size_t width, count, pitch;

    std::byte* end() const { return device + width * count; }
};

/// In ascending order on the device.
using row_list = std::vector<array_rows>;

inline std::size_t bytes_of(const row_list& list) {
    std::size_t bytes = 0;
    for (const array_rows& rows : list) bytes += rows.width * rows.count;
    return bytes;
}

/// Whether host memory is pinned. Testing its first byte is enough, as arrays are pinned as a whole.
inline bool is_pinned(const void* host) {
    bool pinned = false;
    MYRIAD_GPU_CALL(gpu::find_pinned(&pinned, host));
    return pinned;
}

/// One copy per array. The host memory must be pinned.
inline void copy_directly(const row_list& list, gpu::direction way, gpu::stream_handle stream) {
    for (const array_rows& rows : list) {
        const bool up = way == gpu::direction::to_device;
        void *const to = up ? rows.device : rows.host, *const from = up ? rows.host : rows.device;
        if (rows.pitch == rows.width || rows.count == 1) {
            MYRIAD_GPU_CALL(gpu::copy(to, from, rows.width * rows.count, way, stream));
        } else {
            MYRIAD_GPU_CALL(gpu::copy_rows(to, up ? rows.width : rows.pitch, from, up ? rows.pitch : rows.width,
                                           rows.width, rows.count, way, stream));
        }
    }
}

/// A part of device memory copied in one transfer, whatever arrays it covers, and the rows that overlap it.
class piece {
public:
    /// Arrays on the device begin at multiples of this; the padding between them is copied too.
    static constexpr std::size_t padding = 256;

    static std::vector<piece> cut(const row_list& list, std::size_t largest) {
        std::vector<piece> pieces;
        for (const array_rows& rows : list) {
            std::byte* from = rows.device;
            while (from != rows.end()) {
                const bool joins =
                    !pieces.empty() && from < pieces.back().end() + padding && from < pieces.back().device_ + largest;
                if (!joins) pieces.push_back(piece(from));
                piece& p = pieces.back();
                from = std::min(rows.end(), p.device_ + largest);
                p.bytes_ = static_cast<std::size_t>(from - p.device_);
                p.rows_.push_back(rows);
            }
        }
        return pieces;
    }

    std::size_t bytes() const { return bytes_; }
    /// Copy from the host arrays to a buffer, and back.
    void gather(std::byte* buffer) const {
        each_run(buffer, [](std::byte* host, std::byte* staged, std::size_t n) { std::memcpy(staged, host, n); });
    }
    void scatter(std::byte* buffer) const {
        each_run(buffer, [](std::byte* host, std::byte* staged, std::size_t n) { copy_past_caches(host, staged, n); });
    }
    /// Copy from a pinned buffer to the device, and back.
    gpu::result begin_upload(const std::byte* buffer, gpu::stream_handle stream) const {
        return gpu::copy(device_, buffer, bytes_, gpu::direction::to_device, stream);
    }
    gpu::result begin_download(std::byte* buffer, gpu::stream_handle stream) const {
        return gpu::copy(buffer, device_, bytes_, gpu::direction::to_host, stream);
    }

private:
    explicit piece(std::byte* device) : device_(device) {}
    std::byte* end() const { return device_ + bytes_; }

    /// Calls `copy(host, staged, bytes)` for the part of each row that the piece covers.
    template <class Copy>
    void each_run(std::byte* buffer, Copy&& copy) const {
        for (const array_rows& rows : rows_) {
            std::byte* at = std::max(device_, rows.device);
            std::byte* const last = std::min(end(), rows.end());
            while (at < last) {
                const auto offset = static_cast<std::size_t>(at - rows.device);
                const std::size_t row = offset / rows.width, column = offset % rows.width;
                const std::size_t n = std::min(rows.width - column, static_cast<std::size_t>(last - at));
                copy(rows.host + row * rows.pitch + column, buffer + (at - device_), n);
                at += n;
            }
        }
    }
    /// Writes results with non-temporal stores, which do not read the old contents into the cache as memcpy would.
    static void copy_past_caches(std::byte* to, const std::byte* from, std::size_t bytes) {
#if defined(__SSE2__)
        constexpr std::size_t line = 64, part = sizeof(__m128i), worthwhile = 32 * line;
        if (bytes >= worthwhile) {
            const std::size_t before = (line - reinterpret_cast<std::uintptr_t>(to) % line) % line;
            std::memcpy(to, from, before);
            to += before;
            from += before;
            bytes -= before;
            for (; bytes >= line; to += line, from += line, bytes -= line)
                for (std::size_t k = 0; k < line; k += part)
                    _mm_stream_si128(reinterpret_cast<__m128i*>(to + k),
                                     _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + k)));
            _mm_sfence();
        }
#endif
        std::memcpy(to, from, bytes);
    }

    std::byte* device_;
    std::size_t bytes_ = 0;
    row_list rows_;
};

}  // namespace myriad::cuda
