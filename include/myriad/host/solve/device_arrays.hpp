// SPDX-License-Identifier: MIT
// The values of a solver's instances where its device has them, for kernels and libraries of users.
#pragma once

#include <cstdint>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"

namespace myriad {

/// Addresses in the memory of a solver's device, of `size()` values each, instance 0 first: memory of a GPU, or, where
/// the device is the CPU, that of the solver's ensemble. They hold until the solver's next `upload`. Made by
/// `solver::on_device`.
template <class Model, class R>
class device_arrays {
public:
    device_arrays(host::ensemble_data<R>& data, std::int64_t size, const detail::any_arguments<R>& arguments,
                  cuda::engine<R>* engine)
        : data_(data), size_(size), arguments_(arguments), engine_(engine) {}

    /// The number of instances, those that were uploaded last.
    std::int64_t size() const { return size_; }
    /// State component c. Throws `error` if the model has none of that number, as all of these do.
    template <class C>
    R* state(C c) const {
        return find(data_.state.component(host::state_numbering<Model>::find(c).number));
    }
    /// Parameter c.
    template <class C>
    R* parameter(C c) const {
        return find(data_.parameter.component(host::parameter_numbering<Model>::find(c).number));
    }
    /// Accessory c.
    template <class C>
    R* accessory(C c) const {
        return find(data_.accessory.component(host::accessory_numbering<Model>::find(c).number));
    }
    /// Integer accessory c.
    template <class C>
    std::int32_t* integer_accessory(C c) const {
        return find(data_.integer_accessory.component(host::integer_accessory_numbering<Model>::find(c).number));
    }
    /// The time at which the last phase of each instance ended.
    const R* t() const { return find(data_.t.data()); }
    /// How the last phase of each instance ended.
    const status* statuses() const { return find(data_.status.data()); }
    /// The stream that the solver works in, a `cudaStream_t`: work submitted to it is done after what was asked of the
    /// solver before, and before what is asked later. Null on the CPU, which is done when the solver's calls return.
    void* stream() const { return engine_ != nullptr ? engine_->native_stream() : nullptr; }

private:
    template <class T>
    T* find(T* value) const {
        if (engine_ == nullptr) return value;
        return reinterpret_cast<T*>(engine_->find(arguments_, value).address);
    }

    host::ensemble_data<R>& data_;
    std::int64_t size_;
    const detail::any_arguments<R>& arguments_;
    cuda::engine<R>* engine_;
};

}  // namespace myriad
