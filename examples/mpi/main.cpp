// SPDX-License-Identifier: MIT
// A study that the ranks of an MPI job run together: mpirun -n 4 ./mpi_study [FOLDER [INSTANCES]]
#include <cstdint>
#include <exception>
#include <iostream>
#include <numbers>
#include <string>

#include <myriad/mpi.hpp>
#include <myriad/study.hpp>

#include "../quickstart/model.hpp"

namespace {

void set_up(myriad::any_study& sweep, std::int64_t instances, const std::string& folder) {
    sweep.axis("k", myriad::linspace(0.2, 0.3, instances));
    sweep.set("x", -0.5);
    sweep.set("v", -0.1);
    sweep.set("B", 0.3);
    sweep.time_domain(0, 2 * std::numbers::pi);
    sweep.options = {.phases = 288, .relative_tolerance = 1e-9, .record = {.from_phase = 256, .states = {duffing::x}}};
    sweep.chunk = (instances + 63) / 64;
    sweep.store(folder);
    sweep.stop_on_signals = true;
}

}  // namespace

int main(int argc, char** argv) try {
    const std::string folder = argc > 1 ? argv[1] : "duffing_mpi";
    const std::int64_t instances = argc > 2 ? std::stoll(argv[2]) : 4608;
    // snippet: ranks
    myriad::mpi_ranks ranks;  // initialises MPI, and finalizes it at the end of main
    myriad::study<duffing, myriad::cash_karp> sweep;
    set_up(sweep, instances, folder);  // as for one process
    if (ranks.rank() == 0) sweep.progress = myriad::progress_line();
    const myriad::study_result result = ranks.run(sweep);
    if (ranks.rank() == 0 && result.complete) myriad::export_npy(result.results(), "x", folder + ".npy");
    // end of snippet
    std::cout << myriad::message("rank ", ranks.rank(), " of ", ranks.size(), ", ", ranks.devices()[0].name(), ": ",
                                 result.instances, " of ", instances, " instances in ", result.seconds, " s",
                                 ranks.lost() ? "; a rank was lost" : "", '\n')
              << std::flush;
    return result.complete && std::cout ? 0 : 1;
} catch (const std::exception& e) {
    std::cerr << myriad::message(e.what(), '\n');
    return 1;
}
