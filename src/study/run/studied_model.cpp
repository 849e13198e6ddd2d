// SPDX-License-Identifier: MIT
// What a study asks of a model, for both real types.
#include "myriad/study/run/studied_model.hpp"

#include <limits>

#include "myriad/host/core/instruction_set.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/study/plan/model_behaviour.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

template <class R>
void studied_model<R>::check(const device& where, const options& o) const {
    const options as_called = options_for(where, o);
    const host::called_model<R> model = called_for(where, as_called);
    model.check_options(as_called);
    model.check_kernel(where.which());
}
template <class R>
std::unique_ptr<chunk_solver> studied_model<R>::make_solver(const study_plan& plan, const device& where) const {
    return solver_on_host<R>(plan, *this, where);
}
template <class R>
arithmetic studied_model<R>::arithmetic_on(const device& where) const {
    if (where.which() != device::kind::cpu) return arithmetic::of_kernel("", compiler_for(where));
    return arithmetic::of_kernel(host::name_of(called_for(where, {}).on_cpu.set), compiler_for(where));
}
template <class R>
std::shared_ptr<const model_behaviour> studied_model<R>::behaviour(const study_plan& plan,
                                                                   const std::vector<device>& devices) const {
    for (const device& where : devices) {
        const detail::behaviour_function<R> call = behaviour_for(where);
        if (call == nullptr) continue;
        const detail::default_arithmetic here;
        const host::called_model<R> model = called_for(where, options_for(where, plan.asked.options));
        host_instances<R> one(*this, where, 1);
        std::int64_t set = -1;
        const auto show = [&](std::int64_t instance, const detail::shown_place& place, void* to,
                              void (*take)(void*, const detail::shown_value&)) {
            if (set != instance) one.set(plan.asked.axes, instance, false);
            set = instance;
            if (model.enter_thread) model.enter_thread();
            call(host::inputs_in(one.data()), 0, place, to, take);
            if (model.functions.mass_matrix == nullptr || place.at > 0) return;
            const int n = model.shape->n_state;
            for (int i = 0; i < n * n; ++i)
                take(to, {detail::model_function::mass_matrix, i % n, detail::shown_kind::state, i / n,
                          model.functions.mass_matrix[i]});
        };
        return std::make_shared<model_behaviour>(names(), plan.content.instances(),
                                                 static_cast<double>(std::numeric_limits<R>::epsilon()), show);
    }
    return nullptr;
}
template <class R>
std::unique_ptr<chunk_solver> studied_model<R>::make_device_solver(const study_plan& plan, const device& where) const {
    if (where.which() == device::kind::cpu || sets_others()) return nullptr;
    return solver_on_device<R>(plan, *this, where);
}
template class studied_model<double>;
template class studied_model<float>;

}  // namespace myriad::studies::inline MYRIAD_ABI
