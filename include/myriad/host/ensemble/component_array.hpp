// SPDX-License-Identifier: MIT
// Storage of an ensemble: a structure of arrays, contiguous per component, on its own pages, since memory is pinned by
// page. The memory is the library's own and not Eigen's, whose alignment depends on compiler flags.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "myriad/host/core/left_behind.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// `components` arrays of `size` values each, one after the other; component c of instance i is at `[c * size + i]`.
/// Compiled in the library, for the types below.
template <class T>
class component_array {
public:
    component_array() = default;
    component_array(int components, std::int64_t size, T value);
    /// The same with values that are not set, and pages that the system has not given yet.
    component_array(int components, std::int64_t size);
    component_array(component_array&&) noexcept = default;
    component_array& operator=(component_array&&) noexcept = default;

    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    int components() const { return components_; }
    std::int64_t length() const { return size_; }
    T* component(int c) { return data_.get() + c * size_; }
    const T* component(int c) const { return data_.get() + c * size_; }
    /// Sets every value.
    void fill(T value);
    /// Sets all components of instances [first, last), in the thread that calls it.
    void fill_instances(std::int64_t first, std::int64_t last, T value);
    /// Sets every value of component c.
    void fill_component(int c, T value);
    /// Pins the memory for its lifetime, for copies to and from GPUs. Further calls do nothing.
    void pin(int device);

private:
    struct release {
        std::size_t bytes = 0;
        bool pinned = false;
        void operator()(T* p) const;
    };
    using memory = std::unique_ptr<T[], release>;
    static void fill(T* values, std::int64_t count, T value);
    static memory allocate(std::size_t components, std::size_t size);

    host::moved_number<int> components_ = 0;
    host::moved_number<std::int64_t> size_ = 0;
    memory data_;
};

extern template class component_array<double>;
extern template class component_array<float>;
extern template class component_array<std::int64_t>;
extern template class component_array<std::int32_t>;
extern template class component_array<std::uint32_t>;
extern template class component_array<std::int16_t>;
extern template class component_array<std::uint8_t>;
extern template class component_array<status>;

}  // namespace myriad::host::inline MYRIAD_ABI
