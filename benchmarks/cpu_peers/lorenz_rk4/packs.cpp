// SPDX-License-Identifier: MIT
// The loop over packs of one to four batches, with the peers' flags: the speed of the hardware.
#include "pack_loop.hpp"

namespace cpu_peers::lorenz {

outcome run_packs_1(const sweep& work) { return run_pack_loop<1>(work); }
outcome run_packs_2(const sweep& work) { return run_pack_loop<2>(work); }
outcome run_packs_3(const sweep& work) { return run_pack_loop<3>(work); }
outcome run_packs_4(const sweep& work) { return run_pack_loop<4>(work); }

}  // namespace cpu_peers::lorenz
