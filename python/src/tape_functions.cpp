// SPDX-License-Identifier: MIT
// The elementary functions of interpreted models, for the kinds of numbers that their kernels have.
#include "tape_model.hpp"

namespace myriad::python {

template <class R>
void apply_function(tape_code code, const R& x, const R& y, R& result) {
    switch (code) {
        case tape_code::powr:
            if constexpr (is_dual<R>) {
                result = myriad::pow(x, y);  // powr has no derivative by its exponent
            } else {
                result = myriad::powr(x, y);
            }
            break;
#define MYRIAD_TAPE_CASE(name)    \
    case tape_code::name:         \
        result = myriad::name(x); \
        break;
            MYRIAD_TAPE_UNARY(MYRIAD_TAPE_CASE)
#undef MYRIAD_TAPE_CASE
#define MYRIAD_TAPE_CASE(name)       \
    case tape_code::name:            \
        result = myriad::name(x, y); \
        break;
            MYRIAD_TAPE_BINARY(MYRIAD_TAPE_CASE)
#undef MYRIAD_TAPE_CASE
        default:
            break;
    }
}
using lanes = pack<double, tape_batches>;
template void apply_function(tape_code, const double&, const double&, double&);
template void apply_function(tape_code, const lanes&, const lanes&, lanes&);
template void apply_function(tape_code, const dual<double>&, const dual<double>&, dual<double>&);

}  // namespace myriad::python
