// SPDX-License-Identifier: MIT
// The data of an ensemble without its model's type, and what the library does with them: compiled once for each real
// type, in the library, and not in every program for every model. Free of Eigen. Host code only.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "myriad/host/core/error.hpp"
#include "myriad/host/core/left_behind.hpp"
#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/ensemble/ended_inputs.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/model/model_shape.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/state/instance_arrays.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Whether instances keep a step size between calls (adaptive methods) or not (fixed steps).
enum class step_sizes { fixed, kept };

template <class R>
struct ensemble_data : detail::instance_arrays<component_array, R> {
    using arrays = detail::instance_arrays<component_array, R>;
    static constexpr R unset = std::numeric_limits<R>::quiet_NaN();

    /// Throws `error` if size is not positive, or if there is not enough memory.
    ensemble_data(const model_shape& shape, std::int64_t size);
    ensemble_data(ensemble_data&&) noexcept = default;
    ensemble_data& operator=(ensemble_data&&) noexcept = default;
    ~ensemble_data();

    /// Throws `error` if the ensemble was moved from.
    void require_present() const;
    /// Exclusive use for the lifetime of the result. Throws `error` if it is in use, or was moved from.
    [[nodiscard]] occupancy::claim take();

    /// The same domain for all instances.
    void set_domain(R t_begin, R t_end);
    bool has_common_domain() const { return this->t_begin.components() == 0; }
    R t_begin_of(std::int64_t i) const { return has_common_domain() ? common_begin : this->t_begin.data()[i]; }
    R t_end_of(std::int64_t i) const { return has_common_domain() ? common_end : this->t_end.data()[i]; }
    /// Gives each instance a domain of its own, if it has none.
    arrays& own_domains();
    /// The ends of the domains for readers, several of which may share a const ensemble.
    const component_array<R>& read_begins() const;
    const component_array<R>& read_ends() const;

    bool scales_tolerances() const { return this->tolerance_scale.components() > 0; }
    component_array<R>& tolerance_scales();
    const component_array<R>& next_steps() const;

    myriad::status status_of(std::int64_t i) const;
    bool counts() const { return this->accepted.components() > 0; }
    /// Accepted, rejected and located steps, evaluations; null where all are zero because there is nothing to count:
    /// rejected steps with fixed steps, located steps in models without events.
    std::array<const std::int64_t*, 4> counters() const {
        return {this->accepted.data(), this->rejected.data(), this->located.data(), this->evaluations.data()};
    }
    /// One of them, zeros where there is nothing to count. Throws `error` if no call has counted.
    const component_array<std::int64_t>& counter(component_array<std::int64_t> arrays::*which) const;

    /// The arrays that a call needs, allocated if they are not there yet; the others are null.
    void fill_pointers(detail::instance_arrays<detail::array_pointer, R>& pointers, counting count, step_sizes steps);
    /// The part of them that may change while the ensemble is in use.
    void fill_domain(detail::instance_arrays<detail::array_pointer, R>& pointers);

    /// Has the past of models with delays kept, in rings of so many steps, with so many numbers of each state. Throws
    /// `error` if there is not enough memory, or if instances under way have another past.
    void keep_history(std::int32_t slots, std::int32_t terms);
    detail::history_arguments<R> history_pointers();
    /// The memory that it takes.
    static double history_bytes(const model_shape& shape, std::int64_t size, std::int32_t slots, std::int32_t terms);

    /// Forgets all phases done, but not the samples.
    void restart();
    void pin(int gpu);
    bool pinned() const { return pinned_for >= 0; }

    /// The memory an ensemble allocates on construction.
    static memory_need memory_of(const model_shape& shape, std::int64_t size);
    /// Adds the memory that a call allocates for `size` instances, except samples and what `there`, if not null, has
    /// already.
    static void add_memory_of_call(memory_need& need, const model_shape& shape, std::int64_t size,
                                   const ensemble_data* there, const options& o, step_sizes steps, bool scales);
    /// To be called before integrating `phases` more phases. Throws `error` if their numbers would be too large.
    void expect_phases(std::int64_t phases);
    /// Marks an instance as one that cannot be integrated.
    void mark_invalid(std::int64_t i);
    /// Ends instance i, which is in no phase, as `interrupted`, unless it has ended before.
    void leave(std::int64_t i);
    /// To be called after a kernel has run: remembers the inputs of the instances that have ended.
    void remember_ended();
    /// Whether the states or parameters of such an instance were set since.
    bool given_anew(const ended_instance<R>& e) const { return inputs_digest(e.index) != e.inputs; }

    const model_shape* shape;
    moved_number<std::int64_t> size;
    std::int64_t first_index = 0;          // of instance 0 in hooks, for an ensemble that is a part of a larger one
    moved_number<std::uint64_t> identity;  // unique; moves with the memory
    occupancy occupied;
    std::int64_t phases_asked = 0;  // upper bound over all instances
#define MYRIAD_DECLARE_SHARED(kind, plural, words, type) component_array<type> kind;
    MYRIAD_SHARED_KINDS(MYRIAD_DECLARE_SHARED)
#undef MYRIAD_DECLARE_SHARED
    R common_begin = unset, common_end = unset;
    // of models with delays: kernel/model/past.hpp
    component_array<R> history;
    component_array<std::uint32_t> history_jumps;
    component_array<std::int32_t> history_place;
    std::int32_t history_slots = 0, history_terms = 0;
    ended_instances<R> ended_before;  // what is remembered from earlier calls
    // for readers of what there is no memory for; allocated by the first one
    mutable component_array<R> common_begins, common_ends, no_steps;
    mutable component_array<std::int64_t> nothing_counted;
    /// Whether no instance was integrated or marked since construction or the last restart, so that what is kept
    /// between calls (steps, phases, sides, counters, samples) is all zero.
    bool untouched = true;
    int pinned_for = -1;  // the GPU for which memory is pinned; -1: none

private:
    /// An array of one component, allocated on first use.
    template <class T>
    component_array<T>& on_demand(component_array<T>& array, T value) const;
    digest inputs_digest(std::int64_t i) const;
};

/// What the functions of a model need of an ensemble's arrays.
template <class R>
detail::argument_head<R> inputs_in(ensemble_data<R>& data);

/// Throws `error`: an ensemble that needs that much memory was not pinned.
[[noreturn]] void refuse_pinning(const memory_need& need, const error& why);

extern template struct ensemble_data<double>;
extern template struct ensemble_data<float>;

}  // namespace myriad::host::inline MYRIAD_ABI
