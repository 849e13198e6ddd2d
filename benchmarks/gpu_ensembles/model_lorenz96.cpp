// SPDX-License-Identifier: MIT
// Compiles the kernels of Lorenz 96 in double precision.
#include <myriad/instantiate.hpp>

#include "lorenz96.hpp"

MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96<4>, myriad::tsitouras_5, gpu_ensembles::tsitouras_5_rms)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96<8>, myriad::tsitouras_5, gpu_ensembles::tsitouras_5_rms)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96<16>, myriad::tsitouras_5, gpu_ensembles::tsitouras_5_rms)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96<32>, myriad::tsitouras_5, gpu_ensembles::tsitouras_5_rms)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96_units<16>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96_units<32>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96_units<64>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96_units<128>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96_units<256>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96_units<512>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(gpu_ensembles::lorenz96_units<1024>, myriad::tsitouras_5)
