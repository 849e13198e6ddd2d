// case: loop_over_a_run_time_length
// expect: is not usable in a constant expression|is not a constant expression
// case: array_of_a_run_time_length
// expect: has non-integral type|not implicitly convertible
// case: run_time_length_taken_for_a_number
// expect: cannot convert|no viable conversion
// case: run_time_length_deduced_as_a_number
// expect: no matching function
// case: loop_over_a_run_time_length_that_is_written_out
// expect: is not usable in a constant expression|no matching function
// SPDX-License-Identifier: MIT
// Code of the kernel body that takes the number of components of an interpreted model, which has it only when it runs,
// for a number: it would read and write beyond arrays.
#include "../../python/src/tape_vectors.hpp"
#include "myriad/kernel/core/static_for.hpp"

using namespace myriad;

template <class S, detail::extent n>
S sum(const vec<S, n>& y) {
    S all = 0;
#if defined(CASE_loop_over_a_run_time_length)
    for (int c = 0; c < n; ++c) all += y[c];
#elif defined(CASE_loop_over_a_run_time_length_that_is_written_out)
    detail::static_for<0, MYRIAD_LENGTH(n)>([&](int c) { all += y[c]; });
#else
    for (int c = 0; c < MYRIAD_LENGTH(n); ++c) all += y[c];
#endif
#if defined(CASE_array_of_a_run_time_length)
    S parts[n];
    all += parts[0];
#elif defined(CASE_run_time_length_taken_for_a_number)
    const int count = n;
    all += count;
#endif
    if constexpr (n > 8) all += 1;
    return all;
}

template <class S, int n>
S first(const vec<S, n>& y) {
    return y[0];
}

double sums(const vec<double, python::tape_extent::state>& y, const vec<double, 3>& three) {
#if defined(CASE_run_time_length_deduced_as_a_number)
    return first(y);
#endif
    return sum(y) + sum(three);
}
