// SPDX-License-Identifier: MIT
// The engine of the simulated GPU: one chunk in its own memory, and a thread as its stream, which integrates with the
// CPU's kernel.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include <myriad/host/threads/worker_thread.hpp>
#include <myriad/kernel/study/axis_rule.hpp>
#include <myriad/kernel/study/generator.hpp>
#include <myriad/kernel/study/reduced_values.hpp>
#include <myriad/myriad.hpp>

#include "tests/host/solve/simulated_gpu.hpp"

namespace simulated {

/// Components of an array: contiguous on the device, with a stride on the host.
struct rows {
    std::byte* host;
    std::size_t device, bytes, count, distance;

    void to_device(std::byte* memory) const {
        for (std::size_t r = 0; r < count; ++r) std::memcpy(memory + device + r * bytes, host + r * distance, bytes);
    }
    void to_host(const std::byte* memory) const {
        the_gpu.wrote = true;
        for (std::size_t r = 0; r < count; ++r) std::memcpy(host + r * distance, memory + device + r * bytes, bytes);
    }
};

/// Admits one thread to an engine at a time.
class turn {
public:
    explicit turn(unordered<bool>& taken) : taken_(taken) { demand(!(taken_ = true), "two threads are in one engine"); }
    turn(unordered<bool>& taken, call kind) : turn(taken) { the_gpu.meet(kind); }
    turn(const turn&) = delete;
    ~turn() { taken_ = false; }

private:
    unordered<bool>& taken_;
};

template <class Model, class Method, class R>
class engine final : public myriad::cuda::engine<R> {
    using arguments = myriad::detail::any_arguments<R>;
    using access = myriad::detail::array_access;
    using kind = myriad::detail::array_kind;
    using clock = std::chrono::steady_clock;
    using stop_request = myriad::detail::stop_request;

public:
    ~engine() override {
        if (asked_.valid()) asked_.wait();
        release();
    }

    void reserve(const arguments& host, std::int64_t count) override {
        const turn mine(taken_, call::reserve);
        grow(host, count);
    }
    void upload(const arguments& host, std::int64_t first, std::int64_t count, myriad::cuda::past past) override {
        const turn mine(taken_, call::upload);
        demand(under_way_ == 0 && !fetching_, "an upload to an engine at work");
        grow(host, count);
        first_ = first;
        count_ = count;
        shared_.assign(host.shared.real, host.shared.real + myriad::detail::n_shared<Model>);
        shared_integer_.assign(host.shared.integer, host.shared.integer + myriad::detail::n_shared_integer<Model>);
        std::vector<rows> pinned;
        walk(host, count, [&](auto* array, std::size_t at, std::int64_t components, access how, kind what) {
            if (how == access::write) return;
            const bool none = past == myriad::cuda::past::none && (what == kind::bookkeeping || what == kind::samples);
            if (none) return clear(array, &memory_[at], components * count, what);
            const rows all = rows_of(array, at, components, host.size);
            is_pinned(array) ? pinned.push_back(all) : all.to_device(memory_.get());
        });
        ask([=, this] {
            for (const rows& r : pinned) r.to_device(memory_.get());
        });
    }
    void integrate(const arguments& host) override {
        const turn mine(taken_, call::integrate);
        demand(count_ > 0, "nothing was uploaded to be integrated");
        asked_to_stop_ = stop_request::none;
        ask([=, this, now = host, first = first_, count = count_]() mutable {
            begun_ = started_;
            the_gpu.meet(call::kernel);
            walk(now, count, [&](auto*& array, std::size_t at, std::int64_t components, access how, kind what) {
                if (how == access::write) clear(array, &memory_[at], components * count, what);
                array = reinterpret_cast<std::remove_reference_t<decltype(array)>>(&memory_[at]);
            });
            now.size = count;
            now.first_index += first;
            now.shared = {shared_.data(), shared_integer_.data()};
            myriad::detail::run_options how{.threads = 1};
            how.stop = [](void* asked) -> stop_request { return *static_cast<unordered<stop_request>*>(asked); };
            how.context = &asked_to_stop_;
            myriad::openmp::run<Model, Method, R>(now, how);
            done_ = clock::now();
        });
    }
    void download(const arguments& host, bool (*wanted)(void*, kind, std::int64_t), void* context) override {
        const turn mine(taken_, call::download);
        demand(count_ > 0, "nothing was uploaded to be downloaded");
        finish_download();
        fetching_.emplace();
        std::vector<rows> pinned;
        walk(host, count_, [&](auto* array, std::size_t at, std::int64_t components, access how, kind what) {
            auto& list = is_pinned(array) ? pinned : *fetching_;
            for (std::int64_t c = 0; c < components && how != access::read; ++c)
                if (wanted == nullptr || wanted(context, what, c))
                    list.push_back(rows_of(array + c * host.size, at + bytes_of(array, c * count_), 1, host.size));
        });
        ask([=, this] {
            fetched_.assign(&memory_[0], &memory_[bytes_]);
            for (const rows& r : pinned) r.to_host(memory_.get());
        });
    }
    myriad::cuda::place_on_device find(const arguments& host, const void* value) override {
        const turn mine(taken_);
        myriad::cuda::place_on_device found;
        walk(host, count_, [&]<class T>(T* array, std::size_t at, std::int64_t components, access how, kind) {
            for (std::int64_t c = 0; c < components; ++c) {
                const T* const first = array + c * host.size + first_;
                const auto* const wanted = static_cast<const T*>(value);
                if (!std::less<>{}(wanted, first) && std::less<>{}(wanted, first + count_))
                    found = {&memory_[at] + bytes_of(array, c * count_ + (wanted - first)), how};
            }
        });
        return found;
    }
    void* native_stream() override { return this; }
    void generate(const arguments& host, std::shared_ptr<const myriad::cuda::generation> how, std::int64_t first,
                  std::int64_t count) override {
        const turn mine(taken_, call::upload);
        demand(!fetching_, "instances are generated while some are downloaded");
        grow(host, count);
        first_ = first;
        count_ = count;
        shared_.assign(host.shared.real, host.shared.real + myriad::detail::n_shared<Model>);
        shared_integer_.assign(host.shared.integer, host.shared.integer + myriad::detail::n_shared_integer<Model>);
        ask([=, this] { set(host, *how, first, count); });
    }
    void fetch(const arguments& host, const myriad::cuda::device_values& what, std::byte* to) override {
        const turn mine(taken_, call::download);
        std::vector<std::byte> drawn;
        const auto all = on_device(host, what, drawn);
        the_gpu.wrote = true;
        std::size_t bytes = 8;
        if (all.type == type::f32 || all.type == type::i32) bytes = 4;
        if (all.type == type::u8) bytes = 1;
        for (std::int64_t i = 0; i < all.size; ++i) {
            for (std::int64_t j = 0; j < all.inner; ++j, to += bytes) {
                const bool there = all.phases == nullptr || j < all.phases[i] - all.from_phase;
                const auto at = static_cast<std::size_t>(j * all.size + i);
                constexpr std::int32_t missing = std::numeric_limits<std::int32_t>::min() + 1;
                std::memcpy(to,
                            there ? static_cast<const std::byte*>(all.values) + at * bytes
                                  : reinterpret_cast<const std::byte*>(&missing),
                            bytes);
            }
        }
    }
    std::vector<std::int64_t> reduce(const arguments& host, const myriad::cuda::device_values& what,
                                     const myriad::cuda::device_reduction& how) override {
        const turn mine(taken_, call::download);
        using namespace myriad::detail;
        std::vector<std::byte> drawn;
        const auto all = on_device(host, what, drawn);
        const auto* const statuses = reinterpret_cast<const myriad::status*>(&memory_[place_of(host, host.status)]);
        std::vector<std::int64_t> words(static_cast<std::size_t>(how.words(all.inner)));
        const auto word = [&](std::int64_t w) -> std::int64_t& { return words[static_cast<std::size_t>(w)]; };
        for (std::int64_t i = all.size; i-- > 0;) {  // in another order than a CPU's
            if (how.kind == reduction_kind::statuses) ++word(static_cast<std::int64_t>(statuses[i]));
            if (how.kind == reduction_kind::statuses || is_failure(statuses[i])) continue;
            for (std::int64_t j = 0; j < all.inner; ++j) {
                const double value = value_at(all, i, j);
                if (how.kind == reduction_kind::histogram || how.kind == reduction_kind::histograms) {
                    const auto bins = static_cast<std::int64_t>(how.edges.size()) - 1;
                    const std::int64_t which = how.kind == reduction_kind::histograms ? j : 0;
                    ++word(which * (bins + 3) + place_in_histogram(value, how.edges.data(), bins));
                    continue;
                }
                if (!is_finite_number(value)) continue;
                const auto add = [&](std::int64_t sum, double number, int counted) {
                    const digits_of_number d = digits_of(number);
                    for (int k = 0; k < 3; ++k) word(sum * (sum_digits + 1) + d.first + k) += d.digit[k];
                    word(sum * (sum_digits + 1) + sum_digits) += counted;
                };
                if (how.kind == reduction_kind::sum || how.kind == reduction_kind::moments) {
                    add(j, value, 1);
                    const exact_square square = square_of(value);
                    if (how.kind == reduction_kind::sum || !square.is_known) continue;
                    add(all.inner + j, square.rounded, 1);
                    add(all.inner + j, square.rest, 0);
                } else {
                    const auto place = ordered(how.kind == reduction_kind::minimum ? -value : value);
                    word(j) = static_cast<std::int64_t>(std::max(static_cast<std::uint64_t>(word(j)), place));
                }
            }
        }
        return words;
    }
    void fetch_first(const arguments& host, std::int64_t count) override {
        const turn mine(taken_, call::download);
        synchronise();
        arguments to = host;
        std::size_t at = 0;
        for_each_array(to, [&](auto*& array, std::int64_t components, access, kind) {
            for (std::int64_t c = 0; c < components; ++c)
                std::memcpy(array + c * host.size, &memory_[at + bytes_of(array, c * count_)], bytes_of(array, count));
            at += (bytes_of(array, components * count_) + 63) / 64 * 64;
        });
    }
    void wait() override {
        const turn mine(taken_, call::wait);
        finish_download();
        synchronise();
    }
    bool idle() override { return under_way_ == 0 || the_gpu.seems_idle; }
    void stop(stop_request how) override { asked_to_stop_ = how; }
    void* mark() override {
        const turn mine(taken_);
        ask([] {});
        return &asked_;
    }
    void wait_for(myriad::cuda::work& other) override {
        const turn mine(taken_);
        ask([reached = *static_cast<std::shared_future<void>*>(other.mark())] { reached.wait(); });
    }
    double kernel_seconds() override {
        const auto [begin, end] = kernel_interval(&begun_);
        return end - begin;
    }
    typename myriad::cuda::engine<R>::interval kernel_interval(void* since) override {
        const turn mine(taken_);
        synchronise();
        const auto zero = *static_cast<clock::time_point*>(since);
        return {std::chrono::duration<double>(begun_ - zero).count(),
                std::chrono::duration<double>(done_ - zero).count()};
    }
    void* start_clock() override {
        clock_ = clock::now();
        return &clock_;
    }
    myriad::cuda::kernel_facts facts() const override { return {}; }
    std::int64_t full_load() const override { return 1; }
    std::int64_t affordable(std::int64_t bytes) const override {
        return (the_gpu.memory - the_gpu.used) * 9 / 10 / bytes;
    }
    void rest() override {
        const turn mine(taken_);
        demand(under_way_ == 0 && !fetching_, "an engine is to rest while it works");
        synchronise();
        release();
    }

private:
    using type = myriad::detail::value_type;

    void set(const arguments& host, const myriad::cuda::generation& how, std::int64_t first, std::int64_t count) {
        using namespace myriad::detail;
        arguments now = host;
        walk(now, count, [&](auto*& array, std::size_t at, std::int64_t components, access, kind what) {
            std::memset(&memory_[at], 0x5a, bytes_of(array, components * count));  // what was there before
            if (what == kind::bookkeeping || what == kind::samples)
                clear(array, &memory_[at], components * count, what);
            array = reinterpret_cast<std::remove_reference_t<decltype(array)>>(&memory_[at]);
        });
        now.size = count;
        now.first_index = host.first_index + first;
        const auto mark = [&](std::int64_t i) {
            now.ended[i] = 1;
            now.status[i] = myriad::status::invalid_input;
        };
        for (const myriad::cuda::generated_component& c : how.components) {
            arguments copy = host;
            walk(copy, count, [&](auto* array, std::size_t at, std::int64_t, access, kind) {
                if (array != c.array) return;
                using value_of = std::remove_cvref_t<decltype(*array)>;
                auto* const to = reinterpret_cast<value_of*>(&memory_[at]) + c.component * count;
                for (std::int64_t i = 0; i < count; ++i) {
                    to[i] = static_cast<value_of>(value_in_instance(c.rule, how.seed, now.first_index + i));
                    if constexpr (std::is_floating_point_v<value_of>) {
                        using valid = myriad::cuda::generated_component::valid;
                        if (c.must_be == valid::finite && !std::isfinite(to[i])) mark(i);
                        if (c.must_be == valid::not_nan && std::isnan(to[i])) mark(i);
                    }
                }
            });
        }
        if constexpr (generates<Model, R>) {
            for (std::int64_t i = 0; i < count && how.calls_model; ++i)
                if (!generate_instance<Model, R>(now, now, {shared_.data(), shared_integer_.data()}, how.seed, i))
                    mark(i);
        }
    }
    std::size_t place_of(const arguments& host, const void* array) {
        std::size_t found = bytes_;
        walk(host, count_, [&](auto* there, std::size_t at, std::int64_t, access, kind) {
            if (there == array) found = at;
        });
        demand(found < bytes_, "an array is not on the device");
        return found;
    }
    myriad::detail::value_array on_device(const arguments& host, const myriad::cuda::device_values& what,
                                          std::vector<std::byte>& drawn) {
        synchronise();
        myriad::detail::value_array all{nullptr, what.type, count_, what.inner};
        const std::size_t bytes = what.type == type::f32 || what.type == type::i32 ? 4 : what.type == type::u8 ? 1 : 8;
        if (what.rule != nullptr) {
            drawn.resize(static_cast<std::size_t>(count_) * bytes);
            for (std::int64_t i = 0; i < count_; ++i) {
                const double value =
                    myriad::detail::value_in_instance(*what.rule, what.seed, host.first_index + first_ + i);
                const auto rounded = static_cast<float>(value);
                std::memcpy(&drawn[static_cast<std::size_t>(i) * bytes],
                            bytes == 4 ? static_cast<const void*>(&rounded) : &value, bytes);
            }
            all.values = drawn.data();
        } else if (what.array != nullptr) {
            all.values =
                &memory_[place_of(host, what.array) + bytes * static_cast<std::size_t>(what.component * count_)];
        }
        if (what.ends_with_phases) {
            all.phases = reinterpret_cast<const std::int32_t*>(&memory_[place_of(host, host.phase)]);
            all.from_phase = what.from_phase;
        }
        return all;
    }

    /// Calls `visit(pointer, place on the device, components, access, kind)` for each array; returns the bytes of all.
    template <class Visit>
    static std::size_t walk(arguments& host, std::int64_t count, Visit&& visit) {
        std::size_t at = 0;
        const auto place = [&](auto*& array, std::int64_t components, access how, kind what) {
            const std::size_t bytes = bytes_of(array, components * count);
            visit(array, at, components, how, what);
            at += (bytes + 63) / 64 * 64;
        };
        for_each_array(host, place);
        for_each_record(host, place);
        return at;
    }
    template <class Visit>
    static std::size_t walk(const arguments& host, std::int64_t count, Visit&& visit) {
        arguments copy = host;
        return walk(copy, count, visit);
    }
    template <class T>
    static std::size_t bytes_of(T*, std::int64_t values) {
        return static_cast<std::size_t>(values) * sizeof(T);
    }
    template <class T>
    rows rows_of(T* host, std::size_t at, std::int64_t components, std::int64_t size) const {
        return {reinterpret_cast<std::byte*>(host + first_), at, bytes_of(host, count_),
                static_cast<std::size_t>(components), bytes_of(host, size)};
    }
    /// Bookkeeping is zero before the first call; where nothing was written, records and samples are NaN, integers
    /// zero.
    template <class T>
    static void clear(T* array, std::byte* begin, std::int64_t values, kind what) {
        const bool to_nan = std::is_floating_point_v<T> && what != kind::bookkeeping;
        std::memset(begin, to_nan ? 0xff : 0, bytes_of(array, values));
    }

    void grow(const arguments& host, std::int64_t count) {
        const std::size_t bytes = walk(host, count, [](auto&&...) {});
        if (bytes <= bytes_) return;
        const auto more = static_cast<std::int64_t>(bytes - bytes_);
        if (the_gpu.used + more > the_gpu.memory) throw myriad::out_of_memory("out of device memory: simulated");
        the_gpu.used += more;
        memory_ = std::make_unique_for_overwrite<std::byte[]>(bytes);
        bytes_ = bytes;
    }
    void release() {
        the_gpu.used += -static_cast<std::int64_t>(std::exchange(bytes_, 0));
        memory_.reset();
        count_ = 0;
    }

    /// Enqueues a task in the stream; after a failure the stream runs no further tasks.
    void ask(std::function<void()> task) {
        under_way_ += 1;
        the_gpu.under_way += 1;
        asked_ = stream_.ask([this, pause = pause(), task = std::move(task)] {
            started_ = clock::now();
            std::this_thread::sleep_for(pause);
            try {
                if (!failure_) task();
            } catch (...) {
                failure_ = std::current_exception();
            }
            the_gpu.under_way += -1;
            under_way_ += -1;
            if (failure_) std::rethrow_exception(failure_);
        });
    }
    std::chrono::microseconds pause() {
        random_ = (random_ + the_gpu.seed) * 6364136223846793005u + 1442695040888963407u;
        return std::chrono::microseconds(the_gpu.longest_delay == 0 ? 0 : (random_ >> 33) % the_gpu.longest_delay);
    }
    void synchronise() {
        if (asked_.valid()) asked_.get();
    }
    void finish_download() {
        const auto all = std::exchange(fetching_, std::nullopt);
        if (!all) return;
        synchronise();
        for (const rows& r : *all) r.to_host(fetched_.data());
    }

    unordered<stop_request> asked_to_stop_;
    unordered<bool> taken_;     // by a thread
    unordered<int> under_way_;  // in the stream
    std::uint64_t random_ = 0;
    std::int64_t first_ = 0, count_ = 0;
    std::size_t bytes_ = 0;
    std::optional<std::vector<rows>> fetching_;  // of the download in progress
    std::shared_future<void> asked_;             // the last task enqueued
    std::unique_ptr<std::byte[]> memory_;
    std::vector<std::byte> fetched_;
    std::vector<R> shared_;
    std::vector<std::int32_t> shared_integer_;
    std::exception_ptr failure_;
    clock::time_point clock_, started_, begun_, done_;
    myriad::host::worker_thread stream_;
};

}  // namespace simulated
