// SPDX-License-Identifier: MIT
// Loops of the host over all instances, which only move memory: by several threads, as one alone reaches a fraction of the
// memory's speed. Host code only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "myriad/core/instruction_set.hpp"
#include "myriad/core/weak.hpp"

namespace myriad {
namespace openmp {

/// Work in parts, for several threads.
struct team {
    void (*body)(void* context, int part);  ///< throws nothing
    void* context;
    int parts;              ///< from 0 on; the calling thread does part 0
    std::size_t stack = 0;  ///< bytes that it takes of a thread's stack, where they are many
    // What came of it:
    int threads = 1;              ///< that have shared the work
    std::size_t least_stack = 0;  ///< bytes that one of them has; if fewer than `stack`, nothing was done
};

#define MYRIAD_DECLARE_THREADS(set)                                                               \
    __attribute__((weak)) void in_parts(for_set<instruction_set::set>, team&);                    \
    __attribute__((weak)) int most_parts(for_set<instruction_set::set>);
/// `in_parts` has all parts done, each by a thread of its own as far as there are so many; `most_parts` are the threads
/// worth using, those that OpenMP would take. Weak: provided by the OpenMP backend, which is in every program with a kernel,
/// for the instruction sets that kernels are compiled for.
MYRIAD_DECLARE_THREADS(avx512)
MYRIAD_DECLARE_THREADS(avx2)
MYRIAD_DECLARE_THREADS(sse2)
MYRIAD_DECLARE_THREADS(generic)
#undef MYRIAD_DECLARE_THREADS

}  // namespace openmp

namespace host {

/// Enough to keep up with a GPU's bus.
inline constexpr std::int64_t most_threads = 5;

/// Of `available` threads those that a loop takes. A second one beside it gets as many, and two are left over: those of a team
/// wait for each other without sleeping, and one that has to wait for a core holds up all of them for milliseconds.
constexpr std::int64_t team_size(std::int64_t available) {
    return std::min(available, std::clamp(available / 2 - 1, std::int64_t{2}, most_threads));
}

/// What the OpenMP backend provides for this CPU; null if nothing.
struct lent_threads {
    void (*in_parts)(openmp::team&) = nullptr;
    int (*most_parts)() = nullptr;
};
template <openmp::instruction_set set>
lent_threads threads_for() {
    using tag = openmp::for_set<set>;
    void (*const compiled)(tag, openmp::team&) = &openmp::in_parts;
    if (!cpu_has(set) || if_defined(compiled) == nullptr) return {};
    return {[](openmp::team& all) { openmp::in_parts(tag{}, all); },
            [] { return openmp::most_parts(tag{}); }};
}
inline lent_threads lend_threads() {
    using openmp::instruction_set;
    for (const lent_threads& found : {threads_for<instruction_set::avx512>(), threads_for<instruction_set::avx2>(),
                                      threads_for<instruction_set::sse2>(), threads_for<instruction_set::generic>()})
        if (found.in_parts != nullptr) return found;
    return {};
}

/// Calls `body(first, last)` for parts that cover [0, size), side by side if there are several of at least `grain`. `body`
/// throws nothing. The team of threads is always of one size: OpenMP ends those that a smaller team does not need, and makes them
/// anew for a larger one.
template <class Body>
void in_parallel(std::int64_t size, std::int64_t grain, Body&& body) {
    static const lent_threads threads = lend_threads();
    const bool divides = size / grain > 1 && threads.in_parts != nullptr;
    const std::int64_t team = divides ? team_size(threads.most_parts()) : 1;
    struct whole {
        std::remove_reference_t<Body>* body;
        std::int64_t size, parts;
        std::int64_t begin(std::int64_t part) const { return size / parts * part + std::min(part, size % parts); }
    } all{&body, size, std::min(size / grain, team)};
    if (team == 1) {
        if (size > 0) body(std::int64_t{0}, size);
        return;
    }
    openmp::team members{[](void* context, int part) {
                          const auto& w = *static_cast<const whole*>(context);
                          if (part < w.parts) (*w.body)(w.begin(part), w.begin(part + 1));
                      },
                      &all, static_cast<int>(team)};
    threads.in_parts(members);
}

}  // namespace host
}  // namespace myriad
