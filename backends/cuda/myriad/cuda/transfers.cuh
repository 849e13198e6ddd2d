// SPDX-License-Identifier: MIT
// Copies between an ensemble's arrays on the host and a chunk on the device: directly where the host's memory is pinned, else
// through small pinned buffers that several threads fill and empty, since pinning everything would take longer than the copy.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "myriad/core/parallel.hpp"
#include "myriad/cuda/check.cuh"
#include "myriad/cuda/resources.cuh"

namespace myriad::cuda {

/// A chunk's part of an array: rows of `width` bytes, `pitch` apart on the host and side by side on the device.
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

/// Whether host memory is pinned; its first byte stands for all, as arrays are pinned as a whole.
inline bool is_pinned(const void* host) {
    cudaPointerAttributes facts{};
    MYRIAD_CUDA(cudaPointerGetAttributes(&facts, host));
    return facts.type == cudaMemoryTypeHost;
}

/// One copy for each array. The host's memory must be pinned.
inline void copy_directly(const row_list& list, cudaMemcpyKind way, cudaStream_t stream) {
    for (const array_rows& rows : list) {
        const bool up = way == cudaMemcpyHostToDevice;
        void *const to = up ? rows.device : rows.host, *const from = up ? rows.host : rows.device;
        if (rows.pitch == rows.width || rows.count == 1) {
            MYRIAD_CUDA(cudaMemcpyAsync(to, from, rows.width * rows.count, way, stream));
        } else {
            MYRIAD_CUDA(cudaMemcpy2DAsync(to, up ? rows.width : rows.pitch, from, up ? rows.pitch : rows.width,
                                          rows.width, rows.count, way, stream));
        }
    }
}

/// Copies through two pinned buffers, in pieces as large as one, of which each is a single transfer whatever arrays it holds.
class staged_transfer {
public:
    /// Arrays begin at multiples of it; what is between them is copied along.
    static constexpr std::size_t padding = 256;

    /// Takes the pinned memory for transfers of so many bytes, since that waits for all work of the device.
    void reserve(std::size_t bytes) {
        for (std::size_t i = 0; i < (bytes > largest ? buffers : 1); ++i) buffers_[i].make_room(std::min(bytes, largest));
    }
    /// The host's memory is free on return.
    void upload(const row_list& list, cudaStream_t stream) {
        finish_download();
        for (const piece& p : cut(list)) {
            buffer& b = buffers_[turn_++ % buffers];
            b.make_room(p.bytes);
            b.wait();
            exchange(p, b, [](std::byte* host, std::byte* staged, std::size_t n) { std::memcpy(staged, host, n); });
            MYRIAD_CUDA(cudaMemcpyAsync(p.device, b.data(), p.bytes, cudaMemcpyHostToDevice, stream));
            b.mark(stream);
        }
    }
    /// Asks for the first pieces, and returns.
    void begin_download(const row_list& list, cudaStream_t stream) {
        finish_download();
        std::vector<piece> pieces = cut(list);
        for (std::size_t i = 0; i < std::min(pieces.size(), buffers); ++i) ask(pieces[i], buffers_[i], stream);
        pieces_ = std::move(pieces);
        stream_ = stream;
    }
    /// To be called before the device changes what is downloaded: not all pieces may have been asked for.
    void finish_asking() {
        if (pieces_.size() > buffers) finish_download();
    }
    /// Waits for what `begin_download` began, and puts it in its place.
    void finish_download() {
        const std::vector<piece> pieces = std::exchange(pieces_, {});
        for (std::size_t done = 0; done < pieces.size(); ++done) {
            buffer& b = buffers_[done % buffers];
            b.wait();
            exchange(pieces[done], b, [](std::byte* host, std::byte* staged, std::size_t n) { std::memcpy(host, staged, n); });
            if (done + buffers < pieces.size()) ask(pieces[done + buffers], b, stream_);
        }
    }

private:
    static constexpr std::size_t buffers = 2, largest = std::size_t{4} << 20, smallest = std::size_t{64} << 10;
    /// A part of the device's memory, and those rows that it has a part of.
    struct piece {
        std::byte* device;
        std::size_t bytes;
        row_list rows;
    };

    class buffer {
    public:
        buffer() = default;
        buffer(const buffer&) = delete;
        buffer& operator=(const buffer&) = delete;
        ~buffer() { cudaFreeHost(data_); }
        /// What it held is lost if it grows.
        void make_room(std::size_t bytes) {
            if (bytes <= bytes_) return;
            wait();
            MYRIAD_CUDA(cudaFreeHost(std::exchange(data_, nullptr)));
            bytes_ = 0;
            const std::size_t wanted = bytes <= smallest ? smallest : largest;
            MYRIAD_CUDA(cudaHostAlloc(&data_, wanted, cudaHostAllocPortable));
            bytes_ = wanted;
        }
        std::byte* data() const { return static_cast<std::byte*>(data_); }
        void mark(cudaStream_t stream) { MYRIAD_CUDA(cudaEventRecord(copied_.get(), stream)); }
        void wait() { check(cudaEventSynchronize(copied_.get()), "the integration on the GPU"); }

    private:
        void* data_ = nullptr;
        std::size_t bytes_ = 0;
        event copied_{event::kind::plain};
    };

    static std::vector<piece> cut(const row_list& list) {
        std::vector<piece> pieces;
        for (const array_rows& rows : list) {
            std::byte* from = rows.device;
            while (from != rows.end()) {
                const bool joins = !pieces.empty() && from < end_of(pieces.back()) + padding &&
                                   from < pieces.back().device + largest;
                if (!joins) pieces.push_back({from, 0, {}});
                piece& p = pieces.back();
                from = std::min(rows.end(), p.device + largest);
                p.bytes = static_cast<std::size_t>(from - p.device);
                p.rows.push_back(rows);
            }
        }
        return pieces;
    }
    static std::byte* end_of(const piece& p) { return p.device + p.bytes; }

    /// Calls `copy(host, staged, bytes)` for all that the piece has of each row.
    template <class Copy>
    static void exchange(const piece& p, const buffer& b, Copy&& copy) {
        host::in_parallel(static_cast<std::int64_t>(p.bytes), 262'144, [&](std::int64_t first, std::int64_t last) {
            for (const array_rows& rows : p.rows) {
                std::byte* at = std::max(p.device + first, rows.device);
                std::byte* const end = std::min(p.device + last, rows.end());
                while (at < end) {
                    const auto offset = static_cast<std::size_t>(at - rows.device);
                    const std::size_t row = offset / rows.width, column = offset % rows.width;
                    const std::size_t n = std::min(rows.width - column, static_cast<std::size_t>(end - at));
                    copy(rows.host + row * rows.pitch + column, b.data() + (at - p.device), n);
                    at += n;
                }
            }
        });
    }

    static void ask(const piece& p, buffer& b, cudaStream_t stream) {
        b.make_room(p.bytes);
        MYRIAD_CUDA(cudaMemcpyAsync(b.data(), p.device, p.bytes, cudaMemcpyDeviceToHost, stream));
        b.mark(stream);
    }

    buffer buffers_[buffers];
    std::size_t turn_ = 0;
    std::vector<piece> pieces_;  // of the download under way
    cudaStream_t stream_ = nullptr;
};

}  // namespace myriad::cuda
