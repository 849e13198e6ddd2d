// SPDX-License-Identifier: MIT
// Instances of a study in a GPU's memory, which are set, integrated and reduced there. Host code only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/core/declarations.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/report/notes.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/solve/prepared_arguments.hpp"
#include "myriad/host/solve/solve.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/axes.hpp"
#include "myriad/study/chunk_solver.hpp"
#include "myriad/study/instances_on_host.hpp"
#include "myriad/study/study_plan.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

template <class Model, class Method, class R>
class instances_on_device final : public device_instances<R> {
public:
    instances_on_device(std::int64_t few, const device& where, const study_plan& plan,
                        std::shared_ptr<const generator<Model, R>> generate)
        : options_(plan.asked.options), few_(few, std::move(generate)),
          prepared_(with_domains(few_, plan.asked.axes), options_, host::traits_of<Method>),
          how_{where.number(), options_.block_size, options_.shared_placement, options_.schedule} {
        const auto make = host::require_kernel<Model, Method, R>(where).make_engine;
        kind_ = reinterpret_cast<host::engine_key>(make);
        auto idle = host::take_idle_engine(kind_, how_);
        engine_ = idle != nullptr ? std::move(idle) : make(how_);
        const auto& a = arguments_;
        const auto numbers = [](const std::int16_t* columns, int count) {
            return std::vector<int>(columns, columns + count);
        };
        results_ = {.records = a.record.values,
                    .record_integers = a.record.integers,
                    .samples = a.sample.values,
                    .sample_times = a.sample.time,
                    .samples_stored = a.sample.stored,
                    .states = numbers(a.record.state_column, detail::n_state<Model>),
                    .accessories = numbers(a.record.accessory_column, detail::n_accessory<Model>),
                    .integers = numbers(a.record.integer_accessory_column, detail::n_integer_accessory<Model>),
                    .sampled = numbers(a.sample.column, detail::n_state<Model>),
                    .time = a.record.time_column};
    }
    ~instances_on_device() override {
        if (fine_) host::give_idle_engine(kind_, how_, std::move(engine_));
    }

    model_instances<R>& looked_at() override { return few_; }
    const detail::instance_arrays<detail::array_pointer, R>& arrays() const override { return arguments_; }
    const result_arrays& results() const override { return results_; }
    void check(std::int64_t count) override {
        const detail::default_arithmetic here;
        before_ = host::check_uses<Method>(few_.all(), options_, count);
        host::find_phases_left(few_.all(), options_, count).require_for(0, options_.phases);
        host::input_check<Model, R>(few_.all(), options_, count).run();
    }
    std::vector<std::string> notes(std::int64_t count) override {
        const detail::default_arithmetic here;
        use([&](auto& e) { e.fetch_first(arguments_, count); });
        host::ensemble_access::touch(few_.all());
        report<Model, R> found;
        if (options_.counting == counting::on)
            host::set_work(found, host::work_count{}, host::counted_work(few_.data(), count));
        host::note_tolerances<Method>(found, options_);
        host::note_event_tolerances(found, few_.all(), options_, before_, count);
        host::note_stiffness<Method>(found, few_.all(), options_);
        host::note_exponents<Method>(found, few_.all(), options_);
        return found.notes;
    }
    std::int64_t affordable() override {
        std::int64_t bytes = 64;  // for what is drawn again, gathered and scheduled
        const auto add = [&](auto* array, std::int64_t components, auto...) {
            bytes += components * static_cast<std::int64_t>(sizeof(*array));
        };
        auto arguments = arguments_;  // a copy
        detail::for_each_array(arguments, add);
        detail::for_each_record(arguments, add);
        return engine_->affordable(2 * bytes);
    }
    void generate(const std::shared_ptr<const cuda::generation>& how, std::int64_t first, std::int64_t count) override {
        use([&](auto& e) { e.generate(arguments_, how, first, count); });
    }
    void integrate() override {
        use([&](auto& e) {
            e.integrate(arguments_);
            e.wait();
        });
    }
    void fetch(const cuda::device_values& what, std::byte* to) override {
        use([&](auto& e) { e.fetch(arguments_, what, to); });
    }
    std::vector<std::int64_t> reduce(const cuda::device_values& what, const cuda::device_reduction& how) override {
        std::vector<std::int64_t> found;
        use([&](auto& e) { found = e.reduce(arguments_, what, how); });
        return found;
    }

private:
    /// The instances, with the arrays that a call needs.
    static ensemble<Model, R>& with_domains(instances_on_host<Model, Method, R>& few, const axes& all) {
        set_instances<R>(few, all, 0);
        return few.all();
    }
    /// An engine that has failed is not used again.
    template <class Work>
    void use(Work&& work) {
        const bool before = std::exchange(fine_, false);
        work(static_cast<cuda::engine<Model, R>&>(*engine_));
        fine_ = before;
    }

    const options& options_;
    instances_on_host<Model, Method, R> few_;
    host::prepared_arguments<Model, R> prepared_;
    detail::kernel_arguments<Model, R>& arguments_ = prepared_.get();
    cuda::engine_options how_;
    host::engine_key kind_ = nullptr;
    std::unique_ptr<cuda::any_engine> engine_;
    result_arrays results_;
    host::functions_within_tolerance<Model> before_;
    bool fine_ = true;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
