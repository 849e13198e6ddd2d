// SPDX-License-Identifier: MIT
// The instances of a study on a GPU, which sets and reduces them itself.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device_library.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/study/engine_instances.hpp"
#include "prepared_call.hpp"
#include "study_instances.hpp"

namespace myriad::python {

template <class R>
class study_on_device final : public studies::engine_instances<R, shaped_arguments<R>> {
public:
    study_on_device(const model_of_study& model, const study_kernel& kernel, const device& where,
                    const studies::study_plan& plan, std::int64_t few)
        : kernel_(*kernel.kernel), facts_(kernel_.facts()), options_(kernel.fitted(plan.asked.options)),
          few_(model, kernel, few), call_(with_domains(few_, plan.asked.axes), options_, facts_) {
        device_program& program = *kernel.kernel->gpu();
        this->take_engine(&program, engine_options_for(program, where.number(), options_), engines_of<R>(program),
                          call_.arguments, kernel.shape);
    }
    ~study_on_device() override { this->leave_engine(); }

    studies::model_instances<R>& looked_at() override { return few_; }
    void check(std::int64_t count) override {
        const detail::default_arithmetic here;
        auto& data = few_.data();
        const bool endless = may_end_early(facts_, options_);
        host::check_scales(data, facts_.scales_tolerances);
        host::check_sample_times(data, options_, count);
        host::find_phases_left(data, options_, count, endless).require_for(0, options_.phases);
        host::data_check<R>(data, options_, count, endless).run();
    }
    std::vector<std::string> notes(std::int64_t count) override {
        if (facts_.n_vectors > 0) {  // of whose exponents there is a note
            this->use([&](auto& e) { e.fetch_first(call_.arguments, count); });
            few_.data().untouched = false;
        }
        report_of<R> found;
        add_notes<R>(found, few_.all(), call_.arguments, kernel_, options_);
        return found.notes;
    }

private:
    /// The instances, with the arrays that a call needs.
    static ensemble<R>& with_domains(study_instances<R>& few, const axes& all) {
        studies::set_instances<R>(few, all, 0);
        return few.all();
    }

    const library& kernel_;
    const model_facts& facts_;
    options options_;
    study_instances<R> few_;
    prepared_call<R> call_;
};

}  // namespace myriad::python
