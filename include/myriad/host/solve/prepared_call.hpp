// SPDX-License-Identifier: MIT
// Turns an ensemble and options into the arguments of a kernel, for any model: every call starts here. Compiled in the
// library. Host code only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "myriad/host/backend/any_arguments.hpp"
#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/ensemble/sample_data.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/model_facts.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Adds the memory that a call allocates for `size` instances, except what `there`, if not null, has from earlier
/// calls, and samples if it `has_samples`.
template <class R>
void add_memory_of_call(memory_need& need, const model_shape& shape, std::int64_t size, const ensemble_data<R>* there,
                        bool has_samples, const options& o, const call_facts& facts);

/// The arguments of a call, and the memory they point to besides the ensemble's: the arrays behind the head, and the
/// sample times in the ensemble's real type. The ensemble, its samples and the records must stay where they are.
template <class R>
class prepared_call {
public:
    /// Allocates the arrays that the call needs, the samples and the records. Throws `error` if there is not enough
    /// memory.
    prepared_call(ensemble_data<R>& data, sample_data<R>& samples, record_data<R>& records, const options& o,
                  const call_facts& facts, new_samples are = new_samples::cleared);
    prepared_call(const prepared_call&) = delete;
    prepared_call& operator=(const prepared_call&) = delete;

    /// Takes the time domain from the ensemble, where it may have changed.
    void fill_domain();
    /// Pins its own memory, for copies to and from a GPU.
    void pin(int device) { own_times_.pin(device); }
    /// An array behind the head, which is at that place.
    template <class T>
    T* array(int offset) {
        return reinterpret_cast<T*>(reinterpret_cast<std::byte*>(arrays_.data()) + offset);
    }

    any_arguments<R> arguments{};

private:
    void fill_options(const options& o, const call_facts& facts);
    void fill_records(record_data<R>& records);
    void fill_samples(const sample_options& o, sample_data<R>& samples, new_samples are);

    ensemble_data<R>& data_;
    std::vector<double> arrays_;  // doubles, for their alignment
    std::vector<R> sample_times_;
    component_array<R> own_times_;  // sample times of each instance
};

extern template class prepared_call<double>;
extern template class prepared_call<float>;

}  // namespace myriad::host::inline MYRIAD_ABI
