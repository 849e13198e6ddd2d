// SPDX-License-Identifier: MIT
// Memory of the host for large arrays: on pages of its own, as memory is pinned by pages, and on huge ones where it fills some, of
// which the system clears fewer, and finds them faster. Host code only.
#pragma once

#include <cstddef>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace myriad::host {

constexpr std::size_t page_size(std::size_t bytes) {
    constexpr std::size_t page = 4096, huge = std::size_t{2} << 20;
    return bytes >= 2 * huge ? huge : page;
}

/// Null where there is too little.
inline void* new_pages(std::size_t bytes) {
    const std::size_t page = page_size(bytes);
    void* const memory = ::operator new(bytes, std::align_val_t{page}, std::nothrow);
#if defined(MADV_HUGEPAGE)
    // A wish, which the system may refuse.
    if (memory != nullptr && page > page_size(0)) madvise(memory, bytes / page * page, MADV_HUGEPAGE);
#endif
    return memory;
}
/// Of the same number of bytes.
inline void delete_pages(void* memory, std::size_t bytes) { ::operator delete(memory, std::align_val_t{page_size(bytes)}); }

}  // namespace myriad::host
