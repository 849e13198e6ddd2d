// SPDX-License-Identifier: MIT
// The ensemble: states, parameters, accessories and time domains of all instances, set and read in bulk through Eigen
// maps. Host code only.
#pragma once

#include "myriad/core/host_only.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

#include "myriad/core/error.hpp"
#include "myriad/core/left_behind.hpp"
#include "myriad/core/status.hpp"
#include "myriad/device.hpp"
#include "myriad/ensemble/layout.hpp"
#include "myriad/ensemble/view.hpp"
#include "myriad/integrator/options.hpp"
#include "myriad/model/concepts.hpp"
#include "myriad/output/samples.hpp"

namespace myriad {

/// Whether instances have a step size to go on with, as with adaptive methods, or none, as with fixed steps.
enum class step_sizes { fixed, kept };

/// `size` independent instances of a model, with real type R (double or float). Every accessor returns an Eigen map of
/// one component over all instances, contiguous and writable; nothing is copied and nothing is checked per element.
/// Values nobody set are NaN, so that `solve` can say which. Movable, not copyable.
template <class Model, class R = double>
class ensemble {
    static_assert(check_model<Model>());
    static_assert(std::is_same_v<R, double> || std::is_same_v<R, float>, "an ensemble's real type is double or float");

public:
    using model = Model;
    using real = R;
    template <class T>
    using map = Eigen::Map<Eigen::Array<T, Eigen::Dynamic, 1>>;
    template <class T>
    using const_map = Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, 1>>;

    /// Throws `error` if size is not positive, or if there is not enough memory.
    explicit ensemble(std::int64_t size) : size_(checked(size)) {}

    /// Zero once it was moved away.
    std::int64_t size() const { return size_; }

    /// State component c: initial values before a call, end values after it.
    template <class C>
    map<R> state(C c) & { return view(state_, state_index(c), "state"); }
    template <class C>
    const_map<R> state(C c) const& { return view(state_, state_index(c), "state"); }
    /// Control parameter c.
    template <class C>
    map<R> parameter(C c) & { return view(parameter_, parameter_index(c), "parameter"); }
    template <class C>
    const_map<R> parameter(C c) const& { return view(parameter_, parameter_index(c), "parameter"); }
    /// The user's own real storage; NaN until set.
    template <class C>
    map<R> accessory(C c) & { return view(accessory_, accessory_index(c), "accessory"); }
    template <class C>
    const_map<R> accessory(C c) const& { return view(accessory_, accessory_index(c), "accessory"); }
    /// The user's own integer storage; 0 until set.
    template <class C>
    map<std::int32_t> integer_accessory(C c) & {
        return view(integer_accessory_, integer_accessory_index(c), "integer accessory");
    }
    template <class C>
    const_map<std::int32_t> integer_accessory(C c) const& {
        return view(integer_accessory_, integer_accessory_index(c), "integer accessory");
    }

    /// Time domain of each instance; t_end may be before t_begin, to integrate backwards. The first of these calls after
    /// time_domain takes memory, also on an ensemble that is const: threads that share one ask t_begin_of and t_end_of.
    map<R> t_begin() & { return view(own_domains(), 0, "time"); }
    const_map<R> t_begin() const& { return view(std::as_const(own_domains()), 0, "time"); }
    map<R> t_end() & { return view(own_domains(), 1, "time"); }
    const_map<R> t_end() const& { return view(std::as_const(own_domains()), 1, "time"); }
    /// The same domain for all instances. Unless t_begin or t_end are asked for, it takes no memory, and no copies to a GPU.
    void time_domain(R t_begin_of_all, R t_end_of_all) {
        common_begin_ = t_begin_of_all;
        common_end_ = t_end_of_all;
        if (has_common_domain()) return;
        domain_.fill_component(0, t_begin_of_all);
        domain_.fill_component(1, t_end_of_all);
    }
    /// Whether all instances have one domain and no memory for their own.
    bool has_common_domain() const { return domain_.components() == 0; }
    /// The domain of instance i, without taking that memory.
    R t_begin_of(std::int64_t i) const { return has_common_domain() ? common_begin_ : domain_.component(0)[i]; }
    R t_end_of(std::int64_t i) const { return has_common_domain() ? common_end_ : domain_.component(1)[i]; }

    /// What both tolerances are multiplied by in each instance, one until set, for a method
    /// `controlled<Method, tolerance_per_instance>`. Takes memory from the first call on.
    map<R> tolerance_scale() & { return view(on_demand(tolerance_scale_, R(1)), 0, "tolerance scale"); }
    bool scales_tolerances() const { return tolerance_scale_.components() > 0; }

    /// A parameter that all instances share; NaN until set. With an index beyond the model's: throws `error`.
    template <class C>
    R& shared(C c) { return present(shared_).component(checked_index(shared_index(c), n_shared<Model>, "shared parameter"))[0]; }
    template <class C>
    R shared(C c) const {
        return present(shared_).component(checked_index(shared_index(c), n_shared<Model>, "shared parameter"))[0];
    }
    /// An integer that all instances share; 0 until set.
    template <class C>
    std::int32_t& shared_integer(C c) {
        return present(shared_integer_).component(checked_index(shared_integer_index(c), n_shared_integer<Model>, "shared integer"))[0];
    }

    /// Results: where the last phase ended, and how.
    const_map<R> t() const& { return view(t_, 0, "time"); }
    myriad::status status(std::int64_t i) const {
        require(i >= 0 && i < present(size_), "instance ", i, " does not exist: the ensemble has ", size_, " instances");
        return status_.data()[i];
    }
    const myriad::status* statuses() const { return status_.data(); }
    /// Phases completed since the start.
    const_map<std::int32_t> phases_done() const& { return view(phase_, 0, "phase"); }
    /// Step size the instance would try next; zero before the first phase, and with fixed steps. The first of these calls takes
    /// memory unless an adaptive method did.
    const_map<R> next_step() const& { return view(std::as_const(on_demand(h_next_, R(0))), 0, "step"); }
    /// Work since the start: accepted and rejected steps, steps redone to locate events, evaluations of rhs. A fixed step is
    /// never rejected: one whose result is not finite ends the instance, and only its evaluations count. Throws `error` if no
    /// call has counted. The first call for what none has counted takes memory.
    const_map<std::int64_t> accepted_steps() const& { return counter(0); }
    const_map<std::int64_t> rejected_steps() const& { return counter(1); }
    const_map<std::int64_t> located_steps() const& { return counter(2); }
    const_map<std::int64_t> rhs_evaluations() const& { return counter(3); }
    bool counted() const { return counted_[0].components() > 0; }
    /// The same in this order, null where all are zero since nothing can have been counted: rejected steps by methods with fixed
    /// ones, located steps of models without events.
    std::array<const std::int64_t*, 4> counters() const {
        return {counted_[0].data(), counted_[1].data(), counted_[2].data(), counted_[3].data()};
    }

    /// Dense output, if options::samples asked for any.
    const trajectory_samples<Model, R>& samples() const& { return samples_; }

    // What points into a temporary would point to nothing after the line.
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

    /// Forgets all phases done: the next call starts every instance afresh, failed ones too, from the states, parameters
    /// and accessories it then has.
    void restart() {
        phases_asked_ = 0;
        if (untouched_) return;
        untouched_ = true;
        // One loop of threads for all arrays, as each takes them a while to begin and to end.
        host::in_parallel(size_, 32'768, [this](std::int64_t first, std::int64_t last) {
            h_next_.fill_instances(first, last, R(0));
            phase_.fill_instances(first, last, 0);
            side_.fill_instances(first, last, 0);
            ended_.fill_instances(first, last, 0);
            status_.fill_instances(first, last, status::not_started);
            for (auto& counter : counted_) counter.fill_instances(first, last, 0);
        });
        samples_.clear();
    }

    /// Keeps the ensemble's memory in place (pinned) as long as it lives, so that `solve` on a GPU copies it at the bus's speed,
    /// without a detour. Takes longer than a copy, so it pays for ensembles that are solved more than once, or whose
    /// results are awaited by the millisecond. On a CPU it does nothing. Throws `error` if the system refuses; all goes on
    /// without then. Nobody else may have pinned parts of it.
    void pin(const device& where) {
        if (where.which() != device::kind::cuda) return;
        const int gpu = where.number();
        try {
            pin_arrays(gpu);
        } catch (const error& e) {
            throw error(message("an ensemble that takes ", host::bytes_text(memory_of(size_).bytes()), " or more was not pinned: ",
                                e.what()));
        }
        pinned_for_ = gpu;
    }

    /// Whether `pin` has pinned it.
    bool pinned() const { return pinned_for_ >= 0; }

    /// Whether no instance was integrated or marked since the construction or the last restart: what is kept from call to
    /// call (steps, phases, sides, counters, samples) is zero.
    bool untouched() const { return untouched_; }
    /// To be called before a kernel is.
    void touch() { untouched_ = false; }

    /// The right to integrate it, as long as the result lives. Throws `error` if someone else has it, or if it was moved away.
    [[nodiscard]] host::occupancy::turn take() {
        return present(occupancy_).take(
            "this ensemble is being integrated already, by another thread or by the call whose function calls this: wait for "
            "it, or use an ensemble of its own");
    }
    /// What an ensemble takes when it is made.
    static host::memory_need memory_of(std::int64_t size) {
        const auto n = static_cast<double>(size);
        host::memory_need need;
        need.add("states", n * sizeof(R) * n_state<Model>);
        need.add("parameters", n * sizeof(R) * n_parameter<Model>);
        need.add("accessories", n * (sizeof(R) * n_accessory<Model> + sizeof(std::int32_t) * n_integer_accessory<Model>));
        need.add("times, phases and statuses", n * (sizeof(R) + sizeof(std::int32_t) + 2 + n_event<Model>));
        return need;
    }
    /// Adds what a call takes for `size` instances, but for what an ensemble, if there is one, has already.
    static void add_memory_of_call(host::memory_need& need, std::int64_t size, const ensemble* there, const options& o,
                                   step_sizes steps, bool scales) {
        const auto values = [&](const auto& array, int count) {
            return array.components() == 0 ? static_cast<double>(size) * static_cast<double>(sizeof(*array.data())) * count : 0;
        };
        const component_array<R> no_reals;
        const component_array<std::int64_t> no_counters;
        if (steps == step_sizes::kept) need.add("step sizes", values(there ? there->h_next_ : no_reals, 1));
        if (scales) need.add("tolerance scales", values(there ? there->tolerance_scale_ : no_reals, 1));
        if (writes_time_domain<Model>) need.add("time domains", values(there ? there->domain_ : no_reals, 2));
        const int counters = 2 + (steps == step_sizes::kept ? 1 : 0) + (n_event<Model> > 0 ? 1 : 0);
        if (o.counting == counting::on) need.add("counters", values(there ? there->counted_[0] : no_counters, counters));
        if (!o.samples.empty() && (there == nullptr || there->samples_.empty()))
            need.add("samples", trajectory_samples<Model, R>::bytes_for(o.samples, size));
    }
    /// Another number for every ensemble; it moves with the memory, and is 0 where that was moved away from.
    std::uint64_t identity() const { return identity_; }

    /// To be called before instances are to do as many phases more. Throws `error` if their numbers would be too large.
    void expect_phases(std::int64_t phases) {
        constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
        if (phases_asked_ + phases > most) phases_asked_ = phases_done().maxCoeff();  // those that have ended did fewer
        require(phases_asked_ + phases <= most, phases, " phases are asked for after ", phases_asked_,
                ", and an instance can do ", most, ": call restart() to count from zero");
        phases_asked_ += phases;
    }

    /// Fills in the pointers of a kernel's arguments.
    void describe(kernel_arguments<Model, R>& a, counting count, step_sizes steps = step_sizes::kept) {
        a.size = size_;
        a.parameter = parameter_.data();
        describe_domain(a);
        a.t = t_.data();
        a.state = state_.data();
        a.accessory = accessory_.data();
        a.integer_accessory = integer_accessory_.data();
        a.tolerance_scale = scales_tolerances() ? tolerance_scale_.data() : nullptr;
        a.h_next = steps == step_sizes::kept ? on_demand(h_next_, R(0)).data() : nullptr;
        a.phase = phase_.data();
        a.side = side_.data();
        a.ended = ended_.data();
        a.status = status_.data();
        if (count == counting::on) {
            const auto values = [this](std::size_t c) { return on_demand(counted_[c], std::int64_t{0}).data(); };
            a.accepted = values(0);
            a.rejected = steps == step_sizes::kept ? values(1) : nullptr;
            a.located = n_event<Model> > 0 ? values(2) : nullptr;
            a.evaluations = values(3);
        }
        a.shared = {shared_.data(), shared_integer_.data()};
    }

    /// The part of it that may change while the ensemble is used.
    void describe_domain(kernel_arguments<Model, R>& a) {
        if (writes_time_domain<Model>) own_domains();
        a.t_begin = has_common_domain() ? nullptr : domain_.component(0);
        a.t_end = has_common_domain() ? nullptr : domain_.component(1);
        a.common_t_begin = common_begin_;
        a.common_t_end = common_end_;
    }

    /// Makes room for the samples that are asked for, or checks that they can be added to those there are.
    void describe_samples(sample_arguments<Model, R>& a, const sample_options& o) {
        if (o.empty()) return;
        if (samples_.empty()) samples_ = trajectory_samples<Model, R>(o, size_);
        if (pinned()) samples_.pin(pinned_for_);
        require(samples_.fits(o), "samples asks for other states or another capacity (", o.capacity, ") than the samples there "
                "are (", samples_.capacity(), "): use the same in all calls, or a new ensemble");
        samples_.describe(a);
    }

    /// Marks an instance as one that cannot be integrated.
    void mark_invalid(std::int64_t i) {
        touch();
        ended_.data()[i] = 1;
        status_.data()[i] = status::invalid_input;
    }
    /// True once an instance takes no further part.
    bool ended(std::int64_t i) const { return ended_.data()[i] != 0; }

private:
    static constexpr R unset = std::numeric_limits<R>::quiet_NaN();

    static std::int64_t checked(std::int64_t size) {
        require(size > 0, "the ensemble has ", size, " instances (must be positive): there is nothing to integrate");
        memory_of(size).check(message("an ensemble of ", size, " instances"), "integrate it in smaller parts, one after the other");
        return size;
    }
    void pin_arrays(int gpu) {
        for (auto* const array : {&state_, &parameter_, &accessory_, &t_, &domain_, &h_next_, &tolerance_scale_}) array->pin(gpu);
        for (auto& counter : counted_) counter.pin(gpu);
        integer_accessory_.pin(gpu);
        phase_.pin(gpu);
        side_.pin(gpu);
        ended_.pin(gpu);
        status_.pin(gpu);
        samples_.pin(gpu);
    }

    /// Something of this ensemble, if that is still there.
    template <class Part>
    Part& present(Part& part) const {
        require(size_ > 0, "this ensemble was moved away, and its values with it: use the one that it was moved to");
        return part;
    }
    static std::uint64_t next_identity() {
        static std::atomic<std::uint64_t> last{0};
        return ++last;
    }
    static int checked_index(std::int64_t c, int count, const char* what) {
        require(c >= 0 && c < count, what, " ", c, " does not exist: the model has ", count,
                " (numbered from 0); use the model's enumerators");
        return static_cast<int>(c);
    }
    // An integer, or an enumerator of the enumeration that names such components: any other is a mix-up.
#define MYRIAD_COMPONENT_INDEX(kind)                                                                         \
    template <class C>                                                                                       \
    static std::int64_t kind##_index(C c) {                                                                  \
        static_assert(std::is_enum_v<C> || std::is_integral_v<C>, "give a number or an enumerator of the model"); \
        if constexpr (std::is_enum_v<C> && requires { typename Model::kind; }) {                             \
            static_assert(std::is_same_v<C, typename Model::kind>,                                           \
                          "this enumerator is not a " #kind " of the model; where the model declares anew an enumeration " \
                          "that it inherits, give those of the inherited one as numbers");                   \
        }                                                                                                    \
        return static_cast<std::int64_t>(c);                                                                 \
    }
    MYRIAD_COMPONENT_INDEX(state)
    MYRIAD_COMPONENT_INDEX(parameter)
    MYRIAD_COMPONENT_INDEX(accessory)
    MYRIAD_COMPONENT_INDEX(integer_accessory)
    MYRIAD_COMPONENT_INDEX(shared)
    MYRIAD_COMPONENT_INDEX(shared_integer)
#undef MYRIAD_COMPONENT_INDEX

    component_array<R>& own_domains() const {
        if (has_common_domain()) {
            component_array<R> made(2, size_, common_begin_);
            made.fill_component(1, common_end_);
            if (pinned()) made.pin(pinned_for_);
            domain_ = std::move(made);
        }
        return domain_;
    }

    /// An array of one component, that takes no memory before it is asked for.
    template <class T>
    component_array<T>& on_demand(component_array<T>& array, T value) const {
        static std::mutex mutex;  // for threads that read one ensemble
        const std::lock_guard lock(mutex);
        if (array.components() == 0) {
            component_array<T> made(1, size_, value);
            if (pinned()) made.pin(pinned_for_);
            array = std::move(made);
        }
        return array;
    }

    template <class Array>
    auto view(Array& array, std::int64_t index, const char* what) const {
        using T = std::remove_pointer_t<decltype(array.data())>;
        const int c = checked_index(index, present(array).components(), what);
        if constexpr (std::is_const_v<T>) {
            return const_map<std::remove_const_t<T>>(array.component(c), array.length());
        } else {
            return map<T>(array.component(c), array.length());
        }
    }

    const_map<std::int64_t> counter(std::size_t c) const {
        require(counted(), "no work was counted: integrate with counting = counting::on");
        const bool exists = counted_[c].components() > 0;
        return view(exists ? counted_[c] : std::as_const(on_demand(zeros_, std::int64_t{0})), 0, "counter");
    }

    host::moved_number<std::int64_t> size_;
    host::moved_number<std::uint64_t> identity_ = next_identity();
    host::occupancy occupancy_;
    std::int64_t phases_asked_ = 0;  // no instance has done more
    component_array<R> state_{n_state<Model>, size_, unset};
    component_array<R> parameter_{n_parameter<Model>, size_, unset};
    component_array<R> accessory_{n_accessory<Model>, size_, unset};
    component_array<std::int32_t> integer_accessory_{n_integer_accessory<Model>, size_, 0};
    R common_begin_ = unset, common_end_ = unset;
    mutable component_array<R> domain_;  // t_begin and t_end, allocated when they are asked for
    component_array<R> t_{1, size_, unset};
    component_array<R> shared_{n_shared<Model>, 1, unset};
    component_array<std::int32_t> shared_integer_{n_shared_integer<Model>, 1, 0};
    component_array<R> tolerance_scale_;   // made when it is asked for
    mutable component_array<R> h_next_;    // likewise
    component_array<std::int32_t> phase_{1, size_, 0};
    component_array<std::int8_t> side_{n_event<Model>, size_, 0};
    component_array<std::uint8_t> ended_{1, size_, 0};
    component_array<myriad::status> status_{1, size_, status::not_started};
    trajectory_samples<Model, R> samples_;
    std::array<component_array<std::int64_t>, 4> counted_;  // accepted, rejected, located, evaluations: by the first call that counts
    mutable component_array<std::int64_t> zeros_;           // those that no call has counted, when they are asked for
    bool untouched_ = true;
    int pinned_for_ = -1;  // the GPU for which memory is pinned; none
};

}  // namespace myriad
