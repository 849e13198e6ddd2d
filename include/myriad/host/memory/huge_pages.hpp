// SPDX-License-Identifier: MIT
// Host memory for large arrays: on its own pages, since memory is pinned by page, and on huge pages where it is large
// enough, for fewer page faults and TLB misses. Host code only.
#pragma once

#include <cstddef>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>

#include "myriad/kernel/core/abi.hpp"
#endif

namespace myriad::host::inline MYRIAD_ABI {

constexpr std::size_t page_size(std::size_t bytes) {
    constexpr std::size_t page = 4096, huge = std::size_t{2} << 20;
    return bytes >= 2 * huge ? huge : page;
}

/// Null if there is too little memory.
inline void* new_pages(std::size_t bytes) {
    const std::size_t page = page_size(bytes);
    void* const memory = ::operator new (bytes, std::align_val_t{page}, std::nothrow);
#if defined(MADV_HUGEPAGE)
    // A hint, which the system may ignore.
    if (memory != nullptr && page > page_size(0)) madvise(memory, bytes / page * page, MADV_HUGEPAGE);
#endif
    return memory;
}
/// `bytes` must be as in `new_pages`.
inline void delete_pages(void* memory, std::size_t bytes) {
    ::operator delete (memory, std::align_val_t{page_size(bytes)});
}

}  // namespace myriad::host::inline MYRIAD_ABI
