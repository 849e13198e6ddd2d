// SPDX-License-Identifier: MIT
// Kernels of one method for a generic coupled model of 2, 4, 8 and 16 equations, whose registers, stack and spills
// scripts/method_registers.py tabulates. Compiled with METHOD and REAL defined.
#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

/// Lorenz' model of 1996 (Predictability: a problem partly solved, ECMWF 1996, eq. (1)): every equation reads four
/// components, and its slope takes a handful of instructions, so that a kernel's registers are mainly the method's.
template <int n>
struct lorenz_96 {
    enum state { first, n_state = n };
    enum parameter { forcing, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto, const myriad::vec<R, n>& y, const auto& p) {
        myriad::vec<R, n> f;
        MYRIAD_UNROLL
        for (int i = 0; i < n; ++i)
            f[i] = (y[(i + 1) % n] - y[(i + n - 2) % n]) * y[(i + n - 1) % n] - y[i] + p[forcing];
        return f;
    }
};

constexpr auto constant = myriad::shared_placement::constant_bank;
#define INSTANTIATE(n)                                                                                         \
    template __global__ void myriad::detail::integrate_ensemble<lorenz_96<n>, myriad::METHOD, REAL, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<lorenz_96<n>, REAL, constant>);
INSTANTIATE(2)
INSTANTIATE(4)
INSTANTIATE(8)
INSTANTIATE(16)
