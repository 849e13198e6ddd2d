// SPDX-License-Identifier: MIT
// Compiles, in packs, the kernels of the stiff test problems; stiff_solutions.cpp has those that need none.
#include "tests/support/stiff.hpp"

#include <myriad/instantiate.hpp>

#include "tests/support/faulty.hpp"
#include "tests/support/sparse.hpp"

MYRIAD_INSTANTIATE(stiff::van_der_pol, myriad::rosenbrock_23, myriad::rodas_5p, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stiff::draining, myriad::rodas_5p)
MYRIAD_INSTANTIATE(stiff::ball, myriad::rosenbrock_23, myriad::rodas_5p)
MYRIAD_INSTANTIATE_FLOAT(stiff::ball, myriad::rodas_5p)
MYRIAD_INSTANTIATE(faulty::clock_fault, myriad::rosenbrock_23)
MYRIAD_INSTANTIATE(faulty::cliff, myriad::rosenbrock_23, myriad::rodas_5p)
MYRIAD_INSTANTIATE(stiff::relay, myriad::dense<myriad::rodas_5p>)
MYRIAD_INSTANTIATE(sparse::dense_ring<8>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(sparse::plain_ring<8>, myriad::rodas_5p)
MYRIAD_INSTANTIATE(sparse::ring<8>, myriad::rosenbrock_23, myriad::rodas_5p)
MYRIAD_INSTANTIATE_FLOAT(sparse::ring<8>, myriad::rodas_5p)
