// SPDX-License-Identifier: MIT
// Factorises and solves with the library's LU.
#include "tests/kernel/stepper/lu_lanes.hpp"

#include "myriad/kernel/scalar/pack.hpp"
#include "myriad/kernel/stepper/lu.hpp"

namespace lu_lanes {
namespace {

template <class S, int n>
solutions solve_systems(const systems& given) {
    using R = myriad::real_of<S>;
    using myriad::detail::get_lane, myriad::detail::set_lane;  // of plain numbers
    solutions out;
    myriad::detail::lu_factors<S, n> lu;
    myriad::vec<S, n> x;
    const double* a = given.matrix.data();
    const double* b = given.right.data();
    for (int lane = 0; lane < myriad::lanes_of<S>; ++lane) {
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) set_lane(lu.a[i][j], lane, static_cast<R>(*a++));
            set_lane(x[i], lane, static_cast<R>(*b++));
        }
    }
    const auto regular = factorise(lu);
    solve_factorised(lu, x);
    for (int lane = 0; lane < myriad::lanes_of<S>; ++lane) {
        for (int i = 0; i < n; ++i) out.x.push_back(static_cast<double>(get_lane(x[i], lane)));
        out.regular.push_back(get_lane(regular, lane));
    }
    return out;
}

template <class S, kind which>
solutions solve_any_size(const systems& given) {
    solutions out;
    myriad::detail::static_for<1, largest_system + 1>([&](auto n) {
        if constexpr (constexpr int size = decltype(n)::value; is_compiled(which, size)) {
            if (given.n == size) out = solve_systems<S, size>(given);
        }
    });
    return out;
}

using pack_of_double = myriad::pack<double, 1>;
using pack_of_float = myriad::pack<float, 1>;

}  // namespace

int lanes(kind which) {
    switch (which) {
        case kind::pack_of_double:
            return myriad::lanes_of<pack_of_double>;
        case kind::pack_of_float:
            return myriad::lanes_of<pack_of_float>;
        default:
            return 1;
    }
}

solutions solve(kind which, const systems& given) {
    switch (which) {
        case kind::one_double:
            return solve_any_size<double, kind::one_double>(given);
        case kind::one_float:
            return solve_any_size<float, kind::one_float>(given);
        case kind::pack_of_double:
            return solve_any_size<pack_of_double, kind::pack_of_double>(given);
        default:
            return solve_any_size<pack_of_float, kind::pack_of_float>(given);
    }
}

}  // namespace lu_lanes
