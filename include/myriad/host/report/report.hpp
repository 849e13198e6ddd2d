// SPDX-License-Identifier: MIT
// The outcome of a call: how the instances ended, the first failure with its inputs, the work, the records.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <cstdint>

#include <Eigen/Core>

#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/model/concepts.hpp"

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

    /// Made by `solve` and `solver`.
    phase_records() = default;

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

    /// Their memory; used by the library.
    host::record_data<R>& data() { return data_; }

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
