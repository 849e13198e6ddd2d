// SPDX-License-Identifier: MIT
// The kernels that set the instances of a study before they are integrated, and reduce what is kept of them after.
#pragma once

#include <cstdint>

#include "myriad/cuda/generate_kernel.cuh"
#include "myriad/cuda/study_arguments.hpp"
#include "myriad/kernel/study/axis_rule.hpp"
#include "myriad/kernel/study/reduced_values.hpp"

// Templates, so that every file that includes this may have them, or, compiled at run time, found by their names.
#if defined(MYRIAD_COMPILED_AT_RUN_TIME)
#define MYRIAD_STUDY_KERNEL extern "C" __global__
#else
#define MYRIAD_STUDY_KERNEL \
    template <class = void> \
    __global__
#endif

namespace myriad::detail::inline MYRIAD_TARGET {

MYRIAD_STUDY_KERNEL void fill_components(const __grid_constant__ fill_arguments all) {
    for (std::int64_t i = thread_number(); i < all.size; i += all_threads()) {
        bool valid = true;
        for (int c = 0; c < all.count; ++c) {
            const filled_component& is = all.components[c];
            double value = detail::value_in_instance(is.rule, all.seed, all.first + i);
            if (is.type == value_type::f32) {
                const auto rounded = static_cast<float>(value);
                static_cast<float*>(is.to)[i] = rounded;
                value = static_cast<double>(rounded);
            } else if (is.type == value_type::f64) {
                static_cast<double*>(is.to)[i] = value;
            } else {
                static_cast<std::int32_t*>(is.to)[i] = static_cast<std::int32_t>(value);
            }
            if (is.must_be_finite) valid = valid && detail::is_finite_number(value);
            if (is.must_not_be_nan) valid = valid && value == value;
        }
        if (!valid && all.ended != nullptr) mark_invalid(all.ended, all.how, i);
    }
}

template <class T>
__device__ __forceinline__ void gather(const value_array& all, T fill, void* gathered) {
    const auto* const from = static_cast<const T*>(all.values);
    auto* const to = static_cast<T*>(gathered);
    for (std::int64_t i = thread_number(); i < all.size; i += all_threads()) {
        const std::int64_t there = all.phases != nullptr ? all.phases[i] - all.from_phase : all.inner;
        for (std::int64_t j = 0; j < all.inner; ++j) to[i * all.inner + j] = j < there ? from[j * all.size + i] : fill;
    }
}
/// From one component after the other to one instance after the other, values of so many bytes; what has no value gets
/// `fill`, if it is of 4 bytes.
MYRIAD_STUDY_KERNEL void gather_values(const value_array all, const std::int32_t fill, const int bytes, void* to) {
    if (bytes == 8) return detail::gather<std::int64_t>(all, fill, to);
    if (bytes == 4) return detail::gather<std::int32_t>(all, fill, to);
    detail::gather<std::int8_t>(all, static_cast<std::int8_t>(fill), to);
}

/// The exact sum of a thread's numbers, whose digits are mostly the same few.
class thread_sum {
public:
    __device__ explicit thread_sum(unsigned long long* to) : to_(to) {}
    __device__ void add(double value) {
        add_rest(value);
        ++count_;
    }
    /// What belongs to a number that was added.
    __device__ void add_rest(double value) {
        const digits_of_number digits = detail::digits_of(value);
        if (digits.first != first_) {
            flush();
            first_ = digits.first;
        }
        for (int k = 0; k < 3; ++k) digit_[k] += digits.digit[k];
    }
    __device__ void flush() {
        for (int k = 0; k < 3; ++k) {
            if (digit_[k] != 0) atomicAdd(to_ + first_ + k, static_cast<unsigned long long>(digit_[k]));
            digit_[k] = 0;
        }
    }
    __device__ unsigned count() const { return count_; }

private:
    unsigned long long* to_;
    int first_ = 0;
    unsigned count_ = 0;
    std::int64_t digit_[3] = {};
};

extern __shared__ unsigned long long reduced_in_block[];

/// Adds inner values [from, to) of the instances of this block's threads to a histogram.
__device__ inline void count_values(const reduce_arguments& a, std::int64_t from, std::int64_t to,
                                    unsigned long long* histogram) {
    const std::int64_t words = a.bins + 3;
    auto* const counts = reinterpret_cast<unsigned*>(reduced_in_block);
    if (a.in_shared_memory) {
        for (std::int64_t w = threadIdx.x; w < words; w += blockDim.x) counts[w] = 0;
        __syncthreads();
    }
    for (std::int64_t i = thread_number(); i < a.all.size; i += all_threads()) {
        if (is_failure(a.how[i])) continue;
        for (std::int64_t j = from; j < to; ++j) {
            const std::int64_t place = detail::place_in_histogram(detail::value_at(a.all, i, j), a.edges, a.bins);
            if (a.in_shared_memory) {
                atomicAdd(counts + place, 1u);
            } else {
                atomicAdd(histogram + place, 1ull);
            }
        }
    }
    if (!a.in_shared_memory) return;
    __syncthreads();
    for (std::int64_t w = threadIdx.x; w < words; w += blockDim.x)
        if (counts[w] != 0) atomicAdd(histogram + w, static_cast<unsigned long long>(counts[w]));
    __syncthreads();
}

MYRIAD_STUDY_KERNEL void reduce_values(const __grid_constant__ reduce_arguments a) {
    if (a.kind == reduction_kind::histogram) return detail::count_values(a, 0, a.all.inner, a.to);
    if (a.kind == reduction_kind::histograms) {
        for (std::int64_t j = blockIdx.y; j < a.all.inner; j += gridDim.y)
            detail::count_values(a, j, j + 1, a.to + j * (a.bins + 3));
        return;
    }
    if (a.kind == reduction_kind::statuses) {
        if (threadIdx.x < status_count) reduced_in_block[threadIdx.x] = 0;
        __syncthreads();
        for (std::int64_t i = thread_number(); i < a.all.size; i += all_threads())
            atomicAdd(reduced_in_block + static_cast<int>(a.how[i]), 1ull);
        __syncthreads();
        if (threadIdx.x < status_count) atomicAdd(a.to + threadIdx.x, reduced_in_block[threadIdx.x]);
        return;
    }
    constexpr int words_of_sum = sum_digits + 1;
    const std::int64_t inner = a.all.inner, all_inner = a.kind == reduction_kind::moments ? 2 * inner : inner;
    for (std::int64_t j = blockIdx.y; j < all_inner; j += gridDim.y) {
        const bool is_sum = a.kind == reduction_kind::sum || a.kind == reduction_kind::moments;
        const bool squares = j >= inner;
        const int words = is_sum ? words_of_sum : 1;
        for (int w = static_cast<int>(threadIdx.x); w < words; w += static_cast<int>(blockDim.x))
            reduced_in_block[w] = 0;
        __syncthreads();
        thread_sum sum(reduced_in_block);
        unsigned long long most = 0;
        for (std::int64_t i = thread_number(); i < a.all.size; i += all_threads()) {
            if (is_failure(a.how[i])) continue;
            const double value = detail::value_at(a.all, i, squares ? j - inner : j);
            if (!detail::is_finite_number(value)) continue;
            if (squares) {
                const exact_square square = detail::square_of(value);
                if (!square.is_known) continue;
                sum.add(square.rounded);
                sum.add_rest(square.rest);
            } else if (is_sum) {
                sum.add(value);
            } else {
                const std::uint64_t place = detail::ordered(a.kind == reduction_kind::minimum ? -value : value);
                most = place > most ? place : most;
            }
        }
        if (is_sum) {
            sum.flush();
            if (sum.count() > 0) atomicAdd(reduced_in_block + sum_digits, static_cast<unsigned long long>(sum.count()));
        } else if (most > 0) {
            atomicMax(reduced_in_block, most);
        }
        __syncthreads();
        for (int w = static_cast<int>(threadIdx.x); w < words; w += static_cast<int>(blockDim.x)) {
            if (reduced_in_block[w] == 0) continue;
            if (is_sum) {
                atomicAdd(a.to + j * words_of_sum + w, reduced_in_block[w]);
            } else {
                atomicMax(a.to + j, reduced_in_block[w]);
            }
        }
        __syncthreads();
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
