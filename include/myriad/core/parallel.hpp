// SPDX-License-Identifier: MIT
// Loops of the host over all instances, which only move memory: by several threads, as one alone reaches a fraction of the
// memory's speed. Host code only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "myriad/core/weak.hpp"

namespace myriad {
namespace openmp {

/// Calls `body(context, part)` for every part from 0 on, each in a thread of its own. Weak: provided by the OpenMP backend,
/// which is in every program with a kernel.
__attribute__((weak)) void in_parts(int parts, void (*body)(void* context, int part), void* context);
/// Threads worth using: those that OpenMP would take.
__attribute__((weak)) int most_parts();

}  // namespace openmp

namespace host {

/// Meant to keep up with a GPU's bus, and to leave threads to a second loop beside this one.
inline constexpr std::int64_t most_threads = 8;

/// Calls `body(first, last)` for parts that cover [0, size), side by side if there are several of at least `grain`. `body`
/// throws nothing.
template <class Body>
void in_parallel(std::int64_t size, std::int64_t grain, Body&& body) {
    struct whole {
        std::remove_reference_t<Body>* body;
        std::int64_t size, parts;
        std::int64_t begin(std::int64_t part) const { return size / parts * part + std::min(part, size % parts); }
    } all{&body, size, std::min(size / grain, most_threads)};
    if (all.parts > 1 && if_defined(&openmp::in_parts) != nullptr)
        all.parts = std::min<std::int64_t>(all.parts, openmp::most_parts());
    if (all.parts <= 1 || if_defined(&openmp::in_parts) == nullptr) {
        if (size > 0) body(std::int64_t{0}, size);
        return;
    }
    openmp::in_parts(
        static_cast<int>(all.parts),
        [](void* context, int part) {
            const auto& w = *static_cast<const whole*>(context);
            (*w.body)(w.begin(part), w.begin(part + 1));
        },
        &all);
}

}  // namespace host
}  // namespace myriad
