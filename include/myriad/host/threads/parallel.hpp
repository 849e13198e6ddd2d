// SPDX-License-Identifier: MIT
// Memory-bound host loops over all instances: by several threads, as one alone reaches a fraction of the memory
// bandwidth. Host code only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "myriad/host/core/instruction_set.hpp"
#include "myriad/host/core/weak.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad {
namespace openmp {

/// Work divided into parts, for several threads.
struct team {
    void (*body)(void* context, int part);  ///< throws nothing
    void* context;
    int parts;              ///< numbered from 0; the calling thread does part 0
    std::size_t stack = 0;  ///< bytes of stack that a thread needs, if that is much
    // Results:
    int threads = 1;              ///< that took part
    std::size_t least_stack = 0;  ///< least stack of any of them; if less than `stack`, nothing was done
};

#define MYRIAD_DECLARE_THREADS(set)                                            \
    __attribute__((weak)) void in_parts(for_set<instruction_set::set>, team&); \
    __attribute__((weak)) int most_parts(for_set<instruction_set::set>);
/// `in_parts` runs all parts, each in its own thread as far as there are enough; `most_parts` is the number of threads
/// worth using, which OpenMP would use. Weak: provided by the OpenMP backend, which is in every program with a kernel,
/// for the instruction sets that kernels are compiled for.
MYRIAD_DECLARE_THREADS(avx512)
MYRIAD_DECLARE_THREADS(avx2)
MYRIAD_DECLARE_THREADS(sse2)
MYRIAD_DECLARE_THREADS(generic)
#undef MYRIAD_DECLARE_THREADS

}  // namespace openmp

namespace host::inline MYRIAD_ABI {

/// Enough to keep up with a GPU's bus.
inline constexpr std::int64_t most_threads = 5;

/// Number of the `available` threads that a loop uses. A second, concurrent loop gets as many, and two are left over:
/// the threads of a team spin while they wait for each other, and one that has to wait for a core delays all of them by
/// milliseconds.
constexpr std::int64_t team_size(std::int64_t available) {
    return std::min(available, std::clamp(available / 2 - 1, std::int64_t{2}, most_threads));
}

/// The OpenMP backend's functions for this CPU; null if there are none.
struct lent_threads {
    void (*in_parts)(openmp::team&) = nullptr;
    int (*most_parts)() = nullptr;
};
template <openmp::instruction_set set>
lent_threads threads_for() {
    using tag = openmp::for_set<set>;
    void (*const compiled)(tag, openmp::team&) = &openmp::in_parts;
    if (!cpu_has(set) || if_defined(compiled) == nullptr) return {};
    return {[](openmp::team& all) { openmp::in_parts(tag{}, all); }, [] { return openmp::most_parts(tag{}); }};
}
inline lent_threads lend_threads() {
    using openmp::instruction_set;
    for (const lent_threads& found : {threads_for<instruction_set::avx512>(), threads_for<instruction_set::avx2>(),
                                      threads_for<instruction_set::sse2>(), threads_for<instruction_set::generic>()})
        if (found.in_parts != nullptr) return found;
    return {};
}

/// Calls `body(first, last)` for parts that cover [0, size), in parallel if there are several of at least `grain`.
/// `body` must not throw. The team always has the same size: OpenMP ends threads that a smaller team does not need, and
/// creates them again for a larger one.
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

}  // namespace host::inline MYRIAD_ABI
}  // namespace myriad
