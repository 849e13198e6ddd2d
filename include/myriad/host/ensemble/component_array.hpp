// SPDX-License-Identifier: MIT
// Storage of an ensemble: a structure of arrays, contiguous per component, on its own pages, since memory is pinned by
// page. The memory is the library's own and not Eigen's, whose alignment depends on compiler flags.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "myriad/host/core/error.hpp"
#include "myriad/host/core/left_behind.hpp"
#include "myriad/host/memory/huge_pages.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/memory/pinned.hpp"
#include "myriad/host/threads/parallel.hpp"

namespace myriad::host {

/// `components` arrays of `size` values each, one after the other; component c of instance i is at `[c * size + i]`.
template <class T>
class component_array {
public:
    component_array() = default;
    component_array(int components, std::int64_t size, T value)
        : size_(size), data_(allocate(static_cast<std::size_t>(components), static_cast<std::size_t>(size))) {
        components_ = components;
        fill(value);
    }
    component_array(component_array&&) noexcept = default;
    component_array& operator=(component_array&&) noexcept = default;

    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    int components() const { return components_; }
    std::int64_t length() const { return size_; }
    T* component(int c) { return data_.get() + c * size_; }
    const T* component(int c) const { return data_.get() + c * size_; }
    /// Sets every value.
    void fill(T value) { fill(data_.get(), components_ * size_, value); }
    /// Sets all components of instances [first, last), in the thread that calls it.
    void fill_instances(std::int64_t first, std::int64_t last, T value) {
        for (int c = 0; c < components_; ++c) std::fill(component(c) + first, component(c) + last, value);
    }
    /// Sets every value of component c.
    void fill_component(int c, T value) { fill(component(c), size_, value); }
    /// Pins the memory for its lifetime, for copies to and from GPUs. Further calls do nothing.
    void pin(int device) {
        if (data_ == nullptr || data_.get_deleter().pinned) return;
        host::pin_memory(device, data(), static_cast<std::size_t>(components_ * size_) * sizeof(T));
        data_.get_deleter().pinned = true;
    }

private:
    static void fill(T* values, std::int64_t count, T value) {
        constexpr std::int64_t grain = 262'144 / static_cast<std::int64_t>(sizeof(T));
        host::in_parallel(count, grain, [=](std::int64_t first, std::int64_t last) {
            std::uninitialized_fill(values + first, values + last, value);
        });
    }
    struct release {
        std::size_t bytes = 0;
        bool pinned = false;
        void operator()(T* p) const {
            if (pinned) host::unpin_memory(p);
            host::delete_pages(p, bytes);
        }
    };
    using memory = std::unique_ptr<T[], release>;
    static memory allocate(std::size_t components, std::size_t size) {
        if (components == 0 || size == 0) return nullptr;
        const double wanted = static_cast<double>(components) * static_cast<double>(size) * sizeof(T);
        const char* const advice = "integrate the ensemble in smaller parts";
        host::memory_need need;
        need.add("values", wanted);
        need.check(message(components, " components of ", size, " values"), advice);
        const std::size_t bytes = components * size * sizeof(T);
        void* const found = wanted > 9e18 ? nullptr : host::new_pages(bytes);
        require(found != nullptr, "out of memory: ", host::bytes_text(wanted), " are wanted for ", components,
                " components of ", size, " values: ", advice);
        return memory(static_cast<T*>(found), release{bytes});
    }

    host::moved_number<int> components_ = 0;
    host::moved_number<std::int64_t> size_ = 0;
    memory data_;
};

}  // namespace myriad::host
