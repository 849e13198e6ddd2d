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

namespace {

template <class T>
T of_whole_numbers(tape_code code, T x, T y) {
    switch (code) {
        case tape_code::wrapping_add:
            return myriad::wrapping_add(x, y);
        case tape_code::wrapping_subtract:
            return myriad::wrapping_subtract(x, y);
        case tape_code::wrapping_multiply:
            return myriad::wrapping_multiply(x, y);
        case tape_code::quotient:
            return myriad::floor_divide(x, y);
        default:
            return myriad::floor_mod(x, y);
    }
}

}  // namespace

template <class R>
void apply_to_whole_numbers(tape_code code, bool is_long, const R& x, const R& y, R& result) {
    if constexpr (is_dual<R>) {
        R of_values;
        apply_to_whole_numbers(code, is_long, x.value, y.value, of_values.value);
        result = R(of_values.value);
    } else {
        for (int i = 0; i < lanes_of<R>; ++i) {
            const std::int64_t a = whole(detail::get_lane(x, i)), b = whole(detail::get_lane(y, i));
            const auto short_a = static_cast<std::int32_t>(a), short_b = static_cast<std::int32_t>(b);
            const std::int64_t of = is_long ? of_whole_numbers(code, a, b) : of_whole_numbers(code, short_a, short_b);
            detail::set_lane(result, i, static_cast<real_of<R>>(of));
        }
    }
}

#define MYRIAD_INSTANTIATE_FUNCTIONS(R)                              \
    template void apply_function(tape_code, const R&, const R&, R&); \
    template void apply_to_whole_numbers(tape_code, bool, const R&, const R&, R&);
using lanes = pack<double, tape_batches>;
MYRIAD_INSTANTIATE_FUNCTIONS(double)
MYRIAD_INSTANTIATE_FUNCTIONS(float)
MYRIAD_INSTANTIATE_FUNCTIONS(lanes)
MYRIAD_INSTANTIATE_FUNCTIONS(dual<lanes>)
MYRIAD_INSTANTIATE_FUNCTIONS(dual<double>)
MYRIAD_INSTANTIATE_FUNCTIONS(dual<dual<double>>)
MYRIAD_INSTANTIATE_FUNCTIONS(dual<float>)
#undef MYRIAD_INSTANTIATE_FUNCTIONS

}  // namespace myriad::python
