// SPDX-License-Identifier: MIT
// Compiles the kernels of stiff problems whose solutions show orders and errors, one instance at a time, to save
// compile time; stiff.cpp has those in packs.
#include <myriad/instantiate.hpp>

#include "tests/support/problems.hpp"
#include "tests/support/sparse.hpp"
#include "tests/support/stiff.hpp"

#define STIFF_METHODS myriad::rosenbrock_23, myriad::rodas_5p

MYRIAD_INSTANTIATE(stiff::robertson, STIFF_METHODS, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stiff::roessler, myriad::rodas_5p, myriad::tsitouras_5, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(stiff::prothero_robinson_with_tangent, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stiff::robertson_with_jacobian, myriad::rodas_5p)
MYRIAD_INSTANTIATE(problems::timed_circle, STIFF_METHODS)
MYRIAD_INSTANTIATE_FLOAT(problems::oscillator, STIFF_METHODS)
MYRIAD_INSTANTIATE(stiff::prothero_robinson, STIFF_METHODS, myriad::tsitouras_5, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(stiff::prothero_robinson, myriad::dense<myriad::rosenbrock_23>, myriad::dense<myriad::rodas_5p>)
MYRIAD_INSTANTIATE(stiff::growth, STIFF_METHODS)
MYRIAD_INSTANTIATE_FLOAT(stiff::growth, myriad::rodas_5p)
MYRIAD_INSTANTIATE(stiff::rod<7>, myriad::rodas_5p, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stiff::rod<32>, myriad::rodas_5p)
MYRIAD_INSTANTIATE_FLOAT(stiff::rod<32>, myriad::rosenbrock_23)
MYRIAD_INSTANTIATE(stiff::relay, myriad::dense<myriad::rosenbrock_23>)
MYRIAD_INSTANTIATE(sparse::dense_ring<32>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(sparse::ring<32>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(sparse::growth_among_decays, myriad::rosenbrock_23, myriad::rodas_5p)
MYRIAD_INSTANTIATE(sparse::ring_with_a_gap<8>, myriad::rodas_5p)
