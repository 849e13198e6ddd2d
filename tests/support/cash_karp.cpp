// SPDX-License-Identifier: MIT
// Compiles, with cash_karp, the kernels of the models whose other kernels are in packs: one instance at a time, to save
// compile time, as the loop depends on whether steps are adaptive and on whether a step's last slope is the next one's
// first.
#include <myriad/instantiate.hpp>

#include "tests/support/faulty.hpp"
#include "tests/support/hooked.hpp"

MYRIAD_INSTANTIATE(faulty::clock_fault, myriad::cash_karp)
MYRIAD_INSTANTIATE_FLOAT(faulty::clock_fault, myriad::cash_karp)
MYRIAD_INSTANTIATE(faulty::domain_fault, myriad::cash_karp)
MYRIAD_INSTANTIATE(faulty::cliff, myriad::cash_karp)
MYRIAD_INSTANTIATE(faulty::guarded, myriad::cash_karp)
MYRIAD_INSTANTIATE(faulty::blow_up, myriad::cash_karp)
MYRIAD_INSTANTIATE_FLOAT(faulty::blow_up, myriad::cash_karp)
MYRIAD_INSTANTIATE(faulty::slope_jump, myriad::cash_karp)
MYRIAD_INSTANTIATE(faulty::hook_fault, myriad::cash_karp)

MYRIAD_INSTANTIATE(hooked::running_scalar, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::running_generic, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::parameter_writer, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::domain_writer, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::reader, myriad::cash_karp)
MYRIAD_INSTANTIATE_FLOAT(hooked::reader, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::kicked_scalar, myriad::cash_karp, myriad::dense<myriad::cash_karp>)
MYRIAD_INSTANTIATE(hooked::kicked_generic, myriad::cash_karp)

MYRIAD_INSTANTIATE(hooked::phased, myriad::cash_karp)
MYRIAD_INSTANTIATE_FLOAT(hooked::phased, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::stopper, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::ramp, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::renormalised, myriad::cash_karp)

MYRIAD_INSTANTIATE(hooked::phased_by_events, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::hooks_logged, myriad::cash_karp)
MYRIAD_INSTANTIATE(hooked::early_reader, myriad::cash_karp)
