// SPDX-License-Identifier: MIT
// Storage of ensembles, for every type of value that they hold.
#include "myriad/host/ensemble/component_array.hpp"

#include <algorithm>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "myriad/host/core/error.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/memory/pinned.hpp"
#include "myriad/host/threads/parallel.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

/// Large arrays lie on their own pages, since memory is pinned by page, and on huge pages where they are large enough,
/// for fewer page faults and TLB misses.
constexpr std::size_t page_size(std::size_t bytes) {
    constexpr std::size_t page = 4096, huge = std::size_t{2} << 20;
    return bytes >= 2 * huge ? huge : page;
}

/// Null if there is too little memory.
void* new_pages(std::size_t bytes) {
    const std::size_t page = page_size(bytes);
    void* const memory = ::operator new (bytes, std::align_val_t{page}, std::nothrow);
#if defined(MADV_HUGEPAGE)
    // A hint, which the system may ignore.
    if (memory != nullptr && page > page_size(0)) madvise(memory, bytes / page * page, MADV_HUGEPAGE);
#endif
    return memory;
}
/// `bytes` must be as in `new_pages`.
void delete_pages(void* memory, std::size_t bytes) { ::operator delete (memory, std::align_val_t{page_size(bytes)}); }

}  // namespace

template <class T>
component_array<T>::component_array(int components, std::int64_t size)
    : size_(size), data_(allocate(static_cast<std::size_t>(components), static_cast<std::size_t>(size))) {
    components_ = components;
}
template <class T>
component_array<T>::component_array(int components, std::int64_t size, T value) : component_array(components, size) {
    fill(value);
}
template <class T>
void component_array<T>::fill(T value) {
    fill(data_.get(), components_ * size_, value);
}
template <class T>
void component_array<T>::fill_instances(std::int64_t first, std::int64_t last, T value) {
    for (int c = 0; c < components_; ++c) std::fill(component(c) + first, component(c) + last, value);
}
template <class T>
void component_array<T>::fill_component(int c, T value) {
    fill(component(c), size_, value);
}
template <class T>
void component_array<T>::pin(int device) {
    if (data_ == nullptr || data_.get_deleter().pinned) return;
    pin_memory(device, data(), static_cast<std::size_t>(components_ * size_) * sizeof(T));
    data_.get_deleter().pinned = true;
}
template <class T>
void component_array<T>::fill(T* values, std::int64_t count, T value) {
    constexpr std::int64_t grain = 262'144 / static_cast<std::int64_t>(sizeof(T));
    in_parallel(count, grain, [=](std::int64_t first, std::int64_t last) {
        std::uninitialized_fill(values + first, values + last, value);
    });
}
template <class T>
void component_array<T>::release::operator()(T* p) const {
    if (pinned) unpin_memory(p);
    delete_pages(p, bytes);
}
template <class T>
typename component_array<T>::memory component_array<T>::allocate(std::size_t components, std::size_t size) {
    if (components == 0 || size == 0) return nullptr;
    const double wanted = static_cast<double>(components) * static_cast<double>(size) * sizeof(T);
    memory_need need;
    need.add("values", wanted);
    need.check(message(components, " components of ", size, " values"), cures::smaller_parts);
    const std::size_t bytes = components * size * sizeof(T);
    void* const found = wanted > 9e18 ? nullptr : new_pages(bytes);
    if (found == nullptr)
        throw out_of_memory(statement_of("out of memory: ", bytes_text(wanted), " are wanted for ", components,
                                         " components of ", size, " values", cure, cures::smaller_parts));
    return memory(static_cast<T*>(found), release{bytes});
}

template class component_array<double>;
template class component_array<float>;
template class component_array<std::int64_t>;
template class component_array<std::int32_t>;
template class component_array<std::uint32_t>;
template class component_array<std::int16_t>;
template class component_array<std::uint8_t>;
template class component_array<status>;

}  // namespace myriad::host::inline MYRIAD_ABI
