// SPDX-License-Identifier: MIT
// What a study asks of a model, for both real types.
#include "myriad/study/studied_model.hpp"

#include "myriad/host/core/instruction_set.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

template <class R>
void studied_model<R>::check(const device& where, const options& o) const {
    const options as_called = options_for(where, o);
    const host::called_model<R> model = called_for(where, as_called);
    model.check_options(as_called);
    model.check_kernel(where);
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
std::unique_ptr<chunk_solver> studied_model<R>::make_device_solver(const study_plan& plan, const device& where) const {
    if (where.which() == device::kind::cpu || sets_others()) return nullptr;
    return solver_on_device<R>(plan, *this, where);
}
template class studied_model<double>;
template class studied_model<float>;

}  // namespace myriad::studies::inline MYRIAD_ABI
