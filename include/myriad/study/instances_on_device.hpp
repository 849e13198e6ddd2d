// SPDX-License-Identifier: MIT
// Instances of a study in a GPU's memory, which are set, integrated and reduced there. Host code only.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/core/declarations.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/model/model_shape.hpp"
#include "myriad/host/report/notes.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/solve/prepared_arguments.hpp"
#include "myriad/host/solve/solve.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/axes.hpp"
#include "myriad/study/chunk_solver.hpp"
#include "myriad/study/engine_instances.hpp"
#include "myriad/study/instances_on_host.hpp"
#include "myriad/study/study_plan.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

template <class Model, class Method, class R>
class instances_on_device final : public engine_instances<R, detail::kernel_arguments<Model, R>> {
public:
    instances_on_device(std::int64_t few, const device& where, const study_plan& plan,
                        std::shared_ptr<const generator<Model, R>> generate)
        : options_(plan.asked.options), few_(few, std::move(generate)),
          prepared_(with_domains(few_, plan.asked.axes), options_, host::traits_of<Method>) {
        const auto make = host::require_kernel<Model, Method, R>(where).make_engine;
        this->take_engine(reinterpret_cast<host::engine_key>(make),
                          {where.number(), options_.block_size, options_.shared_placement, options_.schedule}, make,
                          prepared_.get(), host::shape_of<Model>);
    }
    ~instances_on_device() override { this->leave_engine(); }

    model_instances<R>& looked_at() override { return few_; }
    void check(std::int64_t count) override {
        const detail::default_arithmetic here;
        host::check_uses<Method>(few_.all(), options_, count);
        host::find_phases_left(few_.all(), options_, count).require_for(0, options_.phases);
        host::input_check<Model, R>(few_.all(), options_, count).run();
    }
    std::vector<std::string> notes(std::int64_t count) override {
        const detail::default_arithmetic here;
        this->use([&](auto& e) { e.fetch_first(prepared_.get(), count); });
        host::ensemble_access::touch(few_.all());
        report<Model, R> found;
        if (options_.counting == counting::on)
            host::set_work(found, host::work_count{}, host::counted_work(few_.data(), count));
        host::note_tolerances<Method>(found, options_);
        host::note_matrix<Method>(found);
        host::note_stiffness<Method>(found, few_.all(), options_);
        host::note_exponents<Method>(found, few_.all(), options_);
        return found.notes;
    }

private:
    /// The instances, with the arrays that a call needs.
    static ensemble<Model, R>& with_domains(instances_on_host<Model, Method, R>& few, const axes& all) {
        set_instances<R>(few, all, 0);
        return few.all();
    }

    const options& options_;
    instances_on_host<Model, Method, R> few_;
    host::prepared_arguments<Model, R> prepared_;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
