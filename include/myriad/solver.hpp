// SPDX-License-Identifier: MIT
// The solver object: one chunk of instances on one device, worked on asynchronously. Several of them overlap transfers and
// work on a GPU, and spread over several GPUs and the CPU.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "myriad/backend.hpp"
#include "myriad/device.hpp"
#include "myriad/ensemble/ensemble.hpp"
#include "myriad/ensemble/report.hpp"
#include "myriad/integrator/arguments.hpp"
#include "myriad/integrator/options.hpp"
#include "myriad/solve.hpp"

namespace myriad {

/// What `solver::download` brings back, beside times, statuses, counters, records and samples, which always come.
struct components {
    std::vector<int> states = {};
    std::vector<int> accessories = {};
    std::vector<int> integer_accessories = {};
};

/// Up to `capacity` instances on a device, with pinned host memory. On a GPU, `upload`, `integrate` and `download` return at
/// once and are done one after the other in the solver's own stream; on the CPU they work in place, and `integrate` returns when
/// it is done. Whatever reads or changes host data waits first: `instances`, `report`, `wait`. An error of the device is
/// thrown by whichever call meets it; other solvers go on.
///
///     solver<duffing, cash_karp> sweep(device::best(), 100'000, {.phases = 64});
///     sweep.instances().state(duffing::x) = -0.5;   // and so on
///     sweep.upload();
///     sweep.integrate();
///     sweep.download();
///     std::cout << sweep.report() << sweep.instances().state(duffing::x).maxCoeff();
template <class Model, class Method, class R = double>
class solver {
public:
    /// Takes the memory, on the host and on the device. Throws `error` if there is too little, if an option is invalid, or if
    /// the device or a kernel for it is not there.
    solver(const device& where, std::int64_t capacity, options o = {})
        : where_(where), options_(checked(std::move(o), capacity)), instances_(capacity),
          prepared_(instances_, options_) {
        if (where.which() == device::kind::cpu) {
            host::openmp_kernel<Model, Method, R>();
            return;
        }
        engine_ = host::make_cuda_engine<Model, Method, R>(where, options_);
        engine_->reserve(prepared_.get(), capacity);
        const auto pin = [&](auto* array, std::int64_t components_of_it, array_access, array_kind) {
            engine_->pin(array, static_cast<std::size_t>(components_of_it * capacity) * sizeof(*array));
        };
        for_each_array(prepared_.get(), pin);
        for_each_record(prepared_.get().record, pin);
    }
    solver(const solver&) = delete;
    solver& operator=(const solver&) = delete;

    std::int64_t capacity() const { return instances_.size(); }
    const device& where() const { return where_; }

    /// The host's data, once nothing is being copied from or to it. What it holds after `integrate` is there after `download`.
    ensemble<Model, R>& instances() {
        wait();
        return instances_;
    }

    /// Takes the first `count` instances (0: all) to the device; those that have been there before go on from their phase.
    /// Throws `error` if their data are invalid.
    void upload(std::int64_t count = 0) {
        require(count >= 0 && count <= capacity(), "upload asks for ", count,
                " instances (must be from 1 to the capacity, ", capacity(), ", or 0 for all)");
        wait();
        count_ = 0;
        const std::int64_t wanted = count > 0 ? count : capacity();
        host::check_inputs(instances_, options_, wanted);
        count_ = wanted;
        report_ = {};
        work_before_ = host::counted_work(instances_);
        if (engine_) engine_->upload(prepared_.get(), 0, count_);
    }

    /// Integrates `phases` phases (0: as the options say). With records, the number is that of the options.
    void integrate(std::int64_t phases = 0) {
        require(count_ > 0, "integrate has no instances to work on: call upload first");
        require(phases == 0 || phases == options_.phases || (options_.record.empty() && options_.samples.empty()),
                "integrate asks for ", phases, " phases, but records and samples were laid out for ", options_.phases,
                ": give that number in the options");
        check_options<Model, Method, R>(with_phases(phases), n_state<Model>, n_event<Model>, n_accessory<Model>,
                                        n_integer_accessory<Model>);
        auto& arguments = prepared_.get();
        arguments.phases = static_cast<std::int32_t>(phases > 0 ? phases : options_.phases);
        if (engine_) {
            engine_->integrate(arguments);
            integrated_ = true;
            return;
        }
        run_options how;
        how.threads = where_.threads();
        how.count = count_;
        const auto begin = std::chrono::steady_clock::now();
        const run_statistics used = host::openmp_kernel<Model, Method, R>()(arguments, how);
        report_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        report_.lane_turns += used.lane_turns;
        report_.lanes = used.lanes;
        report_.threads = used.threads;
    }

    /// Brings everything back that a kernel may have written.
    void download() {
        if (engine_) engine_->download(prepared_.get());
    }
    /// The same, but of states and accessories only those that are named; the others on the host stay as they were, and
    /// another upload would take those there.
    void download(const components& chosen) {
        host::check_components("components.states", chosen.states, n_state<Model>);
        host::check_components("components.accessories", chosen.accessories, n_accessory<Model>);
        host::check_components("components.integer_accessories", chosen.integer_accessories,
                               n_integer_accessory<Model>);
        if (engine_) engine_->download(prepared_.get(), &is_chosen, const_cast<components*>(&chosen));
    }

    /// Waits for everything asked of this solver. Throws `error` if any of it failed.
    void wait() {
        if (engine_) engine_->wait();
    }
    /// What is asked of this solver from now on begins when all that was asked of `other` before is done. The host goes on.
    template <class OtherModel, class OtherMethod, class OtherR>
    void wait_for(solver<OtherModel, OtherMethod, OtherR>& other) {
        if (engine_ && other.engine_) {
            engine_->wait_for(*other.engine_);
        } else {
            other.wait();
        }
    }
    /// Whether nothing is under way.
    bool idle() { return !engine_ || engine_->idle(); }

    /// How the instances uploaded last have ended, and the work since, as of the last `download`. Waits for it.
    const myriad::report<Model, R>& report() {
        wait();
        if (options_.counting == counting::on) host::set_work(report_, work_before_, host::counted_work(instances_));
        host::summarise(instances_, report_, count_);
        report_.device = where_.name();
        if (engine_) {
            report_.kernel = engine_->facts();
            report_.kernel_seconds = integrated_ ? engine_->kernel_seconds() : 0;
            report_.seconds = report_.kernel_seconds;
        }
        return report_;
    }
    /// The records of the last `integrate`, as of the last `download`. Waits for it.
    const phase_records<Model, R>& records() {
        wait();
        return prepared_.records();
    }

private:
    template <class, class, class>
    friend class solver;

    static options checked(options o, std::int64_t capacity) {
        require(capacity > 0, "the solver's capacity is ", capacity,
                " (must be positive): give the number of instances it holds");
        check_options<Model, Method, R>(o, n_state<Model>, n_event<Model>, n_accessory<Model>,
                                        n_integer_accessory<Model>);
        return o;
    }
    options with_phases(std::int64_t phases) const {
        options o = options_;
        if (phases != 0) o.phases = phases;
        return o;
    }
    static bool is_chosen(void* context, array_kind kind, std::int64_t component) {
        const auto& chosen = *static_cast<const components*>(context);
        const auto in = [&](const std::vector<int>& list) {
            return std::find(list.begin(), list.end(), static_cast<int>(component)) != list.end();
        };
        switch (kind) {
            case array_kind::state:
                return in(chosen.states);
            case array_kind::accessory:
                return in(chosen.accessories);
            case array_kind::integer_accessory:
                return in(chosen.integer_accessories);
            default:
                return true;
        }
    }

    device where_;
    options options_;
    ensemble<Model, R> instances_;
    host::prepared_arguments<Model, Method, R> prepared_;
    std::int64_t count_ = 0;
    bool integrated_ = false;
    std::array<std::int64_t, 4> work_before_{};
    myriad::report<Model, R> report_;
    std::unique_ptr<cuda::engine<Model, R>> engine_;  // destroyed first: it holds on to the memory above
};

}  // namespace myriad
