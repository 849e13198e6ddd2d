// SPDX-License-Identifier: MIT
// The instances of a study on a GPU, which sets and reduces them itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device_library.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "prepared_call.hpp"
#include "study_instances.hpp"

namespace myriad::python {

template <class R>
class study_on_device final : public studies::device_instances<R> {
public:
    study_on_device(const model_of_study& model, const study_kernel& kernel, const device& where,
                    const studies::study_plan& plan, std::int64_t few)
        : program_(*kernel.kernel->gpu()), facts_(kernel.kernel->facts()), options_(kernel.fitted(plan.asked.options)),
          few_(model, kernel, few), call_(with_domains(few_, plan.asked.axes), options_, facts_),
          how_(engine_options_for(program_, where.number(), options_)) {
        auto idle = host::take_idle_engine(&program_, how_);
        if (idle == nullptr) idle = engines_of<R>(program_)(how_);
        engine_.reset(static_cast<device_engine<R>*>(idle.release()));
        const auto& a = call_.arguments;
        const auto numbers = [](const std::int16_t* columns, int count) {
            return std::vector<int>(columns, columns + count);
        };
        results_ = {.records = a.record.values,
                    .record_integers = a.record.integers,
                    .samples = a.sample.values,
                    .sample_times = a.sample.time,
                    .samples_stored = a.sample.stored,
                    .states = numbers(a.record.state_column, facts_.n_state),
                    .accessories = numbers(a.record.accessory_column, facts_.n_accessory),
                    .integers = numbers(a.record.integer_accessory_column, facts_.n_integer_accessory),
                    .sampled = numbers(a.sample.column, facts_.n_state),
                    .time = a.record.time_column};
    }
    ~study_on_device() override {
        if (fine_) host::give_idle_engine(&program_, how_, std::move(engine_));
    }

    studies::model_instances<R>& looked_at() override { return few_; }
    const detail::instance_arrays<detail::array_pointer, R>& arrays() const override { return call_.arguments; }
    const studies::result_arrays& results() const override { return results_; }
    void check(std::int64_t count) override {
        const detail::default_arithmetic here;
        auto& data = few_.data();
        const bool endless = may_end_early(facts_, options_);
        host::check_scales(data, facts_.scales_tolerances);
        host::check_sample_times(data, options_, count);
        host::find_phases_left(data, options_, count, endless).require_for(0, options_.phases);
        host::data_check<R>(data, options_, count, endless).run();
    }
    std::vector<std::string> notes(std::int64_t) override {
        report_of<R> found;
        if (facts_.embedded_order > 0) host::note_raised_tolerances<R>(found, options_);
        return found.notes;
    }
    std::int64_t affordable() override {
        std::int64_t bytes = 64;  // for what is drawn again, gathered and scheduled
        const auto add = [&](auto* array, std::int64_t components, auto...) {
            bytes += components * static_cast<std::int64_t>(sizeof(*array));
        };
        auto arguments = call_.arguments;  // a copy
        for_each_array(arguments, add);
        for_each_record(arguments, add);
        return engine_->affordable(2 * bytes);
    }
    void generate(const std::shared_ptr<const cuda::generation>& how, std::int64_t first, std::int64_t count) override {
        use([&](auto& e) { e.generate(call_.arguments, how, first, count); });
    }
    void integrate() override {
        use([&](auto& e) {
            e.integrate(call_.arguments);
            e.wait();
        });
    }
    void fetch(const cuda::device_values& what, std::byte* to) override {
        use([&](auto& e) { e.fetch(call_.arguments, what, to); });
    }
    std::vector<std::int64_t> reduce(const cuda::device_values& what, const cuda::device_reduction& how) override {
        std::vector<std::int64_t> found;
        use([&](auto& e) { found = e.reduce(call_.arguments, what, how); });
        return found;
    }

private:
    /// The instances, with the arrays that a call needs.
    static ensemble<R>& with_domains(study_instances<R>& few, const axes& all) {
        studies::set_instances<R>(few, all, 0);
        return few.all();
    }
    /// An engine that has failed is not used again.
    template <class Work>
    void use(Work&& work) {
        const bool before = std::exchange(fine_, false);
        work(*engine_);
        fine_ = before;
    }

    device_program& program_;
    const model_facts& facts_;
    options options_;
    study_instances<R> few_;
    prepared_call<R> call_;
    cuda::engine_options how_;
    std::unique_ptr<device_engine<R>> engine_;
    studies::result_arrays results_;
    bool fine_ = true;
};

}  // namespace myriad::python
