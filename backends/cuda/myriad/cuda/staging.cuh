// SPDX-License-Identifier: MIT
// Copies to and from a GPU through small pinned buffers, for host memory that is not pinned: pinning it all would take
// longer than the copy.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "myriad/cuda/check.cuh"
#include "myriad/cuda/resources.cuh"
#include "myriad/cuda/transfers.cuh"
#include "myriad/host/threads/object_pool.hpp"
#include "myriad/host/threads/parallel.hpp"

namespace myriad::cuda {

/// Pinned host memory.
class pinned_memory {
public:
    explicit pinned_memory(std::size_t bytes) {
        void* taken = nullptr;
        MYRIAD_GPU_CALL(gpu::allocate_pinned(&taken, bytes));
        data_ = static_cast<std::byte*>(taken);
    }
    pinned_memory(const pinned_memory&) = delete;
    pinned_memory& operator=(const pinned_memory&) = delete;
    ~pinned_memory() { gpu::release_pinned(data_); }
    std::byte* data() const { return data_; }

private:
    std::byte* data_ = nullptr;
};

/// For transfers so small that their number matters: as few as possible, through one buffer.
class little_transfer {
public:
    /// Most bytes in a transfer, without padding between arrays.
    static constexpr std::size_t most = 65'536;
    static bool takes(const row_list& list) { return bytes_of(list) <= most && list.size() <= most / piece::padding; }

    /// On return, the host memory may be reused.
    void upload(const row_list& list, gpu::stream_handle stream) {
        finish_download();
        check(gpu::synchronise(done_.get()), "an upload");
        std::byte* at = memory_.data();
        for (const piece& p : piece::cut(list, capacity)) {
            p.gather(at);
            MYRIAD_GPU_CALL(p.begin_upload(at, stream));
            at += p.bytes();
        }
        MYRIAD_GPU_CALL(gpu::record(done_.get(), stream));
    }
    void begin_download(const row_list& list, gpu::stream_handle stream) {
        finish_download();
        pieces_ = piece::cut(list, capacity);
        std::byte* at = memory_.data();
        for (const piece& p : pieces_) {
            MYRIAD_GPU_CALL(p.begin_download(at, stream));
            at += p.bytes();
        }
        MYRIAD_GPU_CALL(gpu::record(done_.get(), stream));
    }
    /// Waits for the download that `begin_download` started, and scatters its data.
    void finish_download() {
        const std::vector<piece> pieces = std::exchange(pieces_, {});
        if (pieces.empty()) return;
        check(gpu::synchronise(done_.get()), "the integration on the GPU");
        std::byte* at = memory_.data();
        for (const piece& p : pieces) {
            p.scatter(at);
            at += p.bytes();
        }
    }

private:
    static constexpr std::size_t capacity = 2 * most;

    pinned_memory memory_{capacity};
    event done_{event::kind::plain};
    std::vector<piece> pieces_;  // of the download in progress
};

/// For all other transfers: several threads, each filling or emptying its own two buffers independently, so that the
/// GPU copies one buffer meanwhile.
class staging {
public:
    explicit staging(int device) : device_(device) {
        for (std::size_t i = 0; i < buffers; ++i) buffers_[i].data = memory_.data() + i * largest;
    }

    /// On return, the host memory may be reused.
    void upload(const row_list& list, gpu::stream_handle stream) {
        each_piece(cut(list), [&](const piece& p, std::size_t, buffer& b) {
            if (const gpu::result status = b.wait(); status != gpu::result::success) return status;
            p.gather(b.data);
            const gpu::result status = p.begin_upload(b.data, stream);
            return status == gpu::result::success ? b.mark(stream) : status;
        });
    }
    /// Enqueues the first pieces and returns.
    void begin_download(const row_list& list, gpu::stream_handle stream) {
        for (buffer& b : buffers_) check(b.wait(), "a copy to the GPU");
        pieces_ = cut(list);
        stream_ = stream;
        for (std::size_t i = 0; i < std::min(pieces_.size(), buffers); ++i)
            check(ask(pieces_[i], buffers_[i]), "a download");
    }
    /// Whether all pieces are enqueued, so that later work in the same stream may overwrite the data.
    bool asked_for_all() const { return pieces_.size() <= buffers; }
    /// Waits for the download that `begin_download` started, and scatters its data.
    void finish_download() {
        const std::vector<piece> pieces = std::exchange(pieces_, {});
        check(buffers_[0].wait(), "the integration on the GPU");  // in one thread, as this may take long
        each_piece(pieces, [&](const piece& p, std::size_t i, buffer& b) {
            if (const gpu::result status = b.wait(); status != gpu::result::success) return status;
            p.scatter(b.data);
            return i + buffers < pieces.size() ? ask(pieces[i + buffers], b) : gpu::result::success;
        });
    }

private:
    static constexpr std::size_t workers = static_cast<std::size_t>(host::most_threads), buffers = 2 * workers,
                                 smallest = std::size_t{128} << 10, largest = std::size_t{1} << 20, unit = 4096;

    struct buffer {
        std::byte* data = nullptr;
        event copied{event::kind::plain};

        gpu::result mark(gpu::stream_handle stream) { return gpu::record(copied.get(), stream); }
        gpu::result wait() { return gpu::synchronise(copied.get()); }
    };

    /// Pieces large enough to saturate the bus, and equally many for each thread.
    static std::vector<piece> cut(const row_list& list) {
        const std::size_t bytes = bytes_of(list) + list.size() * piece::padding,
                          turns = (bytes - 1) / (workers * largest) + 1;
        const std::size_t each = bytes / (turns * workers) / unit * unit + unit;
        return piece::cut(list, std::clamp(each, smallest, largest));
    }

    /// Calls `work(piece, its number, its buffer)` for each piece, in several threads; pieces that share a buffer are
    /// handled by one thread, in order. Throws `error` if any call fails.
    template <class Work>
    void each_piece(const std::vector<piece>& pieces, Work&& work) {
        std::atomic<gpu::result> failed{gpu::result::success};
        const auto side_by_side = static_cast<std::int64_t>(std::min(workers, pieces.size()));
        host::in_parallel(side_by_side, 1, [&](std::int64_t first, std::int64_t last) {
            int before = device_;
            gpu::find_device(&before);
            gpu::set_device(device_);
            for (std::size_t turn = 0; turn < pieces.size(); turn += workers) {
                const std::size_t end = std::min(turn + static_cast<std::size_t>(last), pieces.size());
                for (std::size_t i = turn + static_cast<std::size_t>(first); i < end && failed == gpu::result::success;
                     ++i) {
                    const gpu::result status = work(pieces[i], i, buffers_[i % buffers]);
                    if (status != gpu::result::success) failed = status;
                }
            }
            gpu::set_device(before);
        });
        check(failed, "a copy to or from the GPU");
    }

    gpu::result ask(const piece& p, buffer& b) {
        const gpu::result status = p.begin_download(b.data, stream_);
        return status == gpu::result::success ? b.mark(stream_) : status;
    }

    int device_;
    pinned_memory memory_{buffers * largest};
    buffer buffers_[buffers];
    std::vector<piece> pieces_;  // of the download in progress
    gpu::stream_handle stream_ = nullptr;
};

/// Staging memory of a device, borrowed from a pool for one transfer; the pool grows to the number of concurrent
/// transfers.
class pooled_staging {
public:
    explicit pooled_staging(int device) : device_(device), taken_(idle::all().take(device)) {
        if (taken_ == nullptr) taken_ = std::make_unique<staging>(device);
    }
    pooled_staging(const pooled_staging&) = delete;
    pooled_staging& operator=(const pooled_staging&) = delete;
    ~pooled_staging() { idle::all().give(device_, std::move(taken_)); }
    staging* operator->() const { return taken_.get(); }

private:
    using idle = host::object_pool<int, staging>;

    int device_;
    std::unique_ptr<staging> taken_;
};

}  // namespace myriad::cuda
