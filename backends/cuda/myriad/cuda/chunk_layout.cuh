// SPDX-License-Identifier: MIT
// The layout of a chunk's arrays in device memory: contiguous, in the order of host/backend/arrays.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "myriad/cuda/transfers.cuh"
#include "myriad/host/backend/arrays.hpp"

namespace myriad::cuda {

template <class T>
std::size_t bytes_of(const T*, std::int64_t values) {
    return static_cast<std::size_t>(values) * sizeof(T);
}

/// Bytes of an array, rounded up to align the next one with memory transactions.
inline std::size_t padded(std::int64_t values, std::size_t element) {
    constexpr std::size_t unit = piece::padding;
    return (static_cast<std::size_t>(values) * element + unit - 1) / unit * unit;
}

/// Bytes of all arrays that `each` visits, for `count` instances.
template <class Each>
std::size_t bytes_for(std::int64_t count, Each&& each) {
    std::size_t bytes = 0;
    each([&](auto* array, std::int64_t components, array_access, array_kind) {
        bytes += padded(components * count, sizeof(*array));
    });
    return bytes == 0 ? 0 : bytes + piece::padding;  // so that no copy spans two allocations
}

/// For `for_each_array` and `for_each_record`: calls `visit(host pointer, device pointer, components, access, kind)`
/// for each array; the first is placed at `next`.
template <class Visit>
auto placing(std::byte*& next, std::int64_t count, Visit&& visit) {
    return [&next, &visit, count](auto*& array, std::int64_t components, array_access access, array_kind kind) {
        auto* const here = reinterpret_cast<std::remove_reference_t<decltype(array)>>(next);
        next += padded(components * count, sizeof(*array));
        visit(array, here, components, access, kind);
    };
}

}  // namespace myriad::cuda
