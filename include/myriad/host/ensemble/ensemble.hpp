// SPDX-License-Identifier: MIT
// The ensemble: states, parameters, accessories and time domains of all instances, set and read in bulk through Eigen
// maps. Host code only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/core/left_behind.hpp"
#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/ensemble/component_map.hpp"
#include "myriad/host/ensemble/ended_inputs.hpp"
#include "myriad/host/ensemble/trajectory_samples.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad {

namespace host {

/// Whether instances keep a step size between calls (adaptive methods) or not (fixed steps).
enum class step_sizes { fixed, kept };

/// The library's internal access to an ensemble, which users need not see.
struct ensemble_access {
    template <class E>
    static bool scales_tolerances(const E& e) {
        return e.scales_tolerances();
    }
    template <class E>
    static auto counters(const E& e) {
        return e.counters();
    }
    template <class E>
    static bool untouched(const E& e) {
        return e.untouched();
    }
    template <class E>
    static void touch(E& e) {
        e.touch();
    }
    template <class E>
    [[nodiscard]] static occupancy::claim take(E& e) {
        return e.take();
    }
    template <class E>
    static memory_need memory_of(std::int64_t size) {
        return E::memory_of(size);
    }
    template <class E, class... More>
    static void add_memory_of_call(memory_need& need, const More&... more) {
        E::add_memory_of_call(need, more...);
    }
    template <class E>
    static std::uint64_t identity(const E& e) {
        return e.identity();
    }
    template <class E>
    static void expect_phases(E& e, std::int64_t phases) {
        e.expect_phases(phases);
    }
    template <class E, class Arguments, class... More>
    static void describe(E& e, Arguments& a, More... more) {
        e.describe(a, more...);
    }
    template <class E, class Arguments>
    static void describe_domain(E& e, Arguments& a) {
        e.describe_domain(a);
    }
    template <class E, class Arguments>
    static void describe_samples(E& e, Arguments& a, const sample_options& o) {
        e.describe_samples(a, o);
    }
    template <class E>
    static void mark_invalid(E& e, std::int64_t i) {
        e.mark_invalid(i);
    }
    template <class E>
    static bool has_fired_last(const E& e, int event, std::int64_t i) {
        return e.has_fired_last(event, i);
    }
    template <class E>
    static void remember_ended(E& e) {
        e.remember_ended();
    }
    template <class E>
    static const auto& ended_before(const E& e) {
        return e.ended_before();
    }
    template <class E, class Ended>
    static bool given_anew(const E& e, const Ended& before) {
        return e.given_anew(before);
    }
};

}  // namespace host

/// `size` independent instances of a model, with real type R (double or float). Every accessor returns an Eigen map of
/// one component over all instances, contiguous and writable; nothing is copied and nothing is checked per element, but
/// assigning more or fewer values than there are instances is refused. Values never set are NaN, so that `solve` can
/// name them. Movable, not copyable.
template <class Model, class R = double>
class ensemble {
    static_assert(detail::check_model<Model>());
    static_assert(std::is_same_v<R, double> || std::is_same_v<R, float>, "an ensemble's real type is double or float");

public:
    /// The model.
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
    explicit ensemble(std::int64_t size) : size_(checked(size)) {}

    /// Number of instances; zero for a moved-from ensemble.
    std::int64_t size() const { return size_; }

    /// State component c: initial values before a call, end values after it.
    template <class C>
    map<R> state(C c) & {
        return view(state_, host::state_numbering<Model>::find(c));
    }
    template <class C>
    const_map<R> state(C c) const& {
        return view(state_, host::state_numbering<Model>::find(c));
    }
    /// Control parameter c, in its own unit.
    template <class C>
    map<R> parameter(C c) & {
        return view(parameter_, host::parameter_numbering<Model>::find(c));
    }
    template <class C>
    const_map<R> parameter(C c) const& {
        return view(parameter_, host::parameter_numbering<Model>::find(c));
    }
    /// Accessory c, the model's own real storage; NaN until set.
    template <class C>
    map<R> accessory(C c) & {
        return view(accessory_, host::accessory_numbering<Model>::find(c));
    }
    template <class C>
    const_map<R> accessory(C c) const& {
        return view(accessory_, host::accessory_numbering<Model>::find(c));
    }
    /// Integer accessory c, the model's own integer storage; 0 until set.
    template <class C>
    map<std::int32_t> integer_accessory(C c) & {
        return view(integer_accessory_, host::integer_accessory_numbering<Model>::find(c));
    }
    template <class C>
    const_map<std::int32_t> integer_accessory(C c) const& {
        return view(integer_accessory_, host::integer_accessory_numbering<Model>::find(c));
    }

    /// Time domain of each instance; t_end may be before t_begin, to integrate backwards. The first of these calls
    /// after time_domain allocates memory, even on a const ensemble.
    map<R> t_begin() & { return view(own_domains(), {"t_begin"}); }
    const_map<R> t_begin() const& { return view(read_domains(), {"t_begin"}); }
    /// The end of the time domain of each instance, in the model's unit of time; may be infinite if events or hooks end
    /// the phase. See `t_begin`.
    map<R> t_end() & { return view(own_domains(), {"t_end"}, 1); }
    const_map<R> t_end() const& { return view(read_domains(), {"t_end"}, 1); }
    /// The same domain for all instances. Unless t_begin or t_end are accessed, it takes no memory and is not copied to
    /// a GPU.
    void time_domain(R t_begin_of_all, R t_end_of_all) {
        common_begin_ = t_begin_of_all;
        common_end_ = t_end_of_all;
        if (common_domain_.components() > 0) {
            common_domain_.fill_component(0, t_begin_of_all);
            common_domain_.fill_component(1, t_end_of_all);
        }
        if (has_common_domain()) return;
        domain_.fill_component(0, t_begin_of_all);
        domain_.fill_component(1, t_end_of_all);
    }
    /// Whether all instances share one domain, and there is no memory for individual ones.
    bool has_common_domain() const { return domain_.components() == 0; }
    /// The domain of instance i, without allocating that memory.
    R t_begin_of(std::int64_t i) const { return has_common_domain() ? common_begin_ : domain_.component(0)[i]; }
    /// The end of the domain of instance i, in the same way.
    R t_end_of(std::int64_t i) const { return has_common_domain() ? common_end_ : domain_.component(1)[i]; }

    /// The factor by which both tolerances are multiplied in each instance, one until set, for a method
    /// `controlled<Method, tolerance_per_instance>`. Allocates memory at the first call.
    map<R> tolerance_scale() & { return view(on_demand(tolerance_scale_, R(1)), {"tolerance_scale"}); }

    /// A parameter that all instances share; NaN until set. Throws `error` if the index is out of range.
    template <class C>
    R& shared(C c) {
        return present(shared_).data()[host::shared_numbering<Model>::find(c).number];
    }
    template <class C>
    R shared(C c) const {
        return present(shared_).data()[host::shared_numbering<Model>::find(c).number];
    }
    /// An integer that all instances share; 0 until set.
    template <class C>
    std::int32_t& shared_integer(C c) {
        return present(shared_integer_).data()[host::shared_integer_numbering<Model>::find(c).number];
    }
    template <class C>
    std::int32_t shared_integer(C c) const {
        return present(shared_integer_).data()[host::shared_integer_numbering<Model>::find(c).number];
    }

    /// The time at which the last phase of each instance ended, in the model's unit of time: t_end, or that of the
    /// event or failure that ended it.
    const_map<R> t() const& { return view(t_, {"t"}); }
    /// How the last phase of instance i ended. Throws `error` if there is no such instance.
    myriad::status status(std::int64_t i) const {
        require(i >= 0 && i < present(size_), "instance ", i, " does not exist: the ensemble has ", size_,
                " instances");
        return status_.data()[i];
    }
    /// The statuses of all instances, `size()` of them, instance 0 first.
    const myriad::status* statuses() const { return status_.data(); }
    /// Number of phases that each instance has completed since the ensemble's start or `restart`.
    const_map<std::int32_t> phases_done() const& { return view(phase_, {"phases_done"}); }
    /// True once an instance takes no further part.
    bool ended(std::int64_t i) const { return ended_.data()[i] != 0; }
    /// Step size the instance would try next; zero before the first phase, and with fixed steps. The first call
    /// allocates memory unless an adaptive method has done so.
    const_map<R> next_step() const& { return view(std::as_const(on_demand(h_next_, R(0))), {"next_step"}); }
    /// Accepted steps since the start, per instance. A fixed step is never rejected: one with a non-finite result ends
    /// the instance, and only its evaluations count. Throws `error` if no call has counted. The first access to a
    /// counter that no call has used allocates memory.
    const_map<std::int64_t> accepted_steps() const& { return counter(0); }
    /// Trial steps rejected by the error test since the start, per instance. As for `accepted_steps`.
    const_map<std::int64_t> rejected_steps() const& { return counter(1); }
    /// Trial steps redone to locate events since the start, per instance. As for `accepted_steps`.
    const_map<std::int64_t> located_steps() const& { return counter(2); }
    /// Evaluations of `rhs` since the start, per instance; those with dual numbers, for a Jacobian, are not counted. As
    /// for `accepted_steps`.
    const_map<std::int64_t> rhs_evaluations() const& { return counter(3); }
    /// Whether a call has counted steps and evaluations: `options::counting`.
    bool counted() const { return counted_[0].components() > 0; }
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
        phases_asked_ = 0;
        if (untouched_) return;
        untouched_ = true;
        // One parallel loop for all arrays, because of the overhead of starting and ending one.
        host::in_parallel(size_, 32'768, [this](std::int64_t first, std::int64_t last) {
            for_each_bookkeeping([=](auto& array, auto value) { array.fill_instances(first, last, value); });
        });
        samples_.clear();
        ended_before_.clear();
    }

    /// Pins the ensemble's memory for its lifetime, so that `solve` on a GPU copies it directly, at the full speed of
    /// the bus. Pinning takes longer than a copy, so it pays off for ensembles that are solved more than once, or where
    /// latency matters. On a CPU it does nothing. Throws `error` if the system refuses; the ensemble is still usable
    /// then. No part of the memory may have been pinned by others.
    void pin(const device& where) {
        if (where.which() != device::kind::cuda) return;
        const int gpu = where.number();
        try {
            pin_arrays(gpu);
        } catch (const error& e) {
            throw error(message("an ensemble that takes ", host::bytes_text(memory_of(size_).bytes()),
                                " or more was not pinned: ", e.what()));
        }
        pinned_for_ = gpu;
    }

    /// Whether `pin` has pinned the memory.
    bool pinned() const { return pinned_for_ >= 0; }

private:
    // Behind host::ensemble_access.
    friend host::ensemble_access;

    /// Whether instances have individual tolerance scales.
    bool scales_tolerances() const { return tolerance_scale_.components() > 0; }

    /// Accepted, rejected and located steps, evaluations; null where all are zero because there is nothing to count:
    /// rejected steps with fixed steps, located steps in models without events.
    std::array<const std::int64_t*, 4> counters() const {
        return {counted_[0].data(), counted_[1].data(), counted_[2].data(), counted_[3].data()};
    }

    /// Whether no instance was integrated or marked since construction or the last restart, so that what is kept
    /// between calls (steps, phases, sides, counters, samples) is all zero.
    bool untouched() const { return untouched_; }
    /// To be called before a kernel runs.
    void touch() { untouched_ = false; }

    /// Exclusive use of the ensemble for the lifetime of the result. Throws `error` if it is in use, or was moved from.
    [[nodiscard]] host::occupancy::claim take() {
        return present(occupancy_)
            .take(
                "this ensemble is being integrated already, by another thread or by the call whose function "
                "calls this: wait for it, or use an ensemble of its own");
    }
    /// The memory an ensemble allocates on construction.
    static host::memory_need memory_of(std::int64_t size) {
        const auto n = static_cast<double>(size);
        host::memory_need need;
        need.add("states", n * sizeof(R) * detail::n_state<Model>);
        need.add("parameters", n * sizeof(R) * detail::n_parameter<Model>);
        need.add("accessories", n * (sizeof(R) * detail::n_accessory<Model> +
                                     sizeof(std::int32_t) * detail::n_integer_accessory<Model>));
        need.add("times, phases and statuses", n * (sizeof(R) + sizeof(std::int32_t) + 2 + detail::n_event<Model>));
        return need;
    }
    /// Adds the memory that a call allocates for `size` instances, except what `there`, if not null, has already.
    static void add_memory_of_call(host::memory_need& need, std::int64_t size, const ensemble* there, const options& o,
                                   host::step_sizes steps, bool scales) {
        const auto values = [&](const auto& array, int count) {
            return array.components() == 0
                       ? static_cast<double>(size) * static_cast<double>(sizeof(*array.data())) * count
                       : 0;
        };
        const host::component_array<R> no_reals;
        const host::component_array<std::int64_t> no_counters;
        if (steps == host::step_sizes::kept) need.add("step sizes", values(there ? there->h_next_ : no_reals, 1));
        if (scales) need.add("tolerance scales", values(there ? there->tolerance_scale_ : no_reals, 1));
        if (detail::writes_time_domain<Model>) need.add("time domains", values(there ? there->domain_ : no_reals, 2));
        const int counters = 2 + (steps == host::step_sizes::kept ? 1 : 0) + (detail::n_event<Model> > 0 ? 1 : 0);
        if (o.counting == counting::on)
            need.add("counters", values(there ? there->counted_[0] : no_counters, counters));
        if (!o.samples.empty() && (there == nullptr || there->samples_.empty()))
            need.add("samples", trajectory_samples<Model, R>::bytes_for(o.samples, size));
    }
    /// A unique number for every ensemble; it moves with the memory, and is 0 for a moved-from ensemble.
    std::uint64_t identity() const { return identity_; }

    /// To be called before integrating `phases` more phases. Throws `error` if their numbers would be too large.
    void expect_phases(std::int64_t phases) {
        constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
        if (phases_asked_ + phases > most) phases_asked_ = phases_done().maxCoeff();  // those that have ended did fewer
        require(phases_asked_ + phases <= most, phases, " phases are asked for after ", phases_asked_,
                ", and an instance can do ", most, ": call restart() to count from zero");
        phases_asked_ += phases;
    }

    /// Fills in the pointers of a kernel's arguments.
    void describe(detail::kernel_arguments<Model, R>& a, counting count,
                  host::step_sizes steps = host::step_sizes::kept) {
        a.size = size_;
        a.parameter = parameter_.data();
        describe_domain(a);
        a.t = t_.data();
        a.state = state_.data();
        a.accessory = accessory_.data();
        a.integer_accessory = integer_accessory_.data();
        a.tolerance_scale = scales_tolerances() ? tolerance_scale_.data() : nullptr;
        a.h_next = steps == host::step_sizes::kept ? on_demand(h_next_, R(0)).data() : nullptr;
        a.phase = phase_.data();
        a.side = side_.data();
        a.ended = ended_.data();
        a.status = status_.data();
        if (count == counting::on) {
            const auto values = [this](std::size_t c) { return on_demand(counted_[c], std::int64_t{0}).data(); };
            a.accepted = values(0);
            a.rejected = steps == host::step_sizes::kept ? values(1) : nullptr;
            a.located = detail::n_event<Model> > 0 ? values(2) : nullptr;
            a.evaluations = values(3);
        }
        a.shared = {shared_.data(), shared_integer_.data()};
    }

    /// The part of them that may change while the ensemble is in use.
    void describe_domain(detail::kernel_arguments<Model, R>& a) {
        if (detail::writes_time_domain<Model>) own_domains();
        a.t_begin = has_common_domain() ? nullptr : domain_.component(0);
        a.t_end = has_common_domain() ? nullptr : domain_.component(1);
        a.common_t_begin = common_begin_;
        a.common_t_end = common_end_;
    }

    /// Allocates memory for the requested samples, or checks that they can be appended to the existing ones.
    void describe_samples(detail::sample_arguments<Model, R>& a, const sample_options& o) {
        if (o.empty()) return;
        if (samples_.empty()) samples_ = trajectory_samples<Model, R>(o, size_);
        if (pinned()) samples_.pin(pinned_for_);
        require(samples_.fits(o), "samples has other states or another capacity (", o.capacity,
                ") than the existing samples "
                "(",
                samples_.capacity(), "): use the same in all calls, or a new ensemble");
        samples_.describe(a);
    }

    /// Marks an instance as one that cannot be integrated.
    void mark_invalid(std::int64_t i) {
        touch();
        ended_.data()[i] = 1;
        status_.data()[i] = status::invalid_input;
    }
    /// Whether the last thing that an instance which has taken steps saw of an event may be that it happened: the phase
    /// then ended within the function's tolerance, which stores no side. An instance at rest at zero has none either.
    bool has_fired_last(int event, std::int64_t i) const {
        return status_.data()[i] == status::stopped_by_event ||
               (side_.component(event)[i] == 0 && counted_[0].components() > 0 && counted_[0].data()[i] > 0);
    }
    /// To be called after a kernel has run: remembers the inputs of the instances that have ended.
    void remember_ended() {
        ended_before_.add(ended_.data(), size_, [this](std::int64_t i) {
            return host::ended_instance<R>{i, inputs_digest(i), t_begin_of(i), t_end_of(i)};
        });
    }
    /// What is remembered from earlier calls.
    const host::ended_instances<R>& ended_before() const { return ended_before_; }
    /// Whether the states or parameters of such an instance were set since.
    bool given_anew(const host::ended_instance<R>& e) const { return inputs_digest(e.index) != e.inputs; }

    static constexpr R unset = std::numeric_limits<R>::quiet_NaN();

    static std::int64_t checked(std::int64_t size) {
        require(size > 0, "the ensemble has ", size, " instances (must be positive): there is nothing to integrate");
        memory_of(size).check(message("an ensemble of ", size, " instances"),
                              "integrate it in smaller parts, one after the other");
        return size;
    }
    /// Calls `visit(array, value)` for the arrays of bookkeeping (host/backend/arrays.hpp), with their values before
    /// the first phase; not for t, which a phase writes before anything reads it.
    template <class Visit>
    void for_each_bookkeeping(Visit&& visit) {
        visit(h_next_, R(0));
        visit(phase_, std::int32_t{0});
        visit(side_, std::int8_t{0});
        visit(ended_, std::uint8_t{0});
        visit(status_, status::not_started);
        for (auto& counter : counted_) visit(counter, std::int64_t{0});
    }
    void pin_arrays(int gpu) {
        for (auto* const array : {&state_, &parameter_, &accessory_, &t_, &domain_, &tolerance_scale_}) array->pin(gpu);
        integer_accessory_.pin(gpu);
        for_each_bookkeeping([gpu](auto& array, auto) { array.pin(gpu); });
        samples_.pin(gpu);
    }

    /// A part of this ensemble. Throws `error` if the ensemble was moved from.
    template <class Part>
    Part& present(Part& part) const {
        require(size_ > 0, "this ensemble was moved away: use the one that it was moved to");
        return part;
    }
    static std::uint64_t next_identity() {
        static std::atomic<std::uint64_t> last{0};
        return ++last;
    }
    host::digest inputs_digest(std::int64_t i) const {
        host::digest of_all;
        for (int c = 0; c < detail::n_state<Model>; ++c) of_all.add(state_.component(c)[i]);
        for (int c = 0; c < detail::n_parameter<Model>; ++c) of_all.add(parameter_.component(c)[i]);
        return of_all;
    }

    host::component_array<R> domains_of_all() const {
        host::component_array<R> made(2, size_, common_begin_);
        made.fill_component(1, common_end_);
        return made;
    }
    host::component_array<R>& own_domains() {
        if (has_common_domain()) {
            host::component_array<R> made = domains_of_all();
            if (pinned()) made.pin(pinned_for_);
            domain_ = std::move(made);
        }
        return domain_;
    }
    /// The same for readers, several of which may share a const ensemble.
    const host::component_array<R>& read_domains() const {
        if (!has_common_domain()) return domain_;
        const std::lock_guard lock(made_by_readers());
        if (common_domain_.components() == 0) common_domain_ = domains_of_all();
        return common_domain_;
    }
    static std::mutex& made_by_readers() {
        static std::mutex mutex;
        return mutex;
    }

    /// An array of one component, allocated on first use.
    template <class T>
    host::component_array<T>& on_demand(host::component_array<T>& array, T value) const {
        const std::lock_guard lock(made_by_readers());
        if (array.components() == 0) {
            host::component_array<T> made(1, size_, value);
            if (pinned()) made.pin(pinned_for_);
            array = std::move(made);
        }
        return array;
    }

    template <class Array>
    auto view(Array& array, const host::component_label& label, int component = 0) const {
        using T = std::remove_pointer_t<decltype(array.data())>;
        auto* const values = present(array).component(label.number < 0 ? component : label.number);
        if constexpr (std::is_const_v<T>) {
            return const_map<std::remove_const_t<T>>(values, array.length());
        } else {
            return map<T>(values, array.length(), label);
        }
    }

    const_map<std::int64_t> counter(std::size_t c) const {
        require(counted(), "no work was counted: integrate with counting = counting::on");
        const bool exists = counted_[c].components() > 0;
        return view(exists ? counted_[c] : std::as_const(on_demand(zeros_, std::int64_t{0})), {"counter"});
    }

    host::moved_number<std::int64_t> size_;
    host::moved_number<std::uint64_t> identity_ = next_identity();
    host::occupancy occupancy_;
    std::int64_t phases_asked_ = 0;  // upper bound over all instances
    host::component_array<R> state_{detail::n_state<Model>, size_, unset};
    host::component_array<R> parameter_{detail::n_parameter<Model>, size_, unset};
    host::component_array<R> accessory_{detail::n_accessory<Model>, size_, unset};
    host::component_array<std::int32_t> integer_accessory_{detail::n_integer_accessory<Model>, size_, 0};
    R common_begin_ = unset, common_end_ = unset;
    host::component_array<R> domain_;                 // t_begin and t_end, allocated on first use
    mutable host::component_array<R> common_domain_;  // the common ones, expanded for readers
    host::component_array<R> t_{1, size_, unset};
    host::component_array<R> shared_{detail::n_shared<Model>, 1, unset};
    host::component_array<std::int32_t> shared_integer_{detail::n_shared_integer<Model>, 1, 0};
    host::component_array<R> tolerance_scale_;  // allocated on first use
    mutable host::component_array<R> h_next_;   // likewise
    host::component_array<std::int32_t> phase_{1, size_, 0};
    host::component_array<std::int8_t> side_{detail::n_event<Model>, size_, 0};
    host::component_array<std::uint8_t> ended_{1, size_, 0};
    host::component_array<myriad::status> status_{1, size_, status::not_started};
    host::ended_instances<R> ended_before_;
    trajectory_samples<Model, R> samples_;
    std::array<host::component_array<std::int64_t>, 4> counted_;  // in the order of `counters`; allocated on first use
    mutable host::component_array<std::int64_t> zeros_;           // for unused counters; allocated on first access
    bool untouched_ = true;
    int pinned_for_ = -1;  // the GPU for which memory is pinned; -1: none
};

}  // namespace myriad
