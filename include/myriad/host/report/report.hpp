// SPDX-License-Identifier: MIT
// The outcome of a call: how the instances ended, the first failure with its inputs, the work, the records.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/model/model_shape.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad {

/// States and accessories kept at the end of every recorded phase. Each accessor returns a map with one row per
/// instance and one column per recorded phase. Phases after an instance has ended are NaN (0 for integers). Maps point
/// into the records, so those of a temporary, as in `solve(...).records.state(0)`, are refused: give the report a name.
template <class Model, class R>
class phase_records {
public:
    /// An array of Eigen with one row per instance and one column per recorded phase.
    template <class T>
    using map = Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, Eigen::Dynamic>>;

    /// Made by `solve` and `solver`, for `size` instances and `phases` phases.
    phase_records() = default;
    phase_records(const record_options& o, std::int64_t phases, std::int64_t size)
        : data_(host::shape_of<Model>, o, phases, size) {}

    /// Number of recorded phases.
    std::int64_t phases() const { return data_.phases; }
    /// State component c at the end of each recorded phase. Throws `error` if it was not recorded.
    template <class C>
    map<R> state(C c) const& {
        return view(data_.values, data_.find(data_.state, host::state_numbering<Model>::index(c), "state"));
    }
    /// Accessory c at the end of each recorded phase. Throws `error` if it was not recorded.
    template <class C>
    map<R> accessory(C c) const& {
        return view(data_.values, data_.find(data_.accessory, host::accessory_numbering<Model>::index(c), "accessory"));
    }
    /// Integer accessory c at the end of each recorded phase. Throws `error` if it was not recorded.
    template <class C>
    map<std::int32_t> integer_accessory(C c) const& {
        return view(data_.integers,
                    data_.find(data_.integer_accessory, host::integer_accessory_numbering<Model>::index(c),
                               "integer accessory"));
    }
    template <class C>
    map<R> state(C) const&& = delete;
    template <class C>
    map<R> accessory(C) const&& = delete;
    template <class C>
    map<std::int32_t> integer_accessory(C) const&& = delete;
    /// Time at the end of the phase.
    map<R> time() const& { return view(data_.values, data_.find({data_.time}, 0, "time")); }
    map<R> time() const&& = delete;

    /// Forgets what was recorded.
    void clear() { data_.clear(); }
    /// Pins their memory, for copies from GPUs.
    void pin(int device) { data_.pin(device); }

    /// Passes their memory to a kernel; used by the library.
    void describe(detail::record_arguments<Model, R>& a) {
        a.values = data_.values.data();
        a.integers = data_.integers.data();
        a.from_phase = static_cast<std::int32_t>(data_.from_phase);
        a.phases = static_cast<std::int32_t>(std::int64_t{data_.phases});
        a.time_column = data_.time;
        const auto copy = [](const std::vector<std::int16_t>& columns, std::int16_t* to, int count) {
            for (int c = 0; c < count; ++c)
                to[c] = columns.empty() ? std::int16_t{-1} : columns[static_cast<std::size_t>(c)];
        };
        copy(data_.state, a.state_column, detail::n_state<Model>);
        copy(data_.accessory, a.accessory_column, detail::n_accessory<Model>);
        copy(data_.integer_accessory, a.integer_accessory_column, detail::n_integer_accessory<Model>);
    }

private:
    template <class T>
    map<T> view(const host::component_array<T>& from, int column) const {
        return map<T>(from.component(column), data_.size, data_.phases);
    }

    host::record_data<R> data_;
};

/// The outcome of one call to solve: what `report_of` has, and the records.
template <class Model, class R>
struct report : report_of<R> {
    phase_records<Model, R> records;  ///< what `options::record` asked for
};

}  // namespace myriad
