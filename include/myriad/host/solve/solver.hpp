// SPDX-License-Identifier: MIT
// The solver object: one chunk of instances on one device, integrated asynchronously. Several of them overlap transfers
// and kernels on a GPU, and can use several GPUs and the CPU.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/core/declarations.hpp"
#include "myriad/host/core/left_behind.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/option_checks.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/solve/device_arrays.hpp"
#include "myriad/host/solve/prepared_call.hpp"
#include "myriad/host/solve/solve.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"

namespace myriad {

/// What `solver::download` copies back, besides times, statuses, counters, records and samples, which it always does.
struct components {
    component_list states = {};               ///< states to copy
    component_list accessories = {};          ///< accessories to copy
    component_list integer_accessories = {};  ///< integer accessories to copy
};

/// Up to `capacity` instances on a device, with pinned host memory. On a GPU, copies and kernels run one after the
/// other in the solver's own stream: `integrate` and `download` return at once, `upload` when earlier work is done. On
/// the CPU they work in place, and `integrate` returns when it is done. Functions that give access to host data wait
/// first: `instances`, `records`, `report`; on either device they refuse to while results have not been downloaded, so
/// that what works on the CPU works on a GPU. An error of the device is thrown by the next call that detects it; other
/// solvers continue.
///
///     solver<duffing, cash_karp> sweep(device::best(), 100'000, {.phases = 64});
///     sweep.instances().state(duffing::x) = -0.5;   // and so on
///     sweep.upload();
///     sweep.integrate();
///     sweep.download();
///     std::cout << sweep.report() << sweep.instances().state(duffing::x).maxCoeff();
template <class Model, class Method, class R>  // R = double
class solver {
public:
    /// Allocates all memory, on the host and on the device. Throws `error` if there is too little, if an option is
    /// invalid, or if the device or a kernel for it does not exist.
    solver(const device& where, std::int64_t capacity, options o = {})
        : where_(where), options_(std::move(o)), model_(host::called_for<Model, Method, R>({where}, options_)),
          instances_(checked(capacity)),
          prepared_(data(), host::ensemble_access::samples(instances_), records_.data(), options_, model_.facts) {
        if (where.which() == device::kind::cpu) return;
        engine_ = model_.on_gpus.front().make(model_.on_gpus.front().how);
        instances_.pin(where);
        prepared_.pin(where.number());
        records_.pin(where.number());
        engine_->reserve(prepared_.arguments, capacity);
    }
    solver(const solver&) = delete;
    solver& operator=(const solver&) = delete;

    /// The largest number of instances.
    std::int64_t capacity() const { return instances_.size(); }
    /// The device.
    const device& where() const { return where_; }

    /// The host's data, to be set: the next `integrate` needs an `upload` before it. Waits until no copy from or to
    /// them is in progress; throws `error` after an `integrate` without a `download`. A reference kept across an
    /// `upload` or `download` stays valid, but a copy may be in progress: call this again.
    ensemble<Model, R>& instances() {
        const auto claim = take();
        finish();
        require_results("instances");
        uploaded_ = false;
        if (results_ == held::on_host && !remembered_) data().remember_ended();
        remembered_ = remembered_ || results_ == held::on_host;
        return instances_;
    }
    /// The same data, to be read.
    const ensemble<Model, R>& results() {
        const auto claim = take();
        finish();
        require_results("results");
        return instances_;
    }

    /// Copies the first `count` instances (0: all) to the device, with the shared parameters; instances integrated
    /// before continue from their phase. Waits for earlier work. Throws `error` if their data are invalid, or are
    /// results that were only partly downloaded.
    void upload(std::int64_t count = 0) {
        const detail::default_arithmetic here;
        const auto claim = take();
        require(count >= 0 && count <= capacity(), "upload asks for ", count,
                " instances (must be from 1 to the capacity, ", capacity(), ", or 0 for all)");
        finish();
        require_results("upload");
        const std::int64_t wanted = count > 0 ? count : capacity();
        require_memory();
        if (results_ == held::partly_on_host) {
            for (std::int64_t i = 0; i < wanted; ++i)
                require(instances_.status(i) == status::not_started,
                        "upload would mix old and new values, as only chosen components of the last results were "
                        "downloaded: "
                        "restart() and set the instances again, or download() all of them first");
        }
        uploaded_ = downloadable_ = false;
        phases_left_ = model_.check_uses(data(), options_, wanted);
        phases_asked_ = 0;
        host::data_check<R> values = model_.values_of(data(), options_, wanted);
        prepared_.fill_domain();
        const auto copy = [&] {
            if (engine_)
                engine_->upload(prepared_.arguments, 0, wanted, data().untouched ? cuda::past::none : cuda::past::kept);
        };
        if (options_.invalid_instances == invalid_instances::mark) {  // which changes what is copied
            values.run();
            copy();
        } else {
            copy();
            values.run();  // while it is copied
        }
        count_ = wanted;
        uploaded_ = downloadable_ = true;
        integrated_ = false;
        results_ = held::on_host;
        report_ = {};
        has_records_ = false;
        if (wanted < capacity()) records_.clear();  // a GPU writes the records of uploaded instances only
        work_before_ = counted_work();
    }

    /// Integrates `phases` phases (0: as the options say). With records, the number must be that of the options;
    /// records come from the last call.
    void integrate(std::int64_t phases = 0) {
        const auto claim = take();
        require(uploaded_,
                "integrate has no instances to work on, or instances() may have changed them since the upload",
                host::cure, "call upload first, and read with results()");
        require(phases == 0 || phases == options_.phases || (options_.record.empty() && options_.samples.empty()),
                "integrate asks for ", phases, " phases, but records and samples were laid out for ", options_.phases,
                host::cure, "give that number in the options");
        if (phases != 0) host::check_count("phases", phases, 1, 1'000'000'000);
        if (phases == 0) phases = options_.phases;
        phases_left_.require_for(phases_asked_, phases);
        require_memory();
        auto& arguments = prepared_.arguments;
        arguments.phases = static_cast<std::int32_t>(phases);
        data().expect_phases(phases);
        phases_asked_ += phases;
        results_ = held::on_device;
        remembered_ = false;
        data().untouched = false;
        has_records_ = true;
        if (engine_) {
            engine_->integrate(arguments);
            integrated_ = true;
            return;
        }
        records_.clear();
        detail::run_options how;
        how.threads = where_.threads();
        how.schedule = options_.schedule;
        how.count = count_;
        const auto begin = std::chrono::steady_clock::now();
        uploaded_ = false;  // if a function of the model throws
        const detail::run_statistics used = host::run_kernel(model_.on_cpu, arguments, how);
        uploaded_ = true;
        report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        report_.lane_turns += used.lane_turns;
        report_.lanes = used.lanes;
        report_.threads = used.threads;
        report_.instruction_set = used.instruction_set;
    }

    /// Copies back everything that a kernel may have written.
    void download() {
        const auto claim = take();
        require_memory();
        require(downloadable_, "download has no instances to copy", host::cure, "call upload first");
        if (engine_) engine_->download(prepared_.arguments);
        results_ = held::on_host;
    }
    /// The same, but only the named states and accessories. The values of the others on the host are unspecified: the
    /// old ones if the device is a GPU, the new ones on the CPU.
    void download(const components& chosen) {
        const auto claim = take();
        require_memory();
        require(downloadable_, "download has no instances to copy", host::cure, "call upload first");
        constexpr const host::model_components& named = host::components_of<Model>;
#define MYRIAD_CHECK_KIND(kind, plural, ...) named.check("components." #plural, chosen.plural, named.kind);
        MYRIAD_RECORDED_KINDS(MYRIAD_CHECK_KIND)
#undef MYRIAD_CHECK_KIND
        if (engine_) engine_->download(prepared_.arguments, &is_chosen, const_cast<components*>(&chosen));
        if (results_ == held::on_device) results_ = held::partly_on_host;
    }

    /// Where the device has the values, for kernels and libraries of your own: results that are used there need no
    /// download, and states, parameters and accessories may be set there, after `upload` and before `integrate`, which
    /// does not check them. Does not wait: submit your work to its stream, or call `wait` before. Throws `error` before
    /// an `upload`.
    device_arrays<Model, R> on_device() {
        const auto claim = take();
        require_memory();
        require(downloadable_, "on_device has no instances", host::cure, "call upload first");
        return {data(), count_, prepared_.arguments, engine_.get()};
    }

    /// Waits for all work submitted to this solver. Throws `error` if any of it failed.
    void wait() {
        const auto claim = take();
        finish();
    }
    /// Work submitted to this solver from now on begins when all work submitted to `other` before is done. The host
    /// does not wait.
    template <class OtherModel, class OtherMethod, class OtherR>
    void wait_for(solver<OtherModel, OtherMethod, OtherR>& other) {
        const auto claim = take();
        if (static_cast<void*>(&other) == this) return;
        const auto claim_on_other = other.take();
        if (engine_ && other.engine_) {
            engine_->wait_for(*other.engine_);
        } else {
            other.finish();
        }
    }
    /// Whether no work is in progress.
    bool idle() { return !engine_ || engine_->idle(); }

    /// How the instances uploaded last ended, and the work since then. Times are those of the last `integrate`, of its
    /// kernel on a GPU. Waits; throws `error` after an `integrate` without a `download`.
    const myriad::report<Model, R>& report() {
        const detail::default_arithmetic here;
        const auto claim = take();
        finish();
        require_results("report");
        require_memory();
        host::set_work(report_, work_before_, counted_work());
        host::summarise(data(), report_, count_);
        report_.notes.clear();
        host::note_ended(report_, data(), count_);
        host::note_failures(report_, data(), options_, prepared_.arguments.max_steps, count_);
        if (model_.facts.adaptive()) host::note_raised_tolerances<R>(report_, options_);
        host::note_matrix<R>(report_, detail::matrix_facts_of<Model, Method, R>);
        report_.device = where_.name();
        if (engine_) {
            report_.kernel = engine_->facts();
            report_.kernel_seconds = integrated_ ? engine_->kernel_seconds() : 0;
            report_.seconds = report_.kernel_seconds;
        }
        return report_;
    }
    /// The records of the last `integrate`, empty (NaN, 0) if there was none since the upload. Waits; throws `error`
    /// after an `integrate` without a `download`.
    const phase_records<Model, R>& records() {
        const auto claim = take();
        finish();
        require_results("records");
        if (!has_records_) records_.clear();
        return records_;
    }

private:
    template <class, class, class>
    friend class solver;

    enum class held { on_host, on_device, partly_on_host };

    [[nodiscard]] host::occupancy::claim take() {
        return occupancy_.take("two threads use one solver at the same time: give each a solver of its own");
    }
    void finish() {
        if (engine_) engine_->wait();
    }
    /// The kernel's arguments point to the memory of the original ensemble.
    void require_memory() const {
        require(host::ensemble_access::data(instances_).identity == identity_,
                "the solver's ensemble was replaced by another or moved away, and its memory with it", host::cure,
                "set the values of instances() instead");
    }
    void require_results(const char* what) const {
        require(results_ != held::on_device, what, " needs the results of integrate on the host", host::cure,
                "call download first (download({}) copies no component)");
    }

    host::ensemble_data<R>& data() { return host::ensemble_access::data(instances_); }

    /// The capacity, if the options fit it.
    std::int64_t checked(std::int64_t capacity) const {
        const options& o = options_;
        require(capacity > 0, "the solver's capacity is ", capacity, " (must be positive)", host::cure,
                "give the number of instances it holds");
        require(!o.progress, "progress is given, but a solver is asynchronous and cannot report it", host::cure,
                "leave it out, and call idle()");
        require(o.time_limit == 0, host::named_option("time_limit"),
                " is given, but a solver is asynchronous, and nobody would watch the clock", host::cure,
                "leave it out, and bound the steps of an instance by max_steps");
        model_.check_options(o);
        host::memory_need need = host::ensemble_data<R>::memory_of(*model_.shape, capacity);
        host::add_memory_of_call<R>(need, *model_.shape, capacity, nullptr, false, o, model_.facts);
        need.check(message("a solver for ", capacity, " instances"),
                   "give it a smaller capacity, and integrate part by part");
        model_.check_kernel(where_.which());
        return capacity;
    }
    host::work_count counted_work() {
        return options_.counting == counting::on ? host::counted_work(data(), count_) : host::work_count{};
    }
    static bool is_chosen(void* context, detail::array_kind kind, std::int64_t component) {
        const auto& chosen = *static_cast<const components*>(context);
        const auto in = [&](const component_list& list) {
            return std::find(list.begin(), list.end(), static_cast<int>(component)) != list.end();
        };
        switch (kind) {
#define MYRIAD_CHOSEN_OF_KIND(kind, plural, ...) \
    case detail::array_kind::kind:               \
        return in(chosen.plural);
            MYRIAD_RECORDED_KINDS(MYRIAD_CHOSEN_OF_KIND)
#undef MYRIAD_CHOSEN_OF_KIND
            default:
                return true;
        }
    }

    device where_;
    options options_;
    host::called_model<R> model_;
    ensemble<Model, R> instances_;
    phase_records<Model, R> records_;
    host::prepared_call<R> prepared_;
    std::uint64_t identity_ = host::ensemble_access::data(instances_).identity;
    host::occupancy occupancy_;
    std::int64_t count_ = 0;
    host::phases_left phases_left_;  // at the upload, and those requested since
    std::int64_t phases_asked_ = 0;
    bool uploaded_ = false;      // and `instances()` not called since
    bool downloadable_ = false;  // uploaded, and found valid
    held results_ = held::on_host;
    bool remembered_ = true;  // which instances have ended, and with what inputs
    bool integrated_ = false;
    bool has_records_ = true;  // they belong to the instances uploaded last
    host::work_count work_before_{};
    myriad::report<Model, R> report_;
    std::unique_ptr<cuda::engine<R>> engine_;  // destroyed first: it uses the memory above
};

}  // namespace myriad
