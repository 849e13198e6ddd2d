// SPDX-License-Identifier: MIT
// Stiff methods as CUDA kernels: in registers up to six equations, through local memory above, where the stack holds
// one matrix (8 n^2 bytes), the stages and little else, or with steps in shared memory, little; single precision stays
// single.
//
// limit: integrate_ensemble<chain<2>, rosenbrock_23> stack 0 spill 0 registers 72
// limit: integrate_ensemble<chain<2>, rodas_5p> stack 0 spill 0 registers 88
// limit: integrate_ensemble<chain<4>, rosenbrock_23> stack 16 spill 32 registers 136
// limit: integrate_ensemble<chain<4>, rodas_5p> stack 0 spill 0 registers 168
// limit: integrate_ensemble<chain<6>, rosenbrock_23> stack 0 spill 0
// limit: integrate_ensemble<chain<6>, rodas_5p> stack 0 spill 0
// limit: integrate_ensemble<chain<8>, rosenbrock_23> stack 2400
// limit: integrate_ensemble<chain<8>, rodas_5p> stack 2400
// limit: integrate_ensemble<chain<32>, rosenbrock_23> stack 14000
// limit: integrate_ensemble<chain<32>, rodas_5p> stack 14000
// limit: integrate_ensemble<sparse_chain<8>, rosenbrock_23> stack 24 spill 68
// limit: integrate_ensemble<sparse_chain<8>, rodas_5p> stack 0 spill 0
// limit: integrate_ensemble<sparse_chain<32>, rosenbrock_23> stack 3000
// limit: integrate_ensemble<sparse_chain<32>, rodas_5p> stack 300
// limit: integrate_ensemble<van_der_pol_ring<32>, rodas_5p> stack 100
// limit: integrate_ensemble<van_der_pol_ring<64>, rodas_5p> stack 3700
// forbid: f64 in integrate_ensemble<chain<3>, rosenbrock_23>
// forbid: f64 in integrate_ensemble<chain<3>, rodas_5p>

#include <array>
#include <cstddef>

#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "problems/van_der_pol_ring.hpp"

/// n populations, each of which feeds on the next one: the Jacobian has two entries in each row. From seven on it looks
/// at a value, so that the compiler does not find that, and the matrix stays dense.
template <int n>
struct chain {
    enum state { first, n_state = n };
    enum parameter { rate, n_parameter };
    enum shared_integer { at_rest, n_shared_integer };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto, const myriad::vec<R, n>& y, const auto& p) {
        myriad::vec<R, n> f{};
        if constexpr (n > 6)
            if (p.shared_integer[at_rest] != 0) return f;
        MYRIAD_UNROLL
        for (int i = 0; i < n; ++i) f[i] = p[rate] * (y[(i + 1) % n] * y[i] - y[i]);
        return f;
    }
};

/// The same with the pattern of its Jacobian.
template <int n>
struct sparse_chain : chain<n> {
    static constexpr bool autonomous = true;
    static constexpr auto jacobian_pattern = [] {
        std::array<myriad::jacobian_entry, 2 * n> entries{};
        for (int i = 0; i < n; ++i) {
            entries[static_cast<std::size_t>(2 * i)] = {i, i};
            entries[static_cast<std::size_t>(2 * i + 1)] = {i, (i + 1) % n};
        }
        return entries;
    }();
};

constexpr auto constant = myriad::shared_placement::constant_bank;
#define INSTANTIATE(model, R)                                                                               \
    template __global__ void myriad::detail::integrate_ensemble<model, myriad::rosenbrock_23, R, constant>( \
        const __grid_constant__ myriad::detail::launch_arguments<model, R, constant>);                      \
    template __global__ void myriad::detail::integrate_ensemble<model, myriad::rodas_5p, R, constant>(      \
        const __grid_constant__ myriad::detail::launch_arguments<model, R, constant>);
INSTANTIATE(chain<2>, double)
INSTANTIATE(chain<3>, float)
INSTANTIATE(chain<4>, double)
INSTANTIATE(chain<6>, double)
INSTANTIATE(chain<8>, double)
#if defined(MYRIAD_THOROUGH)
INSTANTIATE(chain<16>, double)
#endif
INSTANTIATE(chain<32>, double)
INSTANTIATE(sparse_chain<8>, double)
INSTANTIATE(sparse_chain<32>, double)
using problems::van_der_pol_ring;  // whose pattern is found
INSTANTIATE(van_der_pol_ring<32>, double)
template __global__ void myriad::detail::integrate_ensemble<van_der_pol_ring<64>, myriad::rodas_5p, double, constant>(
    const __grid_constant__ myriad::detail::launch_arguments<van_der_pol_ring<64>, double, constant>);
