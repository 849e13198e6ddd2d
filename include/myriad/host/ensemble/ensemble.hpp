// SPDX-License-Identifier: MIT
// The ensemble: states, parameters, accessories and time domains of all instances, set and read in bulk through Eigen
// maps. Host code only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include <Eigen/Core>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/core/declarations.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/ensemble/component_map.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/ensemble/trajectory_samples.hpp"
#include "myriad/host/model/model_shape.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad {

namespace host::inline MYRIAD_ABI {

/// The library's internal access to an ensemble, which users need not see.
struct ensemble_access {
    template <class E>
    static auto& data(E& e) {
        return e.data_;
    }
    template <class E>
    static auto& samples(E& e) {
        return e.samples_.data_;
    }
};

}  // namespace host::inline MYRIAD_ABI

/// `size` independent instances of a model, with real type R (double or float). Every accessor returns an Eigen map of
/// one component over all instances, contiguous and writable; nothing is copied and nothing is checked per element, but
/// assigning more or fewer values than there are instances is refused. Values never set are NaN, so that `solve` can
/// name them. Movable, not copyable.
template <class Model, class R>  // R = double
class ensemble {
    static_assert(detail::check_model<Model>());
    static_assert(std::is_same_v<R, double> || std::is_same_v<R, float>, "an ensemble's real type is double or float");

public:
    /// The struct that the instances are of; its enumerations are what the accessors take.
    using model = Model;
    /// The type of states, parameters, accessories and times.
    using real = R;
    /// What accessors return: one component over all instances, writable. See component_map.
    template <class T>
    using map = component_map<T>;
    /// The same, to be read: an array of Eigen with one entry per instance.
    template <class T>
    using const_map = Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, 1>>;

    /// Throws `error` if size is not positive, or if there is not enough memory.
    explicit ensemble(std::int64_t size) : data_(host::shape_of<Model>, size) {}

    /// Number of instances; zero for a moved-from ensemble.
    std::int64_t size() const { return data_.size; }

    /// State component c: initial values before a call, end values after it.
    template <class C>
    map<R> state(C c) & {
        return view(data_.state, host::state_numbering<Model>::find(c));
    }
    template <class C>
    const_map<R> state(C c) const& {
        return view(data_.state, host::state_numbering<Model>::find(c));
    }
    /// Control parameter c, in its own unit.
    template <class C>
    map<R> parameter(C c) & {
        return view(data_.parameter, host::parameter_numbering<Model>::find(c));
    }
    template <class C>
    const_map<R> parameter(C c) const& {
        return view(data_.parameter, host::parameter_numbering<Model>::find(c));
    }
    /// Accessory c, the model's own real storage; NaN until set.
    template <class C>
    map<R> accessory(C c) & {
        return view(data_.accessory, host::accessory_numbering<Model>::find(c));
    }
    template <class C>
    const_map<R> accessory(C c) const& {
        return view(data_.accessory, host::accessory_numbering<Model>::find(c));
    }
    /// Integer accessory c, the model's own integer storage; 0 until set.
    template <class C>
    map<std::int32_t> integer_accessory(C c) & {
        return view(data_.integer_accessory, host::integer_accessory_numbering<Model>::find(c));
    }
    template <class C>
    const_map<std::int32_t> integer_accessory(C c) const& {
        return view(data_.integer_accessory, host::integer_accessory_numbering<Model>::find(c));
    }

    /// Time domain of each instance; t_end may be before t_begin, to integrate backwards. The first of these calls
    /// after time_domain allocates memory, even on a const ensemble.
    map<R> t_begin() & { return view(data_.own_domains().t_begin, {"t_begin"}); }
    const_map<R> t_begin() const& { return view(data_.read_begins(), {"t_begin"}); }
    /// The end of the time domain of each instance, in the model's unit of time; may be infinite if events or hooks end
    /// the phase. See `t_begin`.
    map<R> t_end() & { return view(data_.own_domains().t_end, {"t_end"}); }
    const_map<R> t_end() const& { return view(data_.read_ends(), {"t_end"}); }
    /// The same domain for all instances. Unless t_begin or t_end are accessed, it takes no memory and is not copied to
    /// a GPU.
    void time_domain(R t_begin_of_all, R t_end_of_all) { data_.set_domain(t_begin_of_all, t_end_of_all); }
    /// Whether all instances share one domain, and there is no memory for individual ones.
    bool has_common_domain() const { return data_.has_common_domain(); }
    /// The domain of instance i, without allocating that memory.
    R t_begin_of(std::int64_t i) const { return data_.t_begin_of(i); }
    /// The end of the domain of instance i, in the same way.
    R t_end_of(std::int64_t i) const { return data_.t_end_of(i); }

    /// The factor by which both tolerances are multiplied in each instance, one until set, for a method
    /// `controlled<Method, tolerance_per_instance>`. Allocates memory at the first call.
    map<R> tolerance_scale() & { return view(data_.tolerance_scales(), {"tolerance_scale"}); }

    /// A parameter that all instances share; NaN until set. Throws `error` if the index is out of range.
    template <class C>
    R& shared(C c) {
        return present(data_.shared).data()[host::shared_numbering<Model>::find(c).number];
    }
    template <class C>
    R shared(C c) const {
        return present(data_.shared).data()[host::shared_numbering<Model>::find(c).number];
    }
    /// An integer that all instances share; 0 until set.
    template <class C>
    std::int32_t& shared_integer(C c) {
        return present(data_.shared_integer).data()[host::shared_integer_numbering<Model>::find(c).number];
    }
    template <class C>
    std::int32_t shared_integer(C c) const {
        return present(data_.shared_integer).data()[host::shared_integer_numbering<Model>::find(c).number];
    }

    /// The time at which the last phase of each instance ended, in the model's unit of time: t_end, or that of the
    /// event or failure that ended it.
    const_map<R> t() const& { return view(data_.t, {"t"}); }
    /// How the last phase of instance i ended. Throws `error` if there is no such instance.
    myriad::status status(std::int64_t i) const { return data_.status_of(i); }
    /// The statuses of all instances, `size()` of them, instance 0 first.
    const myriad::status* statuses() const { return data_.status.data(); }
    /// Number of phases that each instance has completed since the ensemble's start or `restart`.
    const_map<std::int32_t> phases_done() const& { return view(data_.phase, {"phases_done"}); }
    /// True once an instance takes no further part.
    bool ended(std::int64_t i) const { return data_.ended.data()[i] != 0; }
    /// Step size the instance would try next; zero before the first phase, and with fixed steps. The first call
    /// allocates memory unless an adaptive method has done so.
    const_map<R> next_step() const& { return view(data_.next_steps(), {"next_step"}); }
    /// Accepted steps since the start, per instance. A fixed step is never rejected: one with a non-finite result ends
    /// the instance, and only its evaluations count. Throws `error` if no call has counted. The first access to a
    /// counter that no call has used allocates memory.
    const_map<std::int64_t> accepted_steps() const& { return counter(&arrays::accepted); }
    /// Trial steps rejected by the error test since the start, per instance. As for `accepted_steps`.
    const_map<std::int64_t> rejected_steps() const& { return counter(&arrays::rejected); }
    /// Trial steps redone to locate events since the start, per instance. As for `accepted_steps`.
    const_map<std::int64_t> located_steps() const& { return counter(&arrays::located); }
    /// Evaluations of `rhs` since the start, per instance; those with dual numbers, for a Jacobian, are not counted. As
    /// for `accepted_steps`.
    const_map<std::int64_t> rhs_evaluations() const& { return counter(&arrays::evaluations); }
    /// Whether a call has counted steps and evaluations: `options::counting`.
    bool counted() const { return data_.counts(); }
    /// Dense output, if options::samples asked for any.
    const trajectory_samples<Model, R>& samples() const& { return samples_; }

    // A map into a temporary would dangle at the end of the statement.
    template <class C>
    map<R> state(C) && = delete;
    template <class C>
    map<R> parameter(C) && = delete;
    template <class C>
    map<R> accessory(C) && = delete;
    template <class C>
    map<std::int32_t> integer_accessory(C) && = delete;
    map<R> t_begin() && = delete;
    map<R> t_end() && = delete;
    map<R> tolerance_scale() && = delete;
    const_map<R> t() && = delete;
    const_map<std::int32_t> phases_done() && = delete;
    const_map<R> next_step() && = delete;
    const_map<std::int64_t> accepted_steps() && = delete;
    const_map<std::int64_t> rejected_steps() && = delete;
    const_map<std::int64_t> located_steps() && = delete;
    const_map<std::int64_t> rhs_evaluations() && = delete;
    const trajectory_samples<Model, R>& samples() && = delete;

    /// Forgets all phases done: the next call starts every instance from the beginning, failed ones too, with the
    /// states, parameters and accessories it then has.
    void restart() {
        if (!data_.untouched) samples_.clear();
        data_.restart();
    }

    /// Pins the ensemble's memory for its lifetime, so that `solve` on a GPU copies it directly, at the full speed of
    /// the bus. Pinning takes longer than a copy, so it pays off for ensembles that are solved more than once, or where
    /// latency matters. On a CPU it does nothing. Throws `error` if the system refuses; the ensemble is still usable
    /// then. No part of the memory may have been pinned by others.
    void pin(const device& where) {
        if (where.which() != device::kind::cuda) return;
        const int gpu = where.number();
        try {
            data_.pin(gpu);
            samples_.pin(gpu);
        } catch (const error& e) {
            host::refuse_pinning(data_.memory_of(host::shape_of<Model>, size()), e);
        }
        data_.pinned_for = gpu;
    }

    /// Whether `pin` has pinned the memory.
    bool pinned() const { return data_.pinned(); }

private:
    // Behind host::ensemble_access.
    friend host::ensemble_access;

    /// A part of this ensemble. Throws `error` if the ensemble was moved from.
    template <class Part>
    Part& present(Part& part) const {
        data_.require_present();
        return part;
    }
    template <class Array>
    auto view(Array& array, const host::component_label& label) const {
        using T = std::remove_pointer_t<decltype(array.data())>;
        auto* const values = present(array).component(std::max(label.number, 0));
        if constexpr (std::is_const_v<T>) {
            return const_map<std::remove_const_t<T>>(values, array.length());
        } else {
            return map<T>(values, array.length(), label);
        }
    }

    using arrays = typename host::ensemble_data<R>::arrays;
    const_map<std::int64_t> counter(host::component_array<std::int64_t> arrays::*which) const {
        return view(data_.counter(which), {"counter"});
    }

    host::ensemble_data<R> data_;
    trajectory_samples<Model, R> samples_;
};

}  // namespace myriad
