// SPDX-License-Identifier: MIT
// One process as an MPI job, with the component mpi of the installed package; exit status 1 if it is wrong.
#include <cstdio>

#include <myriad/mpi.hpp>

int main() {
    const myriad::mpi_ranks ranks;
    std::printf("rank %d of %d on %s\n", ranks.rank(), ranks.size(), ranks.devices().at(0).name().c_str());
    return ranks.rank() == 0 && ranks.size() == 1 && !ranks.lost() ? 0 : 1;
}
