// SPDX-License-Identifier: MIT
// A range of a grid's places as boxes, which netCDF writes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

// Calls f(start, lengths) for boxes that have the places [first, first + count) of a grid, in their order: each is as
// large as the place where it begins and the rest allow.
template <class F>
void for_boxes(const std::vector<std::size_t>& lengths, std::size_t first, std::size_t count, F f) {
    while (count > 0) {
        // A box has the dimensions from `whole` on as they are, and a part of the one before.
        std::size_t whole = lengths.size(), inner = 1;
        const auto fits = [&](std::size_t size) { return first % size == 0 && count >= size; };
        while (whole > 0 && fits(inner * lengths[whole - 1])) inner *= lengths[--whole];
        std::vector<std::size_t> start(lengths.size(), 0), box(lengths);
        std::size_t place = first / inner, places = 1;
        if (whole > 0) places = std::min(count / inner, lengths[whole - 1] - place % lengths[whole - 1]);
        for (std::size_t d = whole; d-- > 0; place /= lengths[d]) {
            start[d] = place % lengths[d];
            box[d] = d + 1 == whole ? places : 1;
        }
        f(start, box);
        first += places * inner;
        count -= places * inner;
    }
}

}  // namespace myriad::studies::inline MYRIAD_ABI
